// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "accel/accel.h"
#include "kernel/ray_packet.h"
#include "kernel/scene_view.h"

namespace orrery::bench {

/// The packets of a small render, in the order in which the renderer traced them: the rays that a traversal meets in
/// earnest, not ones that somebody thought up.
///
/// Every packet of camera rays is one pixel's, as in pictures of many samples. `hit` and `distance` are as traced.
template <class Packet>
struct RecordedRays {
  std::vector<Packet> camera;
  std::vector<Packet> bounced;  ///< from the first bounce to the last
};

/// The size of the picture that is rendered for it.
inline constexpr int kRecordedWidth = 48, kRecordedHeight = 27;  // px
inline constexpr int kRecordedSamples = kernel::kPacketSize;     // per pixel

/// Renders once and keeps every packet.
///
/// Domain     a view of a picture of kRecordedWidth by kRecordedHeight; `accel` is made for it, in the precision
/// Cost       about 2 KB for 16 rays, 1 KB in `fast`
RecordedRays<kernel::RayPacket> record_rays(const kernel::SceneView& view, const accel::Accel& accel,
                                            kernel::Precision precision);
RecordedRays<kernel::RayPacketFast> record_rays_fast(const kernel::SceneView& view, const accel::Accel& accel);

/// Makes a traced packet one that was not traced yet, as the renderer does before each trace.
template <class Packet>
void forget_hits(Packet& packet);

extern template void forget_hits(kernel::RayPacket& packet);
extern template void forget_hits(kernel::RayPacketFast& packet);

}  // namespace orrery::bench
