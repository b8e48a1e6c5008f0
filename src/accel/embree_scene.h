// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "accel/box_frame.h"
#include "accel/embree_api.h"
#include "accel/traversal.h"
#include "kernel/precision.h"
#include "kernel/ray_packet.h"
#include "kernel/scene_view.h"

namespace orrery::accel {

class SphereBvh;

/// A primitive of a rod: a part of its length. All parts of a rod are tested as the whole rod.
struct RodPiece {
  std::uint32_t rod;
  std::uint16_t index, count;
};

/// The data of a packet query: Embree's scene, and the spheres outside it.
struct EmbreeScene {
  RTCScene scene = nullptr;  ///< null if every sphere is an outlier
  /// Its objects, their motion and opacity; of what else it has, only the duplicates are read, in the build.
  kernel::SceneView view;
  BoundedSpheres bounded;
  /// Number of moving primitives. If not 0, they are Embree's geometry 0, with two time steps, and the others geometry
  /// 1; otherwise there is only one geometry.
  std::uint32_t moving_primitives = 0;
  std::vector<RodPiece> rod_pieces;  ///< the primitives of the rods' geometry
  BoxFrame frame;
  /// Ascending ids of spheres so much larger than the rest that their boxes would enclose everything (a ground). Every
  /// ray tests them first, so that their hits limit the traversal.
  std::vector<std::uint32_t> outliers;
  /// If there is a SphereBvh: ascending ids of the spheres outside it, one primitive each.
  std::vector<std::uint32_t> singles;
  /// The traversal is that of this BVH; Embree receives packets. Null: there is none.
  const SphereBvh* bvh = nullptr;
  bool is_bvh_alone = false;  ///< Embree's scene has nothing else
  /// Whether Embree hands packets to its callbacks as they are. Otherwise, as with an Embree that was built or opened
  /// for narrower vectors than this program uses, it divides them, and even traces rays that are not valid.
  bool has_packets = false;

  /// Whether Embree receives packets, with this traversal.
  bool by_packets(Traversal traversal) const noexcept {
    return has_packets && (bvh != nullptr || traversal == Traversal::kPacket);
  }

  bool moves() const noexcept { return view.moving_count > 0 || view.rods.any_moves(); }
  /// Whether no sphere moves or may be invisible: the tests of spheres are then instances without these branches.
  bool is_plain() const noexcept { return view.moving_count == 0 && view.opacity == nullptr; }

  /// The sphere of a primitive: ids count all spheres, primitives only those that are not outliers.
  std::uint32_t sphere_id(std::uint32_t geometry, std::uint32_t primitive) const noexcept {
    primitive += geometry * moving_primitives;
    if (!singles.empty()) return singles[primitive];
    for (const std::uint32_t id : outliers) primitive += primitive >= id ? 1u : 0u;
    return primitive;
  }
};

/// One call into Embree with some lanes of a packet. Embree passes the context to the callback, which finds the packet
/// through it and stores the result in the packet, in the packet's precision. Embree's hit record is not used.
template <class Packet>
struct EmbreeQuery {
  EmbreeContext context;  // first member, so that Embree's pointer to it points to the query
  const EmbreeScene* scene;
  Packet* packet;
  Traversal traversal;
  int first;  ///< packet lane that corresponds to Embree's lane 0
  /// Distance by which each ray was advanced, indexed by Embree's lane, box space.
  alignas(64) typename Packet::Number start[kernel::kPacketSize];
};

/// A scene, and how its rays traverse it.
struct TracedScene {
  const EmbreeScene* scene;
  Traversals traversals;
};

/// Callbacks and tracer, instantiated for the instruction set of this processor and for one precision.
struct EmbreeFunctions {
  struct Callbacks {
    RTCIntersectFunctionN intersect = nullptr;
    RTCOccludedFunctionN occluded = nullptr;
  };
  Callbacks spheres, rods;
  Callbacks bvh;          ///< for a geometry whose user data is a SphereBvh
  int width = 0;          ///< rays per packet handed to Embree
  kernel::Tracer tracer;  ///< `self` is to be set: a TracedScene

  kernel::Tracer tracer_of(const TracedScene& scene) const noexcept {
    kernel::Tracer t = tracer;
    t.self = &scene;
    return t;
  }
};

/// Domain     precision is exact or fast
EmbreeFunctions embree_functions(kernel::Precision precision);

}  // namespace orrery::accel
