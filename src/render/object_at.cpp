// SPDX-License-Identifier: Apache-2.0
#include "render/object_at.h"

#include <map>

#include "compile/compiled_scene.h"
#include "kernel/ray_packet.h"
#include "render/film_ray.h"

namespace orrery::render {
namespace {

/// Number of packets with different thresholds: objects with an opacity of less than 1/256 are not found.
constexpr int kPackets = 16;

template <class T>
std::optional<std::uint32_t> seen_along_ray(const compile::CompiledScene& scene, const accel::Accel& accel, double x,
                                            double y) {
  kernel::RayPacket<T> packet{};
  packet.count = scene.features.opacity ? kernel::kPacketSize : 1;
  for (int lane = 0; lane < packet.count; ++lane) set_film_ray(scene.camera, x, y, packet, lane);
  std::map<std::uint32_t, int> seen;  // number of rays
  std::optional<std::uint32_t> most;
  for (int i = 0; i < (scene.features.opacity ? kPackets : 1); ++i) {
    kernel::reset_hits(packet);
    for (int lane = 0; lane < packet.count; ++lane)
      packet.threshold[lane] = static_cast<float>(i * kernel::kPacketSize + lane) / (kPackets * kernel::kPacketSize);
    kernel::trace(accel.tracer(), packet);
    for (int lane = 0; lane < packet.count; ++lane) {
      if (packet.hit[lane] == kernel::kNone) continue;
      const auto id = static_cast<std::uint32_t>(packet.hit[lane]);
      ++seen[id];
      if (!most || seen[id] > seen[*most]) most = id;
    }
  }
  return most;
}

}  // namespace

std::optional<std::uint32_t> object_at(const compile::CompiledScene& scene, const accel::Accel& accel, double x,
                                       double y) {
  return scene.precision == kernel::Precision::kFast ? seen_along_ray<float>(scene, accel, x, y)
                                                     : seen_along_ray<double>(scene, accel, x, y);
}

}  // namespace orrery::render
