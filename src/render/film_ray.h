// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "kernel/camera.h"
#include "kernel/ray_packet.h"

namespace orrery::render {

/// Sets a lane of a packet to the ray through a point of the image, when the shutter opens and from the centre of the
/// lens. Its key is 0.
///
/// `x`, `y`   px from the upper left corner of the rendered window
template <class T>
void set_film_ray(const kernel::Camera& camera, double x, double y, kernel::RayPacket<T>& packet, int lane) {
  double film[3], direction[3], square = 0;
  for (int axis = 0; axis < 3; ++axis) {
    film[axis] = (x - camera.half_width) * camera.right[axis] + (y - camera.half_height) * camera.down[axis];
    direction[axis] = camera.forward[axis] + (camera.is_orthographic ? 0 : film[axis]);
    square += direction[axis] * direction[axis];
  }
  for (int axis = 0; axis < 3; ++axis) {
    packet.offset[axis][lane] = static_cast<T>(camera.is_orthographic ? film[axis] : 0);
    packet.origin[axis][lane] = static_cast<T>(camera.origin[axis]) + packet.offset[axis][lane];
    packet.direction[axis][lane] = static_cast<T>(direction[axis] / std::sqrt(square));
  }
  packet.inverse_square[lane] = 1;
  packet.self[lane] = kernel::kNoSphere;
  packet.key[lane] = 0;
}

}  // namespace orrery::render
