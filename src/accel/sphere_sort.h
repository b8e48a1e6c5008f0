// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "accel/sphere_bvh.h"

namespace orrery::accel {

inline constexpr std::size_t kArity = SphereBvh::kArity;
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A sphere while its BVH is built.
struct SphereItem {
  float center[3];  ///< box space
  std::uint32_t id;
};

/// The cells of a BVH's nodes by level, starting with the level above the leaves.
using NodeCells = std::array<std::vector<SphereBvh::Cell>, SphereBvh::kMaxDepth>;

/// Sorts spheres into the order of the leaves of a BVH, using the surface area heuristic.
///
/// `margin`   average radius, for the surface area, box space
/// `reach`    maximum distance of a sphere's surface from its centre, padded, box space
/// `monitor`  receives the progress, 0..1, on any thread; returns false to cancel; or empty
/// Errors     base::Error(kStopped) if the monitor or a base::StopScope cancelled
NodeCells sort_spheres(std::span<SphereItem> items, float margin, float reach,
                       const std::function<bool(double)>& monitor);

}  // namespace orrery::accel
