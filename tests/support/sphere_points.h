// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

#include "accel/embree_api.h"
#include "kernel/sphere.h"

namespace orrery::accel {

/// Builds a scene of Embree's built-in sphere points, rounded to float; radii are not padded.
///
/// Errors     those of OwnedScene::commit()
inline void build_sphere_points(OwnedScene& scene, std::size_t count,
                                const std::function<kernel::Sphere(std::size_t i)>& sphere_at) {
  RTCGeometry geometry = rtcNewGeometry(scene.device(), RTC_GEOMETRY_TYPE_SPHERE_POINT);
  auto* const vertices = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), count));
  for (std::size_t i = 0; vertices != nullptr && i < count; ++i) {
    const kernel::Sphere s = sphere_at(i);
    vertices[4 * i] = static_cast<float>(s.x);
    vertices[4 * i + 1] = static_cast<float>(s.y);
    vertices[4 * i + 2] = static_cast<float>(s.z);
    vertices[4 * i + 3] = static_cast<float>(s.radius);
  }
  scene.attach(geometry);
  scene.commit();
}

}  // namespace orrery::accel
