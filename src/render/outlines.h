// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "accel/accel.h"
#include "compile/forward.h"

namespace orrery::render {

/// The coverage of each pixel by outlines, drawn where the depth jumps by more than a quarter of the front object's
/// radius and by more than three pixels: small objects that touch have none. As object_at(), at shutter open, without
/// the blur of the lens. Outlines of translucent objects are as weak as their objects, and objects less than half
/// opaque do not hide the outlines behind them.
///
/// `accel`      of the objects of `scene`; has the scene's opacities at the end, and others meanwhile: no query of
///              another thread may be under way if objects are translucent
/// `width_px`   of the lines, half of it on either side of the edge
/// Shape        scene.width * scene.height, row by row from the top
/// Precision    the width of a straight line, over all pixels, within 0.3 px (test RenderOutlines)
/// Cost         16 rays per pixel, 32 with translucent objects, on `threads` threads
std::vector<float> outlines(const compile::CompiledScene& scene, accel::Accel& accel, double width_px, int threads);

}  // namespace orrery::render
