// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <type_traits>
#include <vector>

#include "accel/accel.h"
#include "accel/box_frame.h"
#include "accel/embree_compat.h"
#include "kernel/precision.h"
#include "kernel/ray_packet.h"
#include "kernel/sphere.h"

namespace orrery::accel {

/// What tracing a packet needs: Embree's scene, and the spheres that stand outside of it.
struct EmbreeScene {
  RTCScene scene = nullptr;  ///< null where every sphere stands apart
  const kernel::Sphere* spheres = nullptr;
  const kernel::Sphere* motion = nullptr;  ///< as kernel::SceneView has it
  std::size_t moving_count = 0;
  /// Embree's geometry 0 has two time steps where there are such, and geometry 1 has the rest. Else there is but one.
  std::uint32_t moving_primitives = 0;
  BoxFrame frame;
  /// Spheres so much larger than the rest that a box around them would hold everything (a ground): ascending ids,
  /// tested by every ray before the hierarchy is entered, which they shorten.
  std::vector<std::uint32_t> outliers;
  std::vector<std::uint32_t> duplicates;  ///< ascending ids of spheres that no ray meets: their boxes are empty
  Traversals traversals;

  /// The sphere behind a primitive: ids count all spheres, primitives those that do not stand apart.
  std::uint32_t sphere_id(std::uint32_t geometry, std::uint32_t primitive) const noexcept {
    primitive += geometry * moving_primitives;
    for (const std::uint32_t id : outliers) primitive += primitive >= id ? 1u : 0u;
    return primitive;
  }
};

/// One call into Embree: some lanes of a packet. Embree hands the context back to the callback, which finds the packet
/// behind it and writes the hit there, in the packet's own precision; Embree's own hit record is not used.
template <class Packet>
struct EmbreeQuery {
  EmbreeContext context;  // first: Embree's pointer to it is a pointer to all
  const EmbreeScene* scene;
  Packet* packet;
  int first;  ///< lane of the packet that is Embree's lane 0
  /// Box space: distance that a far ray was moved on, by Embree's lane.
  alignas(64) std::remove_cvref_t<decltype(Packet::distance[0])> start[kernel::kPacketSize];
};

/// The functions that were compiled for this processor and are right for a precision, and for spheres that move or
/// that all rest.
struct EmbreeFunctions {
  RTCIntersectFunctionN intersect = nullptr;
  void (*trace)(const void* scene, kernel::RayPacket& packet) = nullptr;
  void (*trace_fast)(const void* scene, kernel::RayPacketFast& packet) = nullptr;
  std::int64_t target = 0;  ///< instruction set that they were compiled for, HWY_AVX2 etc.

  kernel::Tracer tracer(const EmbreeScene& scene) const noexcept { return {trace, trace_fast, &scene, target}; }
};
EmbreeFunctions embree_functions(kernel::Precision precision, bool moves);

}  // namespace orrery::accel
