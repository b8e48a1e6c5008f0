// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace orrery::kernel {

/// Sampling of direct light at non-delta vertices.
enum class DirectLighting : std::uint8_t {
  kMis,    ///< light and BSDF sampling, weighted by the power heuristic
  kBsdf,   ///< BSDF sampling only
  kLight,  ///< light sampling only, wherever the light can be sampled
};

/// A bounding sphere of emitters and their power. Centre and radius are loaded as four doubles.
struct LightNode {
  double center[3];
  double radius;
  double power;  ///< radiance, summed over the channels, times radius^2, summed over the emitters
};

/// A range of leaves of the light tree.
struct LightRange {
  std::uint32_t begin, end;
};

/// The emitting spheres, as leaves of an implicit balanced tree: a range of leaves is split in the middle, down to
/// single leaves. Up to kFew emitters form a list instead. Non-owning.
struct Lights {
  static constexpr std::uint32_t kNoLeaf = 0xffffffffu;
  /// Maximum number of emitters that are sampled from a list (measured: docs/decisions/0022-direct-lighting.md).
  static constexpr std::uint32_t kFew = 64;

  const std::uint32_t* spheres = nullptr;  ///< sphere id of each leaf
  /// Nodes of the tree: that of a range of two or more leaves is at its `middle`. For a list, one node per leaf.
  const LightNode* nodes = nullptr;
  /// Leaf of each sphere from `first_sphere` to `end_sphere`, or kNoLeaf. If the emitters' ids are `scattered`: the
  /// leaves by ascending sphere id.
  const std::uint32_t* leaves = nullptr;
  std::uint32_t first_sphere = 0;
  std::uint32_t end_sphere = 0;
  std::uint32_t count = 0;  ///< leaves; 0: no emitter is sampled
  bool scattered = false;

  bool few() const noexcept { return count <= kFew; }
  static std::uint32_t middle(LightRange r) noexcept { return r.begin + (r.end - r.begin) / 2; }
  /// The leaf of a sphere, or kNoLeaf.
  std::uint32_t leaf(std::uint32_t sphere) const noexcept {
    if (!scattered) return sphere >= first_sphere && sphere < end_sphere ? leaves[sphere - first_sphere] : kNoLeaf;
    const std::uint32_t* const found = std::lower_bound(
        leaves, leaves + count, sphere, [&](std::uint32_t at, std::uint32_t id) { return spheres[at] < id; });
    return found != leaves + count && spheres[*found] == sphere ? *found : kNoLeaf;
  }
};

}  // namespace orrery::kernel
