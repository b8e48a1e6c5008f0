// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "kernel/pixel_place.h"

namespace orrery::film {

/// Pixels that have received samples.
///
/// Domain     `pixels` is relative to x, y and inside the rectangle
struct RenderedPixels {
  int x = 0, y = 0, width = 0, height = 0;  ///< px, a rectangle around the pixels
  std::span<const kernel::PixelPlace> pixels = {};
};

}  // namespace orrery::film
