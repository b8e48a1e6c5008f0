// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "scene/scene.h"

namespace orrery::test {

/// A camera enclosed by six diffuse spheres. Sky light enters through eight gaps at the corners, which shrink as the
/// radius grows and close at a radius of 3.92.
inline scene::Scene room(double radius, double sky, int width_px, int height_px) {
  scene::Scene s;
  s.image = {width_px, height_px};
  s.camera.look_from = {0, 0, 0};
  s.camera.look_at = {0.3, 0.2, -1};
  s.camera.vfov = 60;
  s.background.type = scene::BackgroundType::kConstant;
  s.background.color = {sky, sky, sky};
  s.materials = {{"wall", scene::Lambertian{{0.5, 0.5, 0.5}}}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double side : {-4.8, 4.8}) {
      std::array<double, 3> center{};
      center[axis] = side;
      s.spheres.push_back({{center[0], center[1], center[2]}, radius, 0, ""});
    }
  }
  return s;
}

}  // namespace orrery::test
