// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kernel/forward.h"
#include "kernel/precision.h"
#include "kernel/ray_packet.h"
#include "render/pixel_noise.h"

namespace orrery::render {

/// How lines of sight are traced.
struct Visibility {
  kernel::Tracer tracer;
  kernel::Precision precision;
};

/// The coverage of each pixel by emitters, and the radiance that they add.
///
/// Emitters count if few of a pixel's samples hit them: distant lamps, filaments, the sun in a wide view, bright texels
/// of a map, those that lens or motion blurs, and the reflections of lamps and sun in sharp balls. The pixels around
/// may see no sign of them. Their positions in the image follow from camera and scene without any samples, so selecting
/// pixels by them causes no bias. Emitters that no line of sight reaches do not count.
///
/// Not projected: what is sampled (SceneView::seen_emitters); reflections in rods, of texels, of rods, of reflections,
/// and what is seen through glass.
///
/// Result     one per pixel, row by row; empty if there are none
/// Cost       one pass over spheres and rods if something emits, and over the texels of the background; a packet of
///            rays for each emitter in the frame, and each part of a rod of a pixel. Reflections of up to 2^18 pairs of
///            balls and lights: with more, those of the strongest lights; at least one light for each ball
std::vector<EmitterCoverage> emitter_coverage(const kernel::SceneView& scene, const Visibility& visibility,
                                              int width_px, int height_px);

}  // namespace orrery::render
