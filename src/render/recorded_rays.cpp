// SPDX-License-Identifier: Apache-2.0
#include "render/recorded_rays.h"

#include <chrono>
#include <memory>
#include <utility>

#include "accel/accel.h"
#include "kernel/path_stream.h"
#include "kernel/pixel_sum.h"
#include "kernel/render_tile.h"
#include "kernel/scene_view.h"

namespace orrery::render {
namespace {

/// Forwards queries to the tracer and keeps the traced packets.
template <class Packet>
struct Recorder {
  kernel::Tracer tracer;
  RecordedRays<Packet> rays;

  void keep(const Packet& packet) {
    const bool from_camera = packet.self[0] == kernel::kNoSphere;
    (from_camera ? rays.camera : rays.secondary).push_back(packet);
  }
};

void trace(const void* self, kernel::RayPacket& packet) {
  // The kernel passes `self` as const, but a recorder changes.
  auto& recorder = *static_cast<Recorder<kernel::RayPacket>*>(const_cast<void*>(self));
  recorder.tracer.trace(recorder.tracer.self, packet);
  recorder.keep(packet);
}
void trace_fast(const void* self, kernel::RayPacketFast& packet) {
  auto& recorder = *static_cast<Recorder<kernel::RayPacketFast>*>(const_cast<void*>(self));
  recorder.tracer.trace_fast(recorder.tracer.self, packet);
  recorder.keep(packet);
}

template <class Packet>
const kernel::Tracer& recorded(const void* self) {
  return static_cast<const Recorder<Packet>*>(self)->tracer;
}
void occlude(const void* self, kernel::ShadowPacket& packet) {
  kernel::occlude(recorded<kernel::RayPacket>(self), packet);
}
void occlude_fast(const void* self, kernel::ShadowPacketFast& packet) {
  kernel::occlude(recorded<kernel::RayPacketFast>(self), packet);
}

template <class Packet>
RecordedRays<Packet> record(const kernel::SceneView& view, const accel::Accel& accel, kernel::Precision precision,
                            const std::vector<kernel::Tile>& tiles) {
  Recorder<Packet> recorder{accel.tracer(), {}};
  const kernel::Tracer tap{trace, trace_fast, occlude, occlude_fast, &recorder};
  const kernel::RenderTile render_tile = kernel::render_tile_function(view.features, precision, false);
  const auto stream = std::make_unique<kernel::PathStream>();
  std::vector<kernel::PixelSum> sums;
  for (kernel::Tile tile : tiles) {
    const std::uint64_t pixels = static_cast<std::uint64_t>(tile.width) * static_cast<std::uint64_t>(tile.height);
    sums.assign(pixels, {});
    tile.sums = sums.data();
    tile.row_stride = tile.width;
    render_tile(view, tap, tile, *stream);
    recorder.rays.paths += tile.path_count();
  }
  return std::move(recorder.rays);
}

template <class Packet>
double seconds_to_trace(const kernel::Tracer& tracer, std::vector<Packet>& packets) {
  const auto begin = std::chrono::steady_clock::now();
  for (Packet& packet : packets) {
    kernel::reset_hits(packet);
    kernel::trace(tracer, packet);
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

RecordedRays<kernel::RayPacket> record_rays(const kernel::SceneView& view, const accel::Accel& accel,
                                            kernel::Precision precision, const std::vector<kernel::Tile>& tiles) {
  return record<kernel::RayPacket>(view, accel, precision, tiles);
}

RecordedRays<kernel::RayPacketFast> record_rays_fast(const kernel::SceneView& view, const accel::Accel& accel,
                                                     const std::vector<kernel::Tile>& tiles) {
  return record<kernel::RayPacketFast>(view, accel, kernel::Precision::kFast, tiles);
}

double trace_again(const kernel::Tracer& tracer, std::vector<kernel::RayPacket>& packets) {
  return seconds_to_trace(tracer, packets);
}
double trace_again(const kernel::Tracer& tracer, std::vector<kernel::RayPacketFast>& packets) {
  return seconds_to_trace(tracer, packets);
}

}  // namespace orrery::render
