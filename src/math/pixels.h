// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace orrery::math {

/// The number of pixels of an image.
///
/// Domain     not negative
constexpr std::size_t pixel_count(int width, int height) {
  return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

/// The index of a pixel in row-major order, in an image `width` pixels wide.
///
/// Domain     not negative
constexpr std::size_t pixel_index(int x, int y, int width) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
}

}  // namespace orrery::math
