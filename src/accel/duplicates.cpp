// SPDX-License-Identifier: Apache-2.0
#include "accel/duplicates.h"

#include "base/duplicates.h"
#include "kernel/coincidence.h"
#include "kernel/scene_view.h"

namespace orrery::accel {

std::vector<std::uint32_t> duplicates(const kernel::SceneView& scene, kernel::Precision precision) {
  if (kernel::is_distinct(scene, precision)) return {};
  const auto place = [&](std::size_t id) { return kernel::coincidence_key<4>(scene, id, precision); };
  const auto path = [&](std::size_t id) { return kernel::coincidence_key<8>(scene, id, precision); };
  const std::vector<base::Duplicate> found = scene.moving_count > 0
                                                 ? base::find_duplicates<8>(scene.sphere_count, path)
                                                 : base::find_duplicates<4>(scene.sphere_count, place);
  std::vector<std::uint32_t> ids;
  ids.reserve(found.size());
  for (const base::Duplicate& r : found) ids.push_back(static_cast<std::uint32_t>(r.index));
  return ids;
}

}  // namespace orrery::accel
