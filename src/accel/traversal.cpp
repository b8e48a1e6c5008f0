// SPDX-License-Identifier: Apache-2.0
#include "accel/traversal.h"

#include <cstddef>

#include "accel/sphere_classes.h"
#include "kernel/isa.h"
#include "kernel/scene_view.h"

namespace orrery::accel {

Traversals fastest_traversals(const kernel::SceneView& scene, bool has_bvh) {
  // Measured in clouds, crystals and layers (docs/benchmarks.md). Packets of 16 rays pay off for longer than those
  // of 8.
  const std::size_t few = kernel::isa_name() == "avx512" ? 1000 : 700;
  const bool are_few = !has_bvh && scene.sphere_count + scene.rods.count < few;
  return {Traversal::kPacket, are_few || is_layer(scene) ? Traversal::kPacket : Traversal::kSingle};
}

std::string name_of(const Traversals& traversals) {
  const auto name = [](Traversal traversal) { return traversal == Traversal::kPacket ? "packet" : "single"; };
  std::string out = name(traversals.camera);
  if (traversals.others != traversals.camera) out += std::string(", secondary and shadow ") + name(traversals.others);
  return out;
}

}  // namespace orrery::accel
