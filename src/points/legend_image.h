// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "points/elements.h"
#include "points/legend.h"

namespace orrery::points {

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
