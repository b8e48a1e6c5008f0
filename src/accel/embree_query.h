// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>

#include "accel/embree_compat.h"
#include "kernel/precision.h"
#include "kernel/ray_packet.h"

namespace orrery::accel {

struct EmbreeScene;

/// One call into Embree with some lanes of a packet. Embree passes the context to the callback, which finds the packet
/// through it and stores the result in the packet, in the packet's precision. Embree's hit record is not used.
template <class Packet>
struct EmbreeQuery {
  EmbreeContext context;  // first member, so that Embree's pointer to it points to the query
  const EmbreeScene* scene;
  Packet* packet;
  int first;     ///< packet lane that corresponds to Embree's lane 0
  int lane = 0;  ///< of a ray that is traced alone: its distance from the first lane of its register
  /// Distance by which each ray was advanced, indexed by Embree's lane, box space.
  alignas(64) std::remove_cvref_t<decltype(Packet::distance[0])> start[kernel::kPacketSize];
};

/// Callbacks and tracer, instantiated for the instruction set of this processor, for one precision, and with or without
/// motion.
struct EmbreeFunctions {
  RTCIntersectFunctionN intersect = nullptr;
  RTCOccludedFunctionN occluded = nullptr;
  RTCIntersectFunctionN intersect_bvh = nullptr;  ///< for a geometry whose user data is a SphereBvh
  RTCOccludedFunctionN occluded_by_bvh = nullptr;
  int width = 0;          ///< rays per packet handed to Embree
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
