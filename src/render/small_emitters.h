// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kernel/forward.h"
#include "render/pixel_statistics.h"

namespace orrery::render {

// Small emitters cover at most 3 x 3 pixels, such as distant lamps, or the sun in a wide view. Few of a pixel's samples
// hit them, and the neighbouring pixels, from which its error is estimated, do not see them. Their positions in the
// image follow from camera and scene without any samples, so selecting pixels by them causes no bias.

/// Computes the coverage and the radiance that small emitters add to each pixel, as if nothing occluded them.
///
/// Result     one per pixel, row by row; empty if no emitter is small
/// Cost       one pass over the spheres if something emits
std::vector<EmitterCoverage> find_small_emitters(const kernel::SceneView& scene, int width_px, int height_px);

/// Returns whether a pixel has too few samples to have hit its small emitters several times.
///
/// Result     false from kSamplesForReliability on, and if their light is insignificant compared with that of the
///            neighbours. Independent of the pixel's own values and those of its class
bool needs_samples_for_emitters(const PixelStatistics& statistics, int x, int y);

/// The squared relative display error of a single sample of a pixel that comes from hitting its small emitters by
/// chance.
///
/// Result     0 if there are none, or if their light is insignificant compared with that of the neighbours. Independent
///            of the pixel's own values and those of its class
float error_of_small_emitters(const PixelStatistics& statistics, int x, int y);

}  // namespace orrery::render
