// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "accel/accel.h"
#include "kernel/ray_packet.h"
#include "kernel/scene_view.h"

namespace orrery::render {

/// The packets of a render, in the order in which they were traced: the rays that a traversal meets in earnest, not
/// ones that somebody thought up. `hit` and `distance` are as traced.
template <class Packet>
struct RecordedRays {
  std::vector<Packet> camera;
  std::vector<Packet> bounced;  ///< from the first bounce to the last
  std::uint64_t paths = 0;
};

/// The pixels that are rendered to record their rays.
struct RecordedPixels {
  int width = 0, height = 0;                ///< px; of the whole picture
  int row_step = 1;                         ///< every so many rows
  int samples = kernel::kPacketSize;        ///< per pixel; so many make every packet of camera rays one pixel's
};

/// Renders once, in one thread, and keeps every packet.
///
/// Domain     a view of a picture of that size; `accel` is made for it, in the precision
/// Cost       about 2 KB for 16 rays, 1 KB in `fast`
RecordedRays<kernel::RayPacket> record_rays(const kernel::SceneView& view, const accel::Accel& accel,
                                            kernel::Precision precision, const RecordedPixels& pixels);
RecordedRays<kernel::RayPacketFast> record_rays_fast(const kernel::SceneView& view, const accel::Accel& accel,
                                                     const RecordedPixels& pixels);

/// Makes a traced packet one that was not traced yet, as the renderer does before each trace.
template <class Packet>
void forget_hits(Packet& packet);

extern template void forget_hits(kernel::RayPacket& packet);
extern template void forget_hits(kernel::RayPacketFast& packet);

/// Traces all of them once more and does nothing else: what a renderer whose shading costs nothing would need.
///
/// Result     seconds
double trace_again(const kernel::Tracer& tracer, RecordedRays<kernel::RayPacket>& rays);
double trace_again(const kernel::Tracer& tracer, RecordedRays<kernel::RayPacketFast>& rays);

}  // namespace orrery::render
