// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernel/camera.h"
#include "kernel/ray_packet.h"
#include "math/vec3.h"

namespace orrery::render {

/// Sets a lane of a packet to the ray through a point of the image, when the shutter opens and from the centre of the
/// lens. Its threshold is 0.
///
/// `x`, `y`   px from the upper left corner of the rendered window
template <class T>
void set_film_ray(const kernel::Camera& camera, double x, double y, kernel::RayPacket<T>& packet, int lane) {
  const math::Vec3d film = (x - camera.half_width) * camera.right + (y - camera.half_height) * camera.down;
  const math::Vec3d offset = camera.is_orthographic ? film : math::Vec3d{};
  const math::Vec3d direction = normalized(camera.is_orthographic ? camera.forward : camera.forward + film);
  const auto set = [lane](T(&to)[3][kernel::kPacketSize], const math::Vec3d& v) {
    to[0][lane] = static_cast<T>(v.x);
    to[1][lane] = static_cast<T>(v.y);
    to[2][lane] = static_cast<T>(v.z);
  };
  set(packet.offset, offset);
  set(packet.origin, camera.origin);
  set(packet.direction, direction);
  for (int axis = 0; axis < 3; ++axis) packet.origin[axis][lane] += packet.offset[axis][lane];
  packet.inverse_square[lane] = 1;
  packet.self[lane] = kernel::kCamera;
  packet.threshold[lane] = 0;
}

}  // namespace orrery::render
