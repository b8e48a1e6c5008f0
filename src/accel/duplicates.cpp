// SPDX-License-Identifier: Apache-2.0
#include "accel/duplicates.h"

#include <array>

#include "base/repeated.h"
#include "math/single.h"

namespace orrery::accel {

std::vector<std::uint32_t> duplicates(const kernel::SceneView& scene, kernel::Precision precision) {
  const bool is_fast = precision == kernel::Precision::kFast;
  if (is_fast ? scene.distinct_in_single : scene.distinct) return {};
  const auto rounded = [is_fast](auto key) {
    if (is_fast)
      for (double& x : key) x = math::in_single_precision(x);
    return key;
  };
  const auto place = [&](std::size_t id) {
    const kernel::Sphere s = scene.spheres[id];
    return rounded(std::array{s.x, s.y, s.z, s.radius});
  };
  const auto path = [&](std::size_t id) {
    const kernel::Sphere s = scene.spheres[id];
    const kernel::Sphere change = id < scene.moving_count ? scene.motion[id] : kernel::Sphere{0, 0, 0, 0};
    return rounded(std::array{s.x, s.y, s.z, s.radius, change.x, change.y, change.z, change.radius});
  };
  const std::vector<base::Repeated> found = scene.moving_count > 0 ? base::find_repeated<8>(scene.sphere_count, path)
                                                                   : base::find_repeated<4>(scene.sphere_count, place);
  std::vector<std::uint32_t> ids;
  ids.reserve(found.size());
  for (const base::Repeated& r : found) ids.push_back(static_cast<std::uint32_t>(r.index));
  return ids;
}

}  // namespace orrery::accel
