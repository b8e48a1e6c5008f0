// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "kernel/precision.h"
#include "kernel/ray_packet.h"
#include "kernel/sphere.h"
#include "support/lanes.h"

namespace orrery::bench {

/// One sphere for each ray of a packet.
template <class T>
struct alignas(64) SphereLanes {
  T center[3][kernel::kPacketSize];
  T radius[kernel::kPacketSize];
};

template <class T>
struct alignas(64) PointLanes {
  T offset[3][kernel::kPacketSize];
  T outward[3][kernel::kPacketSize];
};

/// The kernel's intersection code instantiated on its own, without traversal or shading. Packets must be full.
template <class T>
struct IntersectFunctions {
  /// Intersects all rays with each sphere in turn, and sets distance and hit as a traversal does.
  void (*closest_distance)(kernel::RayPacket<T>& packet, const kernel::Sphere* spheres, std::size_t count);

  /// Computes each ray's hit point on its own sphere, packet.hit, at packet.distance.
  void (*hit_point)(const kernel::RayPacket<T>& packet, const SphereLanes<T>& spheres, PointLanes<T>& out);
};

/// Domain     kExact or kBook
IntersectFunctions<double> intersect_double(kernel::Precision precision, test::Lanes lanes);

/// For the precision `fast`.
IntersectFunctions<float> intersect_float(test::Lanes lanes);

}  // namespace orrery::bench
