// SPDX-License-Identifier: Apache-2.0
// Renders one sphere with the installed libraries.
#include <cstdio>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"
#include "scene/scene.h"

int main() {
  orrery::scene::Scene scene;
  scene.image = {16, 16};
  scene.render.samples = 4;
  scene.materials = {{"grey", orrery::scene::Lambertian{}}};
  scene.spheres = {{{0, 0, -1}, 0.5, 0, ""}};
  const auto result = orrery::render::render(orrery::compile::compile(scene), {});
  if (!result.completed || result.picture.planes.size() != 4) {
    std::puts("the render failed");
    return 1;
  }
  return 0;
}
