// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "accel/forward.h"
#include "kernel/forward.h"
#include "kernel/precision.h"

namespace orrery::render {

/// The packets of a render in tracing order: representative rays for measuring traversal. `hit` and `distance` are the
/// results.
template <class Packet>
struct RecordedRays {
  std::vector<Packet> camera;
  std::vector<Packet> secondary;  ///< from the first bounce to the last
  std::uint64_t paths = 0;
};

/// Renders tiles of an image on one thread and keeps every packet; the tiles' sums remain unchanged.
///
/// Domain     `accel` was built for the view, in the precision
/// Cost       about 2 KB per 16 rays, 1 KB in `fast`
RecordedRays<kernel::RayPacket> record_rays(const kernel::SceneView& view, const accel::Accel& accel,
                                            kernel::Precision precision, const std::vector<kernel::Tile>& tiles);
RecordedRays<kernel::RayPacketFast> record_rays_fast(const kernel::SceneView& view, const accel::Accel& accel,
                                                     const std::vector<kernel::Tile>& tiles);

/// Traces the packets again, without shading, and measures the time.
///
/// Result     seconds
double trace_again(const kernel::Tracer& tracer, std::vector<kernel::RayPacket>& packets);
double trace_again(const kernel::Tracer& tracer, std::vector<kernel::RayPacketFast>& packets);

}  // namespace orrery::render
