// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "accel/box_frame.h"
#include "accel/embree_compat.h"
#include "accel/traversal.h"
#include "kernel/sphere_array.h"

namespace orrery::accel {

/// The data of a packet query: Embree's scene, and the spheres outside it.
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
  /// If there is a SphereBvh: ascending ids of the static spheres outside it, one primitive each.
  std::vector<std::uint32_t> singles;
  bool has_bvh = false;  ///< `traversals` applies to the SphereBvh
  /// Whether Embree hands packets to its callbacks as they are. Otherwise, as with an Embree that was built or opened
  /// for narrower vectors than this program uses, it divides them, and even traces rays that are not valid.
  bool has_packets = false;
  Traversals traversals;

  /// Whether Embree receives packets, with this choice for its traversal.
  bool by_packets(Traversal chosen) const noexcept { return has_packets && (has_bvh || chosen == Traversal::kPacket); }

  /// The sphere of a primitive: ids count all spheres, primitives only those that are not outliers.
  std::uint32_t sphere_id(std::uint32_t geometry, std::uint32_t primitive) const noexcept {
    if (!singles.empty() && (geometry > 0 || moving_primitives == 0)) return singles[primitive];
    primitive += geometry * moving_primitives;
    for (const std::uint32_t id : outliers) primitive += primitive >= id ? 1u : 0u;
    return primitive;
  }
};

}  // namespace orrery::accel
