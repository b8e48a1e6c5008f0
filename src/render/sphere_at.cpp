// SPDX-License-Identifier: Apache-2.0
#include "render/sphere_at.h"

#include <cmath>

#include "compile/compiled_scene.h"
#include "kernel/ray_packet.h"

namespace orrery::render {
namespace {

template <class T>
std::optional<std::uint32_t> closest_on_ray(const kernel::Camera& camera, const accel::Accel& accel, double x,
                                            double y) {
  double film[3], direction[3], square = 0;
  for (int axis = 0; axis < 3; ++axis) {
    film[axis] = (x - camera.half_width) * camera.right[axis] + (y - camera.half_height) * camera.down[axis];
    direction[axis] = camera.forward[axis] + (camera.is_orthographic ? 0 : film[axis]);
    square += direction[axis] * direction[axis];
  }
  kernel::RayPacket<T> packet{};
  kernel::reset_hits(packet);
  packet.count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    packet.offset[axis][0] = static_cast<T>(camera.is_orthographic ? film[axis] : 0);
    packet.origin[axis][0] = static_cast<T>(camera.origin[axis]) + packet.offset[axis][0];
    packet.direction[axis][0] = static_cast<T>(direction[axis] / std::sqrt(square));
  }
  packet.inverse_square[0] = 1;
  packet.self[0] = kernel::kNoSphere;
  kernel::trace(accel.tracer(), packet);
  if (packet.hit[0] == kernel::kNoSphere) return {};
  return static_cast<std::uint32_t>(packet.hit[0]);
}

}  // namespace

std::optional<std::uint32_t> sphere_at(const compile::CompiledScene& scene, const accel::Accel& accel, double x,
                                       double y) {
  return scene.precision == kernel::Precision::kFast ? closest_on_ray<float>(scene.camera, accel, x, y)
                                                     : closest_on_ray<double>(scene.camera, accel, x, y);
}

}  // namespace orrery::render
