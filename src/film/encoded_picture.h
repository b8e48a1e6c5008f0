// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace orrery::film {

/// A picture for a display: channels of whole numbers, as a viewer of PNG or JPEG expects.
struct EncodedPicture {
  int width = 0;                      ///< px
  int height = 0;                     ///< px
  int bits = 8;                       ///< 8 or 16; the largest value is 2^bits - 1
  bool is_srgb = false;               ///< encoded for the display that files without a profile are taken to be for
  std::vector<std::uint16_t> values;  ///< width * height * channels, rows from the top, R G B, or R G B A
  int channels = 3;                   ///< 4: with alpha, which is not multiplied into R G B
};

}  // namespace orrery::film
