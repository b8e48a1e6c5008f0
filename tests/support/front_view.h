// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

namespace orrery::test {

/// An empty scene before a constant background, seen from (0, 0, 10) along -z.
inline scene::Scene front_view(int width_px, int height_px, math::Vec3d background = {0, 0, 0}) {
  scene::Scene s;
  s.image = {width_px, height_px};
  s.camera.look_from = {0, 0, 10};
  s.camera.look_at = {0, 0, 0};
  s.camera.vfov = 40;
  s.background.type = scene::BackgroundType::kConstant;
  s.background.color = background;
  return s;
}

/// Makes the camera orthographic, with a film of 12 units, about as wide as front_view() sees at the origin.
inline void make_orthographic(scene::Scene& s) {
  s.camera.projection = scene::Projection::kOrthographic;
  s.camera.width = 12;
}

}  // namespace orrery::test
