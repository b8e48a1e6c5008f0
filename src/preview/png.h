// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace orrery::preview {

/// An image of 8-bit display values.
struct Bitmap {
  int width = 0, height = 0;        ///< px
  std::vector<std::uint8_t> codes;  ///< R, G, B of all pixels, row by row from the top

  std::size_t row_bytes() const { return 3 * static_cast<std::size_t>(width); }
  const std::uint8_t* row(int y) const { return codes.data() + static_cast<std::size_t>(y) * row_bytes(); }
};

/// Encodes a PNG without compression, which would take most of the time.
///
/// Reference  PNG
std::string encode_png(const Bitmap& bitmap);

}  // namespace orrery::preview
