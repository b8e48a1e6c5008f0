// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kernel/precision.h"
#include "kernel/ray_packet.h"
#include "kernel/sphere.h"
#include "support/lanes.h"

namespace orrery::test {

/// Result of intersecting each ray of a packet with its own sphere, computed by the kernel.
struct Intersections {
  double distance[kernel::kPacketSize];
  bool hit[kernel::kPacketSize];
  double offset[3][kernel::kPacketSize];  ///< from the sphere's centre to the hit point; valid where `hit` is true
};

/// Intersects lane i with spheres[i], whose id is ids[i].
///
/// Domain     origin_low, inverse_square and self of the packet are set as by the renderer (see set_ray)
Intersections intersect_batch(kernel::Precision precision, test::Lanes lanes, const kernel::RayPacket<double>& packet,
                              const kernel::Sphere* spheres, const std::uint64_t* ids);

/// Sets a lane to a ray with origin base + offset, with the renderer's arithmetic.
void set_ray(kernel::RayPacket<double>& packet, int lane, const double (&base)[3], const double (&offset)[3],
             const double (&direction)[3], std::uint64_t self);

}  // namespace orrery::test
