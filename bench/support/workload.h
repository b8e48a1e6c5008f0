// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <utility>

#include "accel/accel.h"
#include "kernel/ray_packet.h"
#include "kernel/render_tile.h"
#include "support/recorded_rays.h"
#include "support/scenes.h"

namespace orrery::bench {

/// Size of the image rendered to record rays.
inline constexpr int kRecordedWidth = 48, kRecordedHeight = 27;  // px
inline constexpr int kRecordedSamples = kernel::kPacketSize;     // per pixel

/// A scene and everything that is prepared outside the timed loop; T is the number type of its precision.
template <class T>
struct Workload {
  scene::Scene scene;
  compile::CompiledScene compiled;
  std::unique_ptr<accel::Accel> embree, list;  ///< Precision::kBook: both are lists
  RecordedRays<T> rays;

  Workload(scene::Scene authored, kernel::Precision precision)
      : scene(std::move(authored)),
        compiled(compile_for(scene, precision)),
        embree(precision == kernel::Precision::kBook ? accel::make_list(compiled.view(), precision)
                                                     : accel::make_embree(compiled.view(), precision)),
        list(accel::make_list(compiled.view(), precision)) {
    kernel::Tile whole;
    whole.width = kRecordedWidth;
    whole.height = kRecordedHeight;
    whole.sample_end = kRecordedSamples;
    rays = record_rays<T>(compiled.view(), *embree, precision, {whole});
  }
};

/// The book's final scene (`spheres` = 0) or a cloud, created on first use and cached, because interleaved repetitions
/// return to it many times.
template <class T>
Workload<T>& workload(std::uint64_t spheres, kernel::Precision precision) {
  static std::map<std::pair<std::uint64_t, kernel::Precision>, std::unique_ptr<Workload<T>>> known;
  auto& entry = known[{spheres, precision}];
  if (!entry) {
    entry = std::make_unique<Workload<T>>(spheres == 0
                                              ? final_scene(kRecordedWidth, kRecordedHeight, kRecordedSamples)
                                              : cloud_scene(spheres, kRecordedWidth, kRecordedHeight, kRecordedSamples),
                                          precision);
  }
  return *entry;
}

}  // namespace orrery::bench
