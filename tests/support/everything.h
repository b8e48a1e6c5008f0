// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include "scene/scene.h"

namespace orrery::test {

/// A scene with every material, a lens, and touching spheres.
inline scene::Scene everything() {
  scene::Scene s;
  s.image = {61, 37};
  s.camera.look_from = {3, 2, 4};
  s.camera.look_at = {0, 0.3, 0};
  s.camera.vfov = 40;
  s.camera.defocus_angle = 2;
  s.render.samples = 7;
  s.materials = {{"ground", scene::Lambertian{{0.5, 0.6, 0.4}}},
                 {"old", scene::Hemisphere{{0.7, 0.3, 0.3}}},
                 {"mirror", scene::Metal{{0.9, 0.9, 0.9}, 0}},
                 {"brushed", scene::Metal{{0.8, 0.6, 0.2}, 0.4}},
                 {"glass", scene::Dielectric{1.5, scene::Fresnel::kSchlick}},
                 {"crystal", scene::Dielectric{2.4, scene::Fresnel::kExact}}};
  s.spheres = {{{0, -1000, 0}, 1000, 0, ""}, {{-1, 0.5, 0}, 0.5, 1, ""},  {{0, 0.5, 0}, 0.5, 2, ""},
               {{1, 0.5, 0}, 0.5, 3, ""},    {{0, 0.5, 1}, 0.5, 4, ""},   {{0, 0.5, 1}, -0.45, 4, ""},
               {{1, 0.5, 1.5}, 0.5, 5, ""},  {{-1, 0.4, 1.2}, 0.4, 0, ""}};
  return s;
}

/// Replaces opaque materials of everything() by plastic, rough and smooth. Only full path loops render it.
inline scene::Scene with_plastic(scene::Scene s) {
  s.materials[0].model = scene::Plastic{{0.5, 0.6, 0.4}, 1.5, 0.3};
  s.materials[3].model = scene::Plastic{{0.8, 0.6, 0.2}, 2, 0};
  return s;
}

/// The scene with an opacity below 1 for all materials that may have one.
inline scene::Scene translucent(scene::Scene s) {
  for (scene::Material& material : s.materials)
    std::visit(
        [](auto& model) {
          if constexpr (requires { model.opacity; }) model.opacity = 0.6;
        },
        material.model);
  return s;
}

}  // namespace orrery::test
