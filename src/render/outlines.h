// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "accel/accel.h"
#include "compile/forward.h"

namespace orrery::render {

/// The coverage of each pixel by outlines, drawn where the depth jumps by more than a quarter of the front object's
/// radius and by more than three pixels: small objects that touch have none. As sphere_at(), at shutter open, without
/// the blur of the lens. A translucent object has outlines with the probability of its opacity.
///
/// `accel`      of the objects of `scene`
/// `width_px`   of the lines, half of it on either side of the edge
/// Shape        scene.width * scene.height, row by row from the top
/// Precision    the width of a straight line, over all pixels, within 0.3 px (test RenderOutlines)
/// Cost         16 rays per pixel, on `threads` threads
std::vector<float> outlines(const compile::CompiledScene& scene, const accel::Accel& accel, double width_px,
                            int threads);

}  // namespace orrery::render
