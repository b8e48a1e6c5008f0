// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "kernel/forward.h"

namespace orrery::accel {

/// How rays traverse the BVH. Hits do not depend on it.
enum class Traversal : std::uint8_t {
  kPacket,  ///< the rays of a packet together, which pays off as long as they visit the same nodes
  kSingle,  ///< each ray separately
};

/// The traversals of a scene's rays.
struct Traversals {
  Traversal camera = Traversal::kPacket;
  Traversal others = Traversal::kPacket;  ///< of secondary rays and shadow rays

  bool operator==(const Traversals&) const = default;
};

/// The traversals that are fastest (docs/decisions/0011-packets-where-rays-stay-together.md).
///
/// `has_bvh`  most objects are in a SphereBvh, instead of each being a primitive of Embree
Traversals fastest_traversals(const kernel::SceneView& scene, bool has_bvh);

/// For example "packet", or "packet, secondary and shadow single".
std::string name_of(const Traversals& traversals);

}  // namespace orrery::accel
