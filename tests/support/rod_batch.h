// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernel/ray_packet.h"
#include "kernel/rod.h"
#include "support/lanes.h"

namespace orrery::test {

/// Result of intersecting each ray of a packet with its own rod, computed by the kernel.
struct RodHits {
  double distance[kernel::kPacketSize];
  bool hit[kernel::kPacketSize];
  bool may_hit[kernel::kPacketSize];      ///< the conservative test
  bool second_half[kernel::kPacketSize];  ///< valid, like what follows, where `hit` is true
  bool at_end[kernel::kPacketSize];       ///< the ray enters through the sphere at an end
  double center[3][kernel::kPacketSize];
  double offset[3][kernel::kPacketSize];
  double outward[3][kernel::kPacketSize];
  /// Where a ray that leaves the hit point starts.
  double start[3][kernel::kPacketSize], start_low[3][kernel::kPacketSize];
};

/// Intersects lane i with rods[i], in `exact`.
///
/// Domain     origin_low and inverse_square of the packet are set as by the renderer (see set_ray)
RodHits intersect_rods(test::Lanes lanes, const kernel::RayPacket<double>& packet, const kernel::Rod* rods);

/// The same in `fast`, for rays and rods rounded to single precision.
RodHits intersect_rods_fast(test::Lanes lanes, const kernel::RayPacket<double>& packet, const kernel::Rod* rods);

}  // namespace orrery::test
