// SPDX-License-Identifier: Apache-2.0
// Renders one sphere through the installed libraries.
#include "compile/compile.h"
#include "render/render.h"

int main() {
  orrery::scene::Scene scene;
  scene.image = {16, 16};
  scene.render.samples = 4;
  scene.materials = {{"grey", orrery::scene::Lambertian{}}};
  scene.spheres = {{{0, 0, -1}, 0.5, 0, ""}};
  const auto result = orrery::render::render(orrery::compile::compile(scene), {});
  return result.completed && result.picture.planes.size() == 4 ? 0 : 1;
}
