// SPDX-License-Identifier: Apache-2.0
#include "support/recorded_rays.h"

#include <memory>
#include <utility>

#include "accel/accel.h"
#include "kernel/path_stream.h"
#include "kernel/pixel_sum.h"
#include "kernel/render_tile.h"
#include "kernel/scene_view.h"
#include "math/pixels.h"

namespace orrery::bench {
namespace {

/// Forwards queries to the tracer and keeps the traced packets.
template <class T>
struct Recorder {
  kernel::Tracer tracer;
  RecordedRays<T> rays;

  // The kernel passes `self` as const, but a recorder changes.
  static void trace(const void* self, void* memory, int count) {
    auto& recorder = *static_cast<Recorder*>(const_cast<void*>(self));
    auto* const packets = static_cast<kernel::RayPacket<T>*>(memory);
    kernel::trace(recorder.tracer, packets, count);
    const bool from_camera = packets->self[0] == kernel::kCamera;
    auto& traced = from_camera ? recorder.rays.camera : recorder.rays.secondary;
    traced.insert(traced.end(), packets, packets + count);
  }
  static void occlude(const void* self, void* memory, int count) {
    const kernel::Tracer& tracer = static_cast<const Recorder*>(self)->tracer;
    tracer.occlude(tracer.self, memory, count);
  }
};

}  // namespace

template <class T>
RecordedRays<T> record_rays(const kernel::SceneView& view, const accel::Accel& accel, kernel::Precision precision,
                            const std::vector<kernel::Tile>& tiles) {
  Recorder<T> recorder{accel.tracer(), {}};
  const kernel::Tracer tap{Recorder<T>::trace, Recorder<T>::occlude, &recorder};
  const kernel::RenderTile render_tile = kernel::render_tile_function(view.features, precision, false);
  const auto stream = std::make_unique<kernel::PathStream>();
  std::vector<kernel::PixelSum> sums;
  for (kernel::Tile tile : tiles) {
    const std::size_t pixels = math::pixel_count(tile.width, tile.height);
    sums.assign(pixels, {});
    tile.sums = sums.data();
    tile.row_stride = tile.width;
    render_tile(view, tap, tile, *stream);
    recorder.rays.paths += tile.path_count();
  }
  return std::move(recorder.rays);
}

template RecordedRays<double> record_rays(const kernel::SceneView&, const accel::Accel&, kernel::Precision,
                                          const std::vector<kernel::Tile>&);
template RecordedRays<float> record_rays(const kernel::SceneView&, const accel::Accel&, kernel::Precision,
                                         const std::vector<kernel::Tile>&);

}  // namespace orrery::bench
