// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "points/elements.h"
#include "points/legend.h"

namespace orrery::points {

/// Patches that legend_image() can show; more would be an image that few programs open.
inline constexpr std::size_t kMaxImagePatches = 500;

/// An image in display-referred sRGB.
struct LegendImage {
  int width = 0, height = 0;  ///< px
  std::vector<Srgb8> pixels;  ///< row by row from the top
};

/// Returns the legend of legend_svg() as pixels, with texts in a built-in font of ASCII characters. Others are shown as
/// question marks, long texts are truncated.
///
/// Domain     at most kMaxImagePatches patches
LegendImage legend_image(const Legend& legend);

}  // namespace orrery::points
