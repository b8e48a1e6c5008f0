// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <variant>
#include <vector>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "scene/changed_parts.h"
#include "scene/scene.h"

namespace orrery::compile {
namespace {

/// Materials of the opacities 1, 0.25 and 0.5, of which the last is an emitter, and a sphere of the first.
scene::Scene three_materials() {
  scene::Scene s;
  s.materials = {{"plain", scene::Lambertian{}},
                 {"ghost", scene::Metal{}},
                 {"lamp", scene::Emitter{}},
                 {"glass", scene::Dielectric{}}};
  std::get<scene::Metal>(s.materials[1].model).opacity = 0.25;
  std::get<scene::Emitter>(s.materials[2].model).opacity = 0.5;
  s.spheres = {{{0, 0, -3}, 1, 0}};
  return s;
}

TEST(CompileOpacity, OpaqueScenesHaveNoArray) {
  scene::Scene s = three_materials();  // the translucent materials are not used
  const CompiledScene compiled = compile(s);
  EXPECT_FALSE(compiled.features.opacity);
  EXPECT_EQ(compiled.view().opacity, nullptr);
}

TEST(CompileOpacity, FollowsTheIdsOfSpheresPointsAndHalvesOfRods) {
  scene::Scene s = three_materials();
  s.spheres.push_back({{1, 0, -3}, 1, 1});
  s.spheres.push_back({{2, 0, -3}, -1, 3});
  scene::Points points;
  points.material = 1;
  points.centers = scene::PointArray(3);
  for (std::size_t i = 0; i < 3; ++i) points.centers.set(i, {static_cast<double>(i), 5, 0});
  points.radii = scene::NumberArray(3, 0.1);
  points.opacities = {0.75F, -1, 0};
  points.opacity.where = {"x == 0: 0.75", "x == 2: 0"};
  s.points.push_back(points);
  points.opacities.clear();
  points.opacity = {};
  points.opacity.value = 0.125;
  s.points.push_back(points);
  s.rods = {{{0, 0, 0}, {1, 0, 0}, 0.1, {1, 2}}, {{1, 1, 0}, {0, 1, 0}, 0.1, {1, 2}}};
  const CompiledScene compiled = compile(s);
  EXPECT_TRUE(compiled.features.opacity);
  EXPECT_EQ(compiled.opacity,
            (std::vector<float>{1, 0.25F, 1, 0.75F, 0.25F, 0, 0.125F, 0.125F, 0.125F, 0.25F, 0.5F, 0.5F, 0.25F}))
      << "the second rod is stored from its other end";
}

TEST(CompileOpacity, LampsOfOpacityZeroAreNoLights) {
  scene::Scene s = three_materials();
  s.spheres.push_back({{1, 0, -3}, 1, 2});
  EXPECT_EQ(compile(s).light_tree.spheres.size(), 1u);
  std::get<scene::Emitter>(s.materials[2].model).opacity = 0;
  EXPECT_EQ(compile(s).light_tree.spheres.size(), 0u);
}

TEST(CompileOpacity, ReplacesThatOfALookWithOtherMaterials) {
  scene::Scene s = three_materials();
  s.spheres[0].material = 1;
  CompiledScene compiled = compile(s);
  scene::Scene after = s;
  after.materials[1].model = scene::Lambertian{{0.5, 0.5, 0.5}, {}, 0.75};
  const scene::Parts changed = scene::changed_parts(s, nullptr, after, nullptr);
  EXPECT_FALSE(changed.geometry);
  update(after, nullptr, changed, compiled);
  EXPECT_EQ(compiled.opacity, std::vector<float>{0.75F});
}

}  // namespace
}  // namespace orrery::compile
