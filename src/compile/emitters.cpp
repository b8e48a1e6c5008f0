// SPDX-License-Identifier: Apache-2.0
#include "compile/emitters.h"

#include <cstddef>

#include "base/duplicates.h"
#include "kernel/coincidence.h"
#include "kernel/scene_view.h"

namespace orrery::compile {

std::vector<std::uint32_t> without_coincident(const kernel::SceneView& scene, kernel::Precision precision,
                                              std::vector<std::uint32_t> ids) {
  if (ids.empty() || kernel::is_distinct(scene, precision)) return ids;
  const std::size_t count = std::size_t{ids.back()} + 1;
  const auto place = [&](std::size_t id) { return kernel::coincidence_key<4>(scene, id, precision); };
  const auto path = [&](std::size_t id) { return kernel::coincidence_key<8>(scene, id, precision); };
  const std::vector<base::Duplicate> found =
      scene.moving_count > 0 ? base::find_duplicates<8>(count, path) : base::find_duplicates<4>(count, place);
  auto next = found.begin();
  std::erase_if(ids, [&](std::uint32_t id) {
    while (next != found.end() && next->index < id) ++next;
    return next != found.end() && next->index == id;
  });
  return ids;
}

}  // namespace orrery::compile
