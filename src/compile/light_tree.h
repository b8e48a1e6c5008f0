// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kernel/forward.h"
#include "kernel/lights.h"
#include "kernel/precision.h"

namespace orrery::compile {

/// The emitters of a scene, and the tree with which light sampling chooses among them; see kernel::Lights. Ranges of
/// leaves are split at the median of their longest axis; ties are broken by id.
struct LightTree {
  std::vector<std::uint32_t> spheres;    ///< object id of each leaf
  std::vector<kernel::LightNode> nodes;  ///< one per leaf; the first is unused unless there are at most Lights::kFew
  std::vector<std::uint32_t> leaves;     ///< see kernel::Lights
  std::uint32_t first_sphere = 0;
  std::uint32_t end_sphere = 0;
  bool scattered = false;  ///< see kernel::Lights
  std::optional<kernel::Precision>
      precision;  ///< precision in which its spheres do not coincide; empty: there is no tree

  /// Valid until the tree is modified or destroyed.
  kernel::Lights view() const noexcept;
  /// Memory use: at most 52 bytes per emitter, 48 if the ids of the emitters are consecutive.
  std::size_t bytes() const noexcept;
  /// Peak memory of build_light_tree, including the tree.
  std::size_t bytes_of_build() const noexcept;
};

/// Removes spheres, and halves of rods, that coincide with an earlier one of the scene, whether that emits or not. Rays
/// hit the first, so the others emit no light.
///
/// `ids`      ascending
/// Result     ascending
/// Cost       see base::find_duplicates: for the spheres up to the last id, unless they are known to be distinct,
///            and for the rods, if there are any among the ids
std::vector<std::uint32_t> without_coincident(const kernel::SceneView& scene, kernel::Precision precision,
                                              std::vector<std::uint32_t> ids);

/// Builds the tree of all spheres that emit and do not coincide with an earlier sphere, which in `fast` depends on the
/// precision. Deterministic; scaling the scene by a power of two changes no choice.
///
/// Cost       O(n log n) for n emitters; twice the memory of the tree; that of without_coincident
LightTree build_light_tree(const kernel::SceneView& scene, kernel::Precision precision);

}  // namespace orrery::compile
