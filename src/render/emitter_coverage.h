// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kernel/forward.h"
#include "render/pixel_noise.h"

namespace orrery::render {

/// The coverage of each pixel by emitters, and the radiance that they add, as if nothing occluded them.
///
/// Emitters count if few of a pixel's samples hit them: distant lamps, the sun in a wide view, bright texels of a map,
/// and those that lens or motion blurs. The pixels around may see no sign of them. Their positions in the image follow
/// from camera and scene without any samples, so selecting pixels by them causes no bias.
///
/// Result     one per pixel, row by row; empty if there are none
/// Cost       one pass over the spheres if something emits, and over the texels of the background
std::vector<EmitterCoverage> emitter_coverage(const kernel::SceneView& scene, int width_px, int height_px);

}  // namespace orrery::render
