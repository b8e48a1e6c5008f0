// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "accel/accel.h"
#include "base/huge_pages.h"
#include "compile/forward.h"

namespace orrery::render {

/// Where outlines are drawn.
struct OutlineStyle {
  double width_px = 0;  ///< of the lines, half of it on either side of the edge
  double depth = 0;     ///< smallest jump of the depth within a group, scene units; 0: a quarter of the front
                        ///< object's radius, twice the radius with groups
  /// Group of each object. Lines between groups need no jump; those within a group are thinner and weaker, unless the
  /// jump is several times `depth`. Empty: all objects are one group, and all lines have full width.
  base::PackedArray groups;
};

/// The coverage of each pixel by outlines, drawn where the depth jumps, by more than three pixels: small objects that
/// touch have none. As object_at(), at shutter open, without the blur of the lens. Outlines of translucent objects are
/// as weak as their objects, and objects less than half opaque do not hide the outlines behind them. A depth cue
/// weakens outlines like their objects.
///
/// `accel`      of the objects of `scene`
/// Shape        scene.width * scene.height, row by row from the top
/// Precision    the width of a straight line, over all pixels, within 0.3 px (test RenderOutlines)
/// Cost         4 to 16 rays per pixel, twice as many with translucent objects, on `threads` threads
std::vector<float> outlines(const compile::CompiledScene& scene, const accel::Accel& accel, const OutlineStyle& style,
                            int threads);

}  // namespace orrery::render
