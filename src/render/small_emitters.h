// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kernel/forward.h"
#include "render/pixel_noise.h"

namespace orrery::render {

/// Computes the coverage and the radiance that small emitters add to each pixel, as if nothing occluded them.
///
/// Small emitters cover at most 3 x 3 pixels, such as distant lamps, or the sun in a wide view. Few of a pixel's
/// samples hit them, and the pixels around it see no sign of them. Their positions in the image follow from camera and
/// scene without any samples, so selecting pixels by them causes no bias.
///
/// Result     one per pixel, row by row; empty if no emitter is small
/// Cost       one pass over the spheres if something emits
std::vector<EmitterCoverage> find_small_emitters(const kernel::SceneView& scene, int width_px, int height_px);

}  // namespace orrery::render
