// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"
#include "scene/animation.h"
#include "support/everything.h"
#include "support/plane_values.h"

namespace orrery::render {
namespace {

/// A scene with moving, growing and static spheres, one a ground outside the BVH, and a moving camera.
struct MovingScene {
  scene::Scene opening = test::everything(), closing;
  explicit MovingScene(bool camera = true) {
    closing = opening;
    closing.spheres[0].center.y = -1000.25;
    closing.spheres[1].center = {-1.5, 0.9, 0.3};
    closing.spheres[2].radius = 0.7;
    closing.spheres[4].center = {0.4, 0.6, 1.2};
    closing.spheres[5].center = {0.4, 0.6, 1.2};
    if (!camera) return;
    closing.camera.look_from = {3.2, 2, 3.9};
    closing.camera.vfov = 42;
  }
  compile::CompiledScene compiled() const { return compile::compile(opening, &closing); }
};

Settings with_data_layers() {
  Settings settings;
  settings.layers.z = settings.layers.position = settings.layers.normal = settings.layers.variance = true;
  return settings;
}

TEST(RenderMotion, EveryAcceleratorThreadCountAndTraversalGivesTheSameBits) {
  for (const auto precision : {scene::Precision::kExact, scene::Precision::kFast, scene::Precision::kBook}) {
    MovingScene moving;
    moving.opening.render.precision = precision;
    const std::vector<float> expected = test::plane_values(render(moving.compiled(), with_data_layers()).picture);
    for (const accel::Traversal traversal : {accel::Traversal::kPacket, accel::Traversal::kSingle}) {
      Settings settings = with_data_layers();
      settings.threads = 3;
      settings.traversal = traversal;
      EXPECT_EQ(test::plane_values(render(moving.compiled(), settings).picture), expected);
    }
    compile::CompiledScene list = moving.compiled();
    list.accelerator = compile::Accelerator::kList;
    EXPECT_EQ(test::plane_values(render(list, with_data_layers()).picture), expected);
  }
}

TEST(RenderMotion, FastLosesNoHitsFarFromTheOrigin) {
  scene::Scene opening;
  opening.image = {160, 90};
  opening.render.samples = 4;
  opening.render.precision = scene::Precision::kFast;
  opening.materials.push_back({"grey", scene::Lambertian{{0.5, 0.5, 0.5}}});
  std::minstd_rand random(7);
  std::uniform_real_distribution<double> across(-5, 5);
  for (int i = 0; i < 100; ++i)
    opening.spheres.push_back({{1e6 + across(random), across(random), across(random)}, 0.4, 0, ""});
  opening.camera.look_from = {1e6, 0, 20};
  opening.camera.look_at = {1e6, 0, 0};
  opening.camera.vfov = 40;
  opening.camera.shutter_close = 1;
  scene::Scene closing = opening;
  for (scene::Sphere& sphere : closing.spheres) sphere.center.x += 0.4;
  compile::CompiledScene compiled = compile::compile(opening, &closing);
  const std::vector<float> expected = test::plane_values(render(compiled, {}).picture);
  compiled.accelerator = compile::Accelerator::kList;
  EXPECT_EQ(test::plane_values(render(compiled, {}).picture), expected);
}

/// The spheres of data files and their bonds move as those of tables do.
TEST(RenderMotion, DataMoveLikeSpheresAndRodsOfTheScene) {
  scene::Scene data;
  data.image = {96, 54};
  data.render.samples = 8;
  data.materials.push_back({"grey", scene::Lambertian{{0.5, 0.5, 0.5}}});
  data.camera.look_from = {0, 0, 12};
  data.camera.look_at = {0, 0, 0};
  data.camera.vfov = 40;
  data.camera.shutter_open = 0.25;
  data.camera.shutter_close = 0.75;
  scene::Scene tables = data, closing;
  scene::Points& points = data.points.emplace_back();
  std::minstd_rand random(3);
  std::uniform_int_distribution<int> across(-24, 24);
  for (int i = 0; i < 40; ++i) {
    points.centers.push_back({across(random) / 8.0, across(random) / 8.0, across(random) / 8.0});
    points.to_next.push_back({across(random) / 16.0, across(random) / 16.0, 0});
    if (i % 4 == 0) points.bond_pairs.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(i + 1)});
  }
  points.radii.assign(40, 0.375);
  points.bond_radius = 0.125;
  points.bond_stubs = {{3, 2, {0.5, 0.5, 3}}};
  for (std::size_t i = 0; i < 40; ++i) tables.spheres.push_back({points.centers[i], 0.375, 0, ""});
  tables.rods.push_back({points.centers[3], points.bond_stubs[0].end, 0.125});
  for (const auto& [a, b] : points.bond_pairs) tables.rods.push_back({points.centers[a], points.centers[b], 0.125});
  closing = tables;
  for (std::size_t i = 0; i < 40; ++i) closing.spheres[i].center = tables.spheres[i].center + points.to_next[i] * 0.5;
  closing.rods[0].from = closing.spheres[3].center;
  closing.rods[0].to = tables.rods[0].to + (points.to_next[3] + points.to_next[2]) * 0.25;
  for (std::size_t i = 0; i < points.bond_pairs.size(); ++i) {
    closing.rods[i + 1].from = closing.spheres[points.bond_pairs[i].a].center;
    closing.rods[i + 1].to = closing.spheres[points.bond_pairs[i].b].center;
  }
  for (const auto precision : {scene::Precision::kExact, scene::Precision::kFast, scene::Precision::kBook}) {
    data.render.precision = tables.render.precision = precision;
    for (const auto accelerator : {scene::Accelerator::kEmbree, scene::Accelerator::kList}) {
      data.render.accelerator = tables.render.accelerator = accelerator;
      const compile::CompiledScene moving = compile::compile(data, &data);
      EXPECT_TRUE(moving.features.motion && !moving.bonds.empty());
      const std::vector<float> found = test::plane_values(render(moving, with_data_layers()).picture);
      EXPECT_EQ(found, test::plane_values(render(compile::compile(tables, &closing), with_data_layers()).picture));
      EXPECT_NE(found, test::plane_values(render(compile::compile(tables, &tables), with_data_layers()).picture));
    }
  }
}

