// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/lights.h"
#include "kernel/scene_view.h"

namespace orrery::compile {

/// The emitters of a scene and the tree by which light sampling chooses between them; see kernel::Lights. Ranges of
/// leaves are split at the median of their longest axis, ties by id.
struct LightTree {
  std::vector<std::uint32_t> spheres;    ///< sphere id of each leaf
  std::vector<kernel::LightNode> nodes;  ///< one per leaf; the first is unused unless there are few
  std::vector<std::uint32_t> leaves;     ///< see kernel::Lights
  std::uint32_t first_sphere = 0;
  std::uint32_t end_sphere = 0;
  bool scattered = false;  ///< see kernel::Lights

  /// Valid until the tree is modified or destroyed.
  kernel::Lights view() const noexcept;
  /// At most 52 per emitter, 48 if the ids of the emitters are consecutive.
  std::size_t bytes() const noexcept;
  /// With what build_light_tree allocated in addition.
  std::size_t bytes_of_build() const noexcept;
};

/// Builds the tree of all spheres that emit. Deterministic; scaling the scene by a power of two changes no choice.
///
/// Cost       O(n log n) for n emitters; twice the memory of the tree
LightTree build_light_tree(const kernel::SceneView& scene);

}  // namespace orrery::compile
