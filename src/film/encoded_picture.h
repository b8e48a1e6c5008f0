// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace orrery::film {

/// A display-encoded image with integer channels, ready for PNG, TIFF, JPEG or PPM.
struct EncodedPicture {
  int width = 0;                      ///< px
  int height = 0;                     ///< px
  int bits = 8;                       ///< 8 or 16; the largest value is 2^bits - 1
  bool is_srgb = false;               ///< the values are sRGB codes
  std::vector<std::uint16_t> values;  ///< width * height * channels, row by row from the top, R G B or R G B A
  int channels = 3;                   ///< 3, or 4 with straight (unpremultiplied) alpha
};

}  // namespace orrery::film
