// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace orrery::film {

/// A picture for a display: three channels of whole numbers, what a viewer of PNG or JPEG expects.
struct EncodedPicture {
  int width = 0;                      ///< px
  int height = 0;                     ///< px
  int bits = 8;                       ///< 8 or 16; the largest value is 2^bits - 1
  bool is_srgb = false;               ///< encoded for the display that files without a profile are taken to be for
  std::vector<std::uint16_t> values;  ///< width * height * 3, rows from the top, R G B
};

}  // namespace orrery::film
