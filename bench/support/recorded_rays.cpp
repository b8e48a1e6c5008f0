// SPDX-License-Identifier: Apache-2.0
#include "support/recorded_rays.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <type_traits>

#include "kernel/render_tile.h"

namespace orrery::bench {
namespace {

/// Stands between the kernel and the traversal, and writes down what passes.
template <class Packet>
struct Recorder {
  kernel::Tracer tracer;
  RecordedRays<Packet> rays;

  void keep(const Packet& packet) {
    const bool from_camera = packet.self[0] == kernel::kNoSphere;
    (from_camera ? rays.camera : rays.bounced).push_back(packet);
  }
};

void trace(const void* self, kernel::RayPacket& packet) {
  // Tracers are const to the kernel, which a recorder can't be.
  auto& recorder = *static_cast<Recorder<kernel::RayPacket>*>(const_cast<void*>(self));
  recorder.tracer.trace(recorder.tracer.self, packet);
  recorder.keep(packet);
}
void trace_fast(const void* self, kernel::RayPacketFast& packet) {
  auto& recorder = *static_cast<Recorder<kernel::RayPacketFast>*>(const_cast<void*>(self));
  recorder.tracer.trace_fast(recorder.tracer.self, packet);
  recorder.keep(packet);
}

template <class Packet, class Stream, class Render>
RecordedRays<Packet> record(const kernel::SceneView& view, const accel::Accel& accel, Render render) {
  Recorder<Packet> recorder{accel.tracer(), {}};
  const kernel::Tracer tap{trace, trace_fast, &recorder};
  std::vector<kernel::PixelSum> sums(std::size_t{kRecordedWidth} * kRecordedHeight);
  const auto stream = std::make_unique<Stream>();
  render(view, tap, {0, 0, kRecordedWidth, kRecordedHeight, 0, kRecordedSamples, sums.data(), kRecordedWidth}, *stream);
  return std::move(recorder.rays);
}

}  // namespace

RecordedRays<kernel::RayPacket> record_rays(const kernel::SceneView& view, const accel::Accel& accel,
                                            kernel::Precision precision) {
  return record<kernel::RayPacket, kernel::PathStream>(view, accel, kernel::render_tile_function(precision));
}

RecordedRays<kernel::RayPacketFast> record_rays_fast(const kernel::SceneView& view, const accel::Accel& accel) {
  return record<kernel::RayPacketFast, kernel::PathStreamFast>(view, accel, kernel::render_tile_fast_function());
}

template <class Packet>
void forget_hits(Packet& packet) {
  using T = std::remove_reference_t<decltype(packet.distance[0])>;
  std::fill_n(packet.distance, kernel::kPacketSize, std::numeric_limits<T>::max());
  std::fill_n(packet.hit, kernel::kPacketSize, kernel::kNoSphere);
}

template void forget_hits(kernel::RayPacket& packet);
template void forget_hits(kernel::RayPacketFast& packet);

}  // namespace orrery::bench
