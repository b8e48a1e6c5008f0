// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kernel/precision.h"
#include "kernel/ray_packet.h"
#include "kernel/render_tile.h"
#include "kernel/sphere.h"

namespace orrery::test {

/// One packet of rays against one sphere a ray, by the kernel's own text.
struct Intersections {
  double distance[kernel::kPacketSize];
  bool hit[kernel::kPacketSize];
  double offset[3][kernel::kPacketSize];  ///< from the sphere's centre to the point; where there is a hit
};

/// Intersects lane i with spheres[i], whose id is ids[i].
///
/// Domain     packet's origin_low, inverse_square and self as the renderer would set them (see set_ray)
Intersections intersect_batch(kernel::Precision precision, kernel::Lanes lanes, const kernel::RayPacket& packet,
                              const kernel::Sphere* spheres, const std::uint64_t* ids);

/// Sets a lane to a ray that leaves base + offset; by the renderer's arithmetic.
void set_ray(kernel::RayPacket& packet, int lane, const double (&base)[3], const double (&offset)[3],
             const double (&direction)[3], std::uint64_t self);

}  // namespace orrery::test
