// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/forward.h"
#include "kernel/lights.h"

namespace orrery::compile {

/// The emitters of a scene, and the tree with which light sampling chooses among them; see kernel::Lights. Ranges of
/// leaves are split at the median of their longest axis; ties are broken by id.
struct LightTree {
  std::vector<std::uint32_t> spheres;    ///< object id of each leaf
  std::vector<kernel::LightNode> nodes;  ///< one per leaf; the first is unused unless there are at most Lights::kFew
  std::vector<std::uint32_t> leaves;     ///< see kernel::Lights

  /// Valid until the tree is modified or destroyed.
  kernel::Lights view() const noexcept;
  /// Memory use: 48 bytes per emitter.
  std::size_t bytes() const noexcept;
  /// Peak memory of build_light_tree, including the tree.
  std::size_t bytes_of_build() const noexcept;
};

/// Builds the tree of all spheres and halves of rods that emit, except duplicates, which rays do not hit.
/// Deterministic; scaling the scene by a power of two changes no choice.
///
/// Cost       O(n log n) for n emitters; twice the memory of the tree
LightTree build_light_tree(const kernel::SceneView& scene);

}  // namespace orrery::compile
