// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "kernel/precision.h"
#include "kernel/scene_view.h"
#include "math/scalar.h"

namespace orrery::kernel {

/// True if the scene is known to have no coincident spheres in the number type of this precision.
inline bool is_distinct(const SceneView& scene, Precision precision) noexcept {
  return scene.distinct_in && (precision != Precision::kFast || scene.distinct_in == Precision::kFast);
}

/// Centre and radius of a sphere and, if N is 8, their change until the shutter closes, in the number type of this
/// precision. Spheres coincide if all of these numbers are equal.
///
/// Domain     N is 4 or 8, and 8 if a sphere of the scene moves
template <std::size_t N>
std::array<double, N> coincidence_key(const SceneView& scene, std::size_t id, Precision precision) noexcept {
  static_assert(N == 4 || N == 8);
  const Sphere s = scene.spheres[id];
  std::array<double, N> key = {s.x, s.y, s.z, s.radius};
  if constexpr (N == 8) {
    if (id < scene.moving_count) {
      const Sphere& change = scene.motion[id];
      key = {s.x, s.y, s.z, s.radius, change.x, change.y, change.z, change.radius};
    }
  }
  if (precision == Precision::kFast)
    for (double& x : key) x = math::in_single_precision(x);
  return key;
}

}  // namespace orrery::kernel
