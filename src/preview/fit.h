// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "preview/screen.h"

namespace orrery::preview {

class Canvas;

/// The size of an image in a terminal.
struct Fit {
  int width = 0, height = 0;  ///< px of the bitmap; 0: the terminal is too small
  int columns = 0, rows = 0;  ///< character cells that the image covers

  bool operator==(const Fit&) const = default;
};

/// The largest size, not larger than the image's own, that keeps its aspect ratio, is a whole number of columns wide,
/// and fits into the terminal. At most kLargestBitmap pixels.
Fit fit(int width_px, int height_px, double pixel_aspect, const Screen::CellGrid& grid);

/// Maximum number of pixels: more would slow down the terminal.
inline constexpr double kLargestBitmap = 300'000;

/// The image at a smaller size: scene-linear means of the pixels that each new pixel covers.
///
/// Result     R, G, B of width * height pixels
std::vector<float> scaled(const Canvas& canvas, int width_px, int height_px);

}  // namespace orrery::preview
