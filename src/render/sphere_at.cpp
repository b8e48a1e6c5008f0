// SPDX-License-Identifier: Apache-2.0
#include "render/sphere_at.h"

#include <cmath>
#include <map>

#include "compile/compiled_scene.h"
#include "kernel/ray_packet.h"

namespace orrery::render {
namespace {

/// Number of packets with different keys: an opacity of 0.02 is visible to one of the rays with a probability of 99 %.
constexpr int kPackets = 16;

template <class T>
std::optional<std::uint32_t> seen_along_ray(const compile::CompiledScene& scene, const accel::Accel& accel, double x,
                                            double y) {
  const kernel::Camera& camera = scene.camera;
  double film[3], direction[3], square = 0;
  for (int axis = 0; axis < 3; ++axis) {
    film[axis] = (x - camera.half_width) * camera.right[axis] + (y - camera.half_height) * camera.down[axis];
    direction[axis] = camera.forward[axis] + (camera.is_orthographic ? 0 : film[axis]);
    square += direction[axis] * direction[axis];
  }
  kernel::RayPacket<T> packet{};
  packet.count = scene.features.opacity ? kernel::kPacketSize : 1;
  for (int lane = 0; lane < packet.count; ++lane) {
    for (int axis = 0; axis < 3; ++axis) {
      packet.offset[axis][lane] = static_cast<T>(camera.is_orthographic ? film[axis] : 0);
      packet.origin[axis][lane] = static_cast<T>(camera.origin[axis]) + packet.offset[axis][lane];
      packet.direction[axis][lane] = static_cast<T>(direction[axis] / std::sqrt(square));
    }
    packet.inverse_square[lane] = 1;
    packet.self[lane] = kernel::kNoSphere;
  }
  std::map<std::uint32_t, int> seen;  // number of rays
  std::optional<std::uint32_t> most;
  for (int i = 0; i < (scene.features.opacity ? kPackets : 1); ++i) {
    kernel::reset_hits(packet);
    for (int lane = 0; lane < packet.count; ++lane)
      packet.key[lane] = static_cast<std::uint32_t>(i * kernel::kPacketSize + lane) * 0x9e3779b1u;
    kernel::trace(accel.tracer(), packet);
    for (int lane = 0; lane < packet.count; ++lane) {
      if (packet.hit[lane] == kernel::kNoSphere) continue;
      const auto id = static_cast<std::uint32_t>(packet.hit[lane]);
      ++seen[id];
      if (!most || seen[id] > seen[*most]) most = id;
    }
  }
  return most;
}

}  // namespace

std::optional<std::uint32_t> sphere_at(const compile::CompiledScene& scene, const accel::Accel& accel, double x,
                                       double y) {
  return scene.precision == kernel::Precision::kFast ? seen_along_ray<float>(scene, accel, x, y)
                                                     : seen_along_ray<double>(scene, accel, x, y);
}

}  // namespace orrery::render
