// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

#include "accel/accel.h"
#include "kernel/ray_packet.h"
#include "kernel/render_tile.h"
#include "render/recorded_rays.h"
#include "render/traversals.h"
#include "support/scenes.h"

namespace orrery::bench {

/// Size of the image rendered to record rays.
inline constexpr int kRecordedWidth = 48, kRecordedHeight = 27;  // px
inline constexpr int kRecordedSamples = kernel::kPacketSize;     // per pixel

/// A scene and everything that is prepared outside the timed loop.
template <class Packet>
struct Workload {
  scene::Scene scene;
  compile::CompiledScene compiled;
  std::unique_ptr<accel::Accel> embree, list;  ///< Precision::kBook: both are lists
  render::RecordedRays<Packet> rays;

  Workload(scene::Scene authored, kernel::Precision precision)
      : scene(std::move(authored)),
        compiled(compile_for(scene, precision)),
        embree(precision == kernel::Precision::kBook ? accel::make_list(compiled.view(), precision)
                                                     : accel::make_embree(compiled.view(), precision)),
        list(accel::make_list(compiled.view(), precision)) {
    embree->use(render::choose_traversals(compiled, *embree, std::nullopt));
    kernel::Tile whole;
    whole.width = kRecordedWidth;
    whole.height = kRecordedHeight;
    whole.sample_end = kRecordedSamples;
    if constexpr (std::is_same_v<Packet, kernel::RayPacketFast>) {
      rays = render::record_rays_fast(compiled.view(), *embree, {whole});
    } else {
      rays = render::record_rays(compiled.view(), *embree, precision, {whole});
    }
  }
};

/// The book's final scene (`spheres` = 0) or a cloud, created on first use and cached, because interleaved repetitions
/// return to it many times.
template <class Packet>
Workload<Packet>& workload(std::uint64_t spheres, kernel::Precision precision) {
  static std::map<std::pair<std::uint64_t, kernel::Precision>, std::unique_ptr<Workload<Packet>>> known;
  auto& entry = known[{spheres, precision}];
  if (!entry) {
    entry = std::make_unique<Workload<Packet>>(
        spheres == 0 ? final_scene(kRecordedWidth, kRecordedHeight, kRecordedSamples)
                     : cloud_scene(spheres, kRecordedWidth, kRecordedHeight, kRecordedSamples),
        precision);
  }
  return *entry;
}

}  // namespace orrery::bench
