// SPDX-License-Identifier: Apache-2.0
#include "compile/compile.h"

#include <gtest/gtest.h>

#include <cmath>

#include "compile/compiled_scene.h"
#include "compile/environment.h"
#include "scene/scene.h"
#include "sky/daylight.h"

namespace orrery::compile {
namespace {

scene::Scene one_of_each() {
  scene::Scene s;
  s.materials = {{"unused", scene::Metal{}},
                 {"grey", scene::Lambertian{}},
                 {"glass", scene::Dielectric{1.5, scene::Fresnel::kExact}}};
  s.spheres = {{{0, 0, -1}, 0.5, 1, ""}, {{1, 0, -1}, 0.5, 2, ""}, {{1, 0, -1}, -0.4, 2, ""}, {{2, 0, 0}, -1, 1, ""}};
  return s;
}

TEST(CompileCompile, LeavesOutUnusedMaterials) {
  const CompiledScene compiled = compile(one_of_each());
  EXPECT_FALSE(compiled.features.hemisphere);
  EXPECT_EQ(compiled.materials.size(), 3u);  // grey, glass, glass turned inside out
}

TEST(CompileCompile, ADepthCueBeginsInATenthOfTheDepthOfTheData) {
  scene::Scene s;
  s.materials = {{"grey", scene::Lambertian{}}};
  s.camera.look_from = {0, 0, 20};
  s.camera.look_at = {0, 0, 0};
  s.camera.depth_cue = 0.5;
  s.spheres = {{{0, -1000, 0}, 1000, 0}};  // is not data
  scene::Points& points = s.points.emplace_back();
  for (const double z : {4.0, -4.0}) points.centers.push_back({z, 1, z});
  points.radii.assign(2, 1);
  const auto share = [](const CompiledScene& compiled, double z) { return compiled.depth_cue.share(z); };
  const CompiledScene compiled = compile(s);
  EXPECT_TRUE(compiled.features.depth_cue);
  EXPECT_EQ(share(compiled, 16), 0);  // from 15 to 25
  EXPECT_NEAR(share(compiled, 20.5), 0.25, 1e-12);
  EXPECT_EQ(share(compiled, 25), 0.5);
  EXPECT_EQ(share(compiled, 100), 0.5);
  s.camera.depth_cue_range = scene::Interval{10, 20};
  EXPECT_NEAR(share(compile(s), 15), 0.25, 1e-12);
  s.camera.depth_cue = 0;
  EXPECT_FALSE(compile(s).features.depth_cue);
}

TEST(CompileCompile, ADepthCueWithoutDepthOrInFrontOfNothingIsNone) {
  scene::Scene s;
  s.materials = {{"grey", scene::Lambertian{}}};
  s.camera.depth_cue = 0.5;
  s.points.emplace_back();
  EXPECT_FALSE(compile(s).features.depth_cue) << "no data";
  s.points[0].centers.push_back({0, 0, 100});
  s.points[0].radii.push_back(1);
  EXPECT_FALSE(compile(s).features.depth_cue) << "behind the camera";
}

TEST(CompileCompile, ArrowsHaveTheOpacityOfTheMaterial) {
  scene::Scene s;
  s.materials = {{"grey", scene::Lambertian{}}};
  scene::Points& points = s.points.emplace_back();
  for (const double x : {0.0, 10.0, 2.0}) points.centers.push_back({x, 0, 0});  // a bond, and an arrow from the first
  points.radii.assign(3, 1);
  points.bond_pairs = {{0, 1}, {0, 2}};
  points.bond_radius = 0.1;
  points.arrow_count = points.arrow_spheres = 1;
  points.opacity.value = 0.25;
  EXPECT_EQ(compile(s).opacity, (std::vector<float>{0.25F, 0.25F, 1, 0.25F, 0.25F, 1, 1}));
  points.opacity.value.reset();
  points.opacity.where = {"x == 0: 0.5"};
  points.opacities = {0.5F, -1, -1};
  EXPECT_EQ(compile(s).opacity, (std::vector<float>{0.5F, 1, 1, 0.5F, 1, 1, 1}));
}

TEST(CompileCompile, ANegativeRadiusTurnsGlassInsideOut) {
  const CompiledScene compiled = compile(one_of_each());
  for (std::size_t i = 0; i < compiled.spheres.size(); ++i) EXPECT_GT(compiled.spheres[i].radius, 0);
  const kernel::Material& outward = compiled.materials[compiled.object_materials[1]];
  const kernel::Material& inward = compiled.materials[compiled.object_materials[2]];
  EXPECT_EQ(outward.eta[0], 1 / 1.5);
  EXPECT_EQ(outward.eta[1], 1.5);
  EXPECT_NEAR(outward.r0[0], 0.04, 1e-15);
  EXPECT_NEAR(outward.r0[1], 0.04, 1e-15);
  EXPECT_EQ(inward.eta[0], outward.eta[1]);
  EXPECT_EQ(inward.eta[1], outward.eta[0]);
  EXPECT_EQ(inward.fresnel, kernel::FresnelKind::kExact);
  EXPECT_EQ(compiled.object_materials[0], compiled.object_materials[3]) << "a diffuse sphere has no inside";
}

TEST(CompileCompile, PointsFollowSpheresInTheOrderOfTheirIds) {
  scene::Scene s = one_of_each();
  scene::Points points;
  points.material = 0;
  points.centers = {{9, 0, 0}, {8, 0, 0}};
  points.radii = {1, 2};
  points.materials = {1, 0};
  s.points.push_back(points);
  const CompiledScene compiled = compile(s);
  ASSERT_EQ(compiled.spheres.size(), 6u);
  EXPECT_EQ(compiled.spheres[4].x, 9);
  EXPECT_EQ(compiled.object_materials[4], compiled.object_materials[0]);
  EXPECT_EQ(compiled.materials[compiled.object_materials[5]].kind, kernel::MaterialKind::kMetal);
}

TEST(CompileCompile, AConstantBackgroundIgnoresTheDirection) {
  scene::Scene s = one_of_each();
  s.background.type = scene::BackgroundType::kConstant;
  s.background.color = {0.25, 0.5, 0.75};
  const CompiledScene compiled = compile(s);
  EXPECT_FALSE(compiled.features.gradient);
  EXPECT_EQ(compiled.background.bottom.z, 0.75);
}

TEST(CompileCompile, HemisphereFeatureIsSetOnlyIfUsed) {
  scene::Scene s = one_of_each();
  s.materials[0].model = scene::Hemisphere{{1, 1, 1}};
  EXPECT_FALSE(compile(s).features.hemisphere);
  s.spheres[0].material = 0;
  EXPECT_TRUE(compile(s).features.hemisphere);
}

TEST(CompileCompile, PlasticReflectsTheSameOnBothSides) {
  scene::Scene s = one_of_each();
  EXPECT_FALSE(compile(s).features.rich_materials);
  s.materials[1].model = scene::Plastic{{0.1, 0.2, 0.3}, 1.5, 0.4};
  const CompiledScene out = compile(s);
  EXPECT_TRUE(out.features.rich_materials);
  const kernel::Material& m = out.materials[0];
  EXPECT_EQ(m.kind, kernel::MaterialKind::kPlastic);
  EXPECT_EQ(m.albedo[2], 0.3);
  EXPECT_EQ(m.fuzz, 0.4);
  EXPECT_NEAR(m.r0[0], 0.04, 1e-15);
  EXPECT_EQ(m.r0[1], m.r0[0]);
  EXPECT_EQ(out.object_materials[3], out.object_materials[0]) << "a negative radius";
}

TEST(CompileCompile, SkiesAreBakedWithTheirSun) {
  scene::Scene s;
  s.background.type = scene::BackgroundType::kSky;
  s.background.exposure = 1;
  s.background.rotation = 90;
  const CompiledScene compiled = compile(s);
  ASSERT_NE(compiled.environment, nullptr);
  const kernel::Environment& view = compiled.environment->view();
  EXPECT_TRUE(view.has_sun);
  EXPECT_TRUE(compiled.features.lit);
  EXPECT_EQ(view.scale, 2);
  EXPECT_NEAR(view.sun.x, std::sqrt(0.5), 1e-12);  // from +z, turned to +x
  EXPECT_NEAR(view.sun.y, std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(view.sun_radiance.y, 2 * sky::bake_sky(s.background, {16}).sun.radiance.y, 1e-6 * view.sun_radiance.y);
  s.background.sun = false;
  EXPECT_FALSE(compile(s).environment->view().has_sun);
}

}  // namespace
}  // namespace orrery::compile
