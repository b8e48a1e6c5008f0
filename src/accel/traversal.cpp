// SPDX-License-Identifier: Apache-2.0
#include "accel/traversal.h"

#include <cstddef>

#include "accel/sphere_classes.h"
#include "kernel/scene_view.h"

namespace orrery::accel {

Traversals fastest_traversals(const kernel::SceneView& scene, bool has_bvh) {
  constexpr std::size_t kFew = 1000;  // measured in clouds, crystals and layers: docs/benchmarks.md
  const bool are_few = !has_bvh && scene.sphere_count + scene.rods.count < kFew;
  return {Traversal::kPacket, are_few || is_layer(scene) ? Traversal::kPacket : Traversal::kSingle};
}

std::string name_of(const Traversals& traversals) {
  const auto name = [](Traversal traversal) { return traversal == Traversal::kPacket ? "packet" : "single"; };
  std::string out = name(traversals.camera);
  if (traversals.others != traversals.camera) out += std::string(", secondary and shadow ") + name(traversals.others);
  return out;
}

}  // namespace orrery::accel
