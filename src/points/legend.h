// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
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
  bool is_log = false;         ///< the steps are those of logarithms; both ends are above 0
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

struct Tick {
  double value = 0;
  std::string label;
};

/// Returns ticks at multiples of 1, 2 or 5 times a power of ten in a range, with as many digits as distinguish them.
/// All labels are fixed ("0.25"), or, if the range reaches 1e6 or is below 1e-3, scientific with a common exponent
/// ("0.5e-7").
///
/// Domain     finite ends in any order
/// Result     4 to 11 ascending ticks; one if the ends are equal or too close to be distinguished; the ends if their
///            difference is not finite
std::vector<Tick> nice_ticks(double first, double last);

/// Returns the ticks of a legend's bar: nice_ticks(), or on a logarithmic bar of at least a decade powers of ten, with
/// their double and fivefold on less than three decades.
std::vector<Tick> ticks_of(const Legend& legend);

/// Maximum number of patches in legend_image(): few programs could open a larger image.
inline constexpr std::size_t kMaxImagePatches = 500;

/// An image in display-referred sRGB.
struct LegendImage {
  int width = 0, height = 0;  ///< px
  std::vector<Srgb8> pixels;  ///< row by row from the top
};

/// Returns the legend of legend_svg() as pixels, with text in a built-in ASCII font. Other characters are shown as
/// question marks; long strings are truncated.
///
/// Domain     at most kMaxImagePatches patches
LegendImage legend_image(const Legend& legend);

}  // namespace orrery::points
