// SPDX-License-Identifier: Apache-2.0
#include "scene/animation.h"

#include <gtest/gtest.h>

#include "support/everything.h"

namespace orrery::scene {
namespace {

Track track(Interpolation interpolation) {
  return {"camera.look_from", interpolation, {1, 3, 7}, {{0, 0, 0}, {2, 4, 0}, {2, 8, 4}}};
}

TEST(SceneAnimation, TracksPassThroughTheirKeysAndAreConstantOutside) {
  for (const auto how : {Interpolation::kLinear, Interpolation::kCubic, Interpolation::kHold}) {
    const Track t = track(how);
    for (std::size_t i = 0; i < t.frames.size(); ++i) EXPECT_EQ(value_at(t, t.frames[i]), t.values[i]);
    EXPECT_EQ(value_at(t, -100), t.values[0]);
    EXPECT_EQ(value_at(t, 100), t.values[2]);
  }
}

TEST(SceneAnimation, InterpolatesBetweenKeys) {
  EXPECT_EQ(value_at(track(Interpolation::kLinear), 2), (Vec3d{1, 2, 0}));
  EXPECT_EQ(value_at(track(Interpolation::kLinear), 6), (Vec3d{2, 7, 3}));
  EXPECT_EQ(value_at(track(Interpolation::kHold), 2.99), (Vec3d{0, 0, 0}));
  // A cubic track through linearly increasing values is linear. Its slope is continuous at the keys.
  const Track even{"", Interpolation::kCubic, {0, 1, 2, 3}, {{0, 0, 0}, {2, 1, 0}, {4, 1, 0}, {6, 5, 0}}};
  for (double f = 0; f <= 3; f += 0.25) EXPECT_NEAR(value_at(even, f).x, 2 * f, 1e-12);
  const double h = 1e-6;
  for (const double key : {1.0, 2.0}) {
    const double before = (value_at(even, key).y - value_at(even, key - h).y) / h;
    const double after = (value_at(even, key + h).y - value_at(even, key).y) / h;
    EXPECT_NEAR(before, after, 1e-4);
  }
}

TEST(SceneAnimation, FindsTargetsByName) {
  Scene scene = test::everything();
  scene.spheres[2].name = "a ball. of sorts";
  scene.materials[3].name = "dotted.name";
  scene.rods.resize(2);
  scene.rods[1].name = "bond";
  for (const char* name :
       {"camera.vfov", "camera.look_from", "camera.focus_distance", "background.top", "sphere[0].center",
        "sphere[7].radius", "sphere.a ball. of sorts.radius", "material.glass.ior", "material.dotted.name.fuzz",
        "rod[0].from", "rod[1].radius", "rod.bond.to"})
    EXPECT_TRUE(find_animated(scene, name)) << name;
  for (const char* name : {"",
                           ".",
                           "camera",
                           "camera.",
                           "camera.nothing",
                           "image.width",
                           "render.samples",
                           "sphere[8].radius",
                           "sphere[-1].radius",
                           "sphere[0]",
                           "sphere[0.center",
                           "sphere.no.radius",
                           "sphere[0].name",
                           "material.glass.albedo",
                           "material.glass.fresnel",
                           "material[0].albedo",
                           "points[0].radius",
                           "rod[2].from",
                           "rod.no.radius",
                           "rod[0].name",
                           "rod.bond.center"})
    EXPECT_FALSE(find_animated(scene, name)) << name;
  for (const std::string& name : animated_names(scene)) EXPECT_TRUE(find_animated(scene, name)) << name;
}

TEST(SceneAnimation, PosedScenesHaveTheValuesOfTheFrame) {
  Scene scene = test::everything();
  scene.tracks = {{"sphere[1].radius", Interpolation::kLinear, {0, 10}, {{0.5, 0, 0}, {1.5, 0, 0}}},
                  {"material.brushed.fuzz", Interpolation::kLinear, {0, 10}, {{0, 0, 0}, {1, 0, 0}}},
                  {"background.top", Interpolation::kHold, {0, 5}, {{1, 1, 1}, {0, 0, 1}}}};
  const Scene at = posed(scene, 5);
  EXPECT_EQ(at.spheres[1].radius, 1);
  EXPECT_EQ(std::get<Metal>(at.materials[3].model).fuzz, 0.5);
  EXPECT_EQ(at.background.top, (Vec3d{0, 0, 1}));
  EXPECT_EQ(scene.spheres[1].radius, 0.5);
}

TEST(SceneAnimation, TheTurntableRotatesAboutUpAtConstantDistance) {
  Scene scene;
  scene.camera.look_from = {0, 3, 4};
  scene.camera.look_at = {0, 1, 0};
  scene.animation.turntable = 8;
  EXPECT_EQ(posed(scene, 1).camera.look_from, scene.camera.look_from);
  const Vec3d quarter = posed(scene, 3).camera.look_from;
  EXPECT_NEAR(quarter.x, 4, 1e-12);
  EXPECT_NEAR(quarter.y, 3, 1e-12);
  EXPECT_NEAR(quarter.z, 0, 1e-12);
  EXPECT_EQ(posed(scene, 9).camera.look_from, scene.camera.look_from);
  scene.animation.turntable = -8;
  EXPECT_NEAR(posed(scene, 3).camera.look_from.x, -4, 1e-12);
}

}  // namespace
}  // namespace orrery::scene
