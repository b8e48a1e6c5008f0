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
#include "kernel/sphere_array.h"

namespace orrery::accel {

/// The data of a packet query: Embree's scene, and the spheres outside of it.
struct EmbreeScene {
  RTCScene scene = nullptr;  ///< null if every sphere is an outlier
  kernel::SphereArray spheres;
  BoundedSpheres bounded;
  const kernel::Sphere* motion = nullptr;  ///< as in kernel::SceneView
  std::size_t moving_count = 0;
  /// Number of moving primitives. If not 0, they are Embree's geometry 0, with two time steps, and the others geometry
  /// 1; otherwise there is only one geometry.
  std::uint32_t moving_primitives = 0;
  BoxFrame frame;
  /// Ascending ids of spheres so much larger than the rest that their boxes would enclose everything (a ground). Every
  /// ray tests them first, so that their hits limit the traversal.
  std::vector<std::uint32_t> outliers;
  std::vector<std::uint32_t> duplicates;  ///< ascending ids of spheres that are never hit: their boxes are empty
  /// If there is a SphereBvh: ascending ids of the static spheres outside of it, one primitive each.
  std::vector<std::uint32_t> singles;
  bool has_bvh = false;  ///< Embree is passed packets; `traversals` applies to the SphereBvh
  Traversals traversals;

  /// The sphere of a primitive: ids count all spheres, primitives only those that are not outliers.
  std::uint32_t sphere_id(std::uint32_t geometry, std::uint32_t primitive) const noexcept {
    if (!singles.empty() && (geometry > 0 || moving_primitives == 0)) return singles[primitive];
    primitive += geometry * moving_primitives;
    for (const std::uint32_t id : outliers) primitive += primitive >= id ? 1u : 0u;
    return primitive;
  }
};

/// One call into Embree with some lanes of a packet. Embree passes the context to the callback, which finds the packet
/// through it and stores the result there, in the packet's precision. Embree's hit record is not used.
template <class Packet>
struct EmbreeQuery {
  EmbreeContext context;  // first member, so that Embree's pointer to it points to the query
  const EmbreeScene* scene;
  Packet* packet;
  int first;  ///< the packet's lane that is Embree's lane 0
  /// Distance by which each ray was advanced, by Embree's lane, box space.
  alignas(64) std::remove_cvref_t<decltype(Packet::distance[0])> start[kernel::kPacketSize];
};

/// Callbacks and tracer, instantiated for the instruction set of this processor, for one precision, and with or without
/// motion.
struct EmbreeFunctions {
  RTCIntersectFunctionN intersect = nullptr;
  RTCOccludedFunctionN occluded = nullptr;
  RTCIntersectFunctionN intersect_bvh = nullptr;  ///< for a geometry whose user data is a SphereBvh
  RTCOccludedFunctionN occluded_by_bvh = nullptr;
  kernel::Tracer tracer;  ///< `self` is not set

  kernel::Tracer tracer_of(const EmbreeScene& scene) const noexcept {
    kernel::Tracer t = tracer;
    t.self = &scene;
    return t;
  }
};
EmbreeFunctions embree_functions(kernel::Precision precision, bool moves);

/// Adds the occlusion queries to `functions`.
void add_occlusion_functions(EmbreeFunctions& functions, kernel::Precision precision, bool moves);

/// Adds the queries of a SphereBvh to `functions`.
void add_bvh_functions(EmbreeFunctions& functions, kernel::Precision precision);

}  // namespace orrery::accel
