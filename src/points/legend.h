// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "points/elements.h"

namespace orrery::points {

/// A legend of colours: a bar, or patches with labels. All colours are display values: the caller applies the display
/// transform of the image.
struct Legend {
  struct Patch {
    std::string label;
    Srgb8 color{};
  };

  std::string title;           ///< UTF-8, one line: the name of the column
  std::vector<Srgb8> bar;      ///< colours at equal steps from `first` to `last`; empty: patches only
  double first = 0, last = 1;  ///< finite
  std::vector<Patch> patches;
  std::optional<Srgb8> nan_color;  ///< shown as a patch "no value"
};

/// Returns the legend as an SVG image: a vertical bar with `last` at the top and ticks at round numbers, patches below.
/// Bytes that XML does not allow are replaced by question marks; long strings are truncated.
std::string legend_svg(const Legend& legend);

/// Returns the position of a value on the bar of a legend.
///
/// Result     0 at `first` to 1 at `last`; 0.5 if both are equal
double share_of(double value, const Legend& legend);

/// Returns the pixels of a bar, row by row from the top, with the last colour at the top.
///
/// Domain     at least one colour; a size of at least 1 x 1
std::vector<Srgb8> bar_pixels(const std::vector<Srgb8>& bar, int width_px, int height_px);

}  // namespace orrery::points