TEST(RenderMotion, StaticSceneRendersAsWithoutMotion) {
  const scene::Scene scene = test::everything();
  const compile::CompiledScene compiled = compile::compile(scene, &scene);
  EXPECT_FALSE(compiled.features.motion);
  EXPECT_TRUE(compiled.motion.empty());
  EXPECT_EQ(test::plane_values(render(compiled, {}).picture),
            test::plane_values(render(compile::compile(scene), {}).picture));
}

TEST(RenderMotion, MotionArrayEndsAtTheLastMovingSphere) {
  scene::Scene opening = test::everything(), closing = opening;
  closing.spheres[2].center.x += 1;
  const compile::CompiledScene compiled = compile::compile(opening, &closing);
  ASSERT_EQ(compiled.motion.size(), 3u);
  EXPECT_EQ(compiled.motion[2].x, 1);
  EXPECT_EQ(compiled.motion[1].x, 0);
  EXPECT_EQ(compiled.motion[1].radius, 0);
}

/// Expects the motion-blurred image to be the mean of images at many times.
void expect_mean_of_moments(const MovingScene& moving) {
  scene::Scene scene = moving.opening;
  scene.render.samples = 4096;
  scene.render.seed = 9;
  const film::Picture blurred = render(compile::compile(scene, &moving.closing), {}).picture;

  constexpr int kMoments = 64;
  std::vector<double> mean(test::plane_values(blurred).size());
  for (int m = 0; m < kMoments; ++m) {
    const double t = (m + 0.5) / kMoments;
    scene::Scene at = moving.opening;
    const auto between = [t](double a, double b) { return a + (b - a) * t; };
    for (std::size_t i = 0; i < at.spheres.size(); ++i) {
      const scene::Sphere &a = moving.opening.spheres[i], &b = moving.closing.spheres[i];
      at.spheres[i].center = a.center + (b.center - a.center) * t;
      at.spheres[i].radius = between(a.radius, b.radius);
    }
    const math::Vec3d from = moving.opening.camera.look_from, to = moving.closing.camera.look_from;
    at.camera.look_from = from + (to - from) * t;
    at.camera.vfov = between(moving.opening.camera.vfov, moving.closing.camera.vfov);
    at.render.samples = 64;
    at.render.seed = static_cast<std::uint32_t>(m) + 100;
    const std::vector<float> picture = test::plane_values(render(compile::compile(at), {}).picture);
    for (std::size_t i = 0; i < picture.size(); ++i) mean[i] += static_cast<double>(picture[i]) / kMoments;
  }
  const std::vector<float> found = test::plane_values(blurred);
  double bias = 0, square = 0, worst = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double difference = static_cast<double>(found[i]) - mean[i];
    bias += difference / static_cast<double>(found.size());
    square += difference * difference / static_cast<double>(found.size());
    worst = std::max(worst, std::abs(difference));
  }
  EXPECT_LT(std::abs(bias), 3e-4);
  EXPECT_LT(std::sqrt(square), 0.006);
  EXPECT_LT(worst, 0.08);
}

TEST(RenderMotion, MovingSpheresAreAveragedOverTheShutter) { expect_mean_of_moments(MovingScene(false)); }

TEST(RenderMotion, MovingCameraIsAveragedOverTheShutter) {
  MovingScene moving;
  moving.closing.spheres = moving.opening.spheres;
  expect_mean_of_moments(moving);
}

TEST(RenderMotion, TimeIsUniformOverTheShutter) {
  // A white sphere with flat shading moves from left to right across a black sky.
  scene::Scene s;
  s.image = {64, 1};
  s.camera.vfov = 1;  // 64 pixels are 1.117 degrees
  s.camera.look_from = {0, 0, 0};
  s.render.samples = 4096;
  s.render.shading = scene::Shading::kFlat;
  s.background.type = scene::BackgroundType::kConstant;
  s.background.color = {0, 0, 0};
  s.materials = {{"white", scene::Lambertian{{1, 1, 1}}}};
  const double pixel = 2 * std::tan(0.5 / 180 * 3.14159265358979) * 100;  // width of a pixel at a distance of 100 units
  s.spheres = {{{-24 * pixel, 0, -100}, 4 * pixel, 0}};
  scene::Scene closing = s;
  closing.spheres[0].center.x = 24 * pixel;
  const film::Picture picture = render(compile::compile(s, &closing), {}).picture;
  // Every pixel that the whole sphere crosses sees it for the same fraction of the shutter: diameter / distance moved.
  const film::Plane& red = *picture.find("R");
  for (int x = 14; x < 50; ++x) EXPECT_NEAR(red.values[static_cast<std::size_t>(x)], 8.0 / 48, 0.012) << x;
  EXPECT_EQ(red.values[2], 0);
  EXPECT_EQ(red.values[61], 0);
}

}  // namespace
}  // namespace orrery::render
