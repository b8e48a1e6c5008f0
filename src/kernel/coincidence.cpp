// SPDX-License-Identifier: Apache-2.0
#include "kernel/coincidence.h"

#include "kernel/scene_view.h"
#include "math/scalar.h"

namespace orrery::kernel {

bool is_distinct(const SceneView& scene, Precision precision) noexcept {
  return precision == Precision::kFast ? scene.distinct_in_single : scene.distinct;
}

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

template std::array<double, 4> coincidence_key<4>(const SceneView& scene, std::size_t id, Precision precision) noexcept;
template std::array<double, 8> coincidence_key<8>(const SceneView& scene, std::size_t id, Precision precision) noexcept;

}  // namespace orrery::kernel
