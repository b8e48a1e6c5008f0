// SPDX-License-Identifier: Apache-2.0
#include "render/emitter_coverage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "render/render.h"
#include "support/front_view.h"
#include "support/lit_scenes.h"

namespace orrery::render {
namespace {

constexpr double kLampRadiance = 1000;

/// A lamp of a tenth of a pixel, 10 units in front of the camera, in the left upper part of the image.
scene::Scene distant_lamp() {
  scene::Scene s = test::front_view(48, 32);
  s.render.samples = 2048;
  test::add_lamp(s, {-2.13, 1.41, 0}, 0.04, {kLampRadiance, kLampRadiance, kLampRadiance});
  return s;
}

std::vector<EmitterCoverage> coverage_of(const compile::CompiledScene& compiled) {
  const std::unique_ptr<accel::Accel> accel = build(compiled, 1, {});
  return emitter_coverage(compiled.view(), {accel->tracer(), compiled.precision}, compiled.width, compiled.height);
}

/// Compares with the rendered image, in which nothing but the lamp is bright.
void expect_where_rendered(const scene::Scene& opening, const std::string& name, const scene::Scene* closing = nullptr,
                           int most_pixels = 36, double radiance = kLampRadiance) {
  const compile::CompiledScene compiled = compile::compile(opening, closing);
  const std::vector<EmitterCoverage> found = coverage_of(compiled);
  const std::vector<float> rendered = render(compiled, {}).picture.planes[0].values;
  ASSERT_EQ(found.size(), rendered.size()) << name;
  double light = 0, expected = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    light += static_cast<double>(found[i].light);
    expected += static_cast<double>(rendered[i]);
    EXPECT_FALSE(rendered[i] > 0 && found[i].light == 0) << name << ", pixel " << i;
    EXPECT_NEAR(found[i].light, radiance * static_cast<double>(found[i].coverage), 2e-5 * radiance) << name;
  }
  EXPECT_GT(expected, 0) << name;
  EXPECT_NEAR(light, expected, 0.1 * expected) << name;
  EXPECT_LE(std::count_if(found.begin(), found.end(), [](const EmitterCoverage& e) { return e.coverage > 1e-9f; }),
            most_pixels)
      << name;
}

TEST(RenderEmitterCoverage, AreFoundWhereTheyAreRendered) {
  expect_where_rendered(distant_lamp(), "perspective");
  scene::Scene s = distant_lamp();
  s.image.crop = scene::Window{4, 3, 20, 20};
  expect_where_rendered(s, "crop");
  s = distant_lamp();
  test::make_orthographic(s);
  expect_where_rendered(s, "orthographic");
  s = distant_lamp();
  s.render.filter = scene::Filter::kGaussian;
  s.spheres[0].center = {-2.05, 1.5, 0};  // near the middle of a pixel
  expect_where_rendered(s, "filter");
  s = distant_lamp();
  s.camera.defocus_angle = 1;
  s.camera.focus_distance = 11;
  expect_where_rendered(s, "lens");
  s.camera.defocus_angle = 8;
  s.camera.focus_distance = 20;
  s.render.samples = 1 << 16;
  expect_where_rendered(s, "wide lens", nullptr, 400);
  s = distant_lamp();
  std::get<scene::Emitter>(s.materials[0].model).opacity = 0.4;
  expect_where_rendered(s, "translucent");
  s = distant_lamp();
  scene::Scene closing = s;
  closing.spheres[0].center.x += 0.2;
  expect_where_rendered(s, "moving lamp", &closing);
  closing = s;
  closing.camera.look_at.y += 0.1;
  expect_where_rendered(s, "moving camera", &closing);
}

TEST(RenderEmitterCoverage, OfCoincidentSpheresOneIsExpected) {
  scene::Scene s = distant_lamp();
  s.spheres.push_back(s.spheres[0]);
  expect_where_rendered(s, "coincident");
  scene::Scene closing = s;
  for (scene::Sphere& lamp : closing.spheres) lamp.center.x += 0.02;
  expect_where_rendered(s, "moving", &closing);
}

TEST(RenderEmitterCoverage, RodsAreFoundWhereTheyAreRendered) {
  const auto with_rod = [](math::Vec3d from, math::Vec3d to, double radius) {
    scene::Scene s = distant_lamp();
    s.spheres.clear();
    s.rods.push_back({from, to, radius, {0, 0}});
    return s;
  };
  expect_where_rendered(with_rod({-3, 1, 0}, {2, -1.5, 0}, 0.01), "filament", nullptr, 300);
  expect_where_rendered(with_rod({0.2, 0.1, 0}, {0.2, 0.1, 0}, 0.03), "no length");
  expect_where_rendered(with_rod({1.21, 1.13, 8}, {2.3, 2.2, -9}, 0.004), "towards the camera", nullptr, 300);
  scene::Scene s = with_rod({0, -2, 0}, {1, 2, 0}, 0.01);
  s.materials.push_back({"soot", scene::Lambertian{{0, 0, 0}}});
  s.rods[0].materials = {0, 1};
  expect_where_rendered(s, "half", nullptr, 100);
  scene::Scene closing = s;
  closing.rods[0].to.x += 0.3;
  expect_where_rendered(s, "moving", &closing, 200);
  const std::size_t pixels = coverage_of(compile::compile(with_rod({0, 0, 20}, {0.5, 0, -5}, 0.004))).size();
  EXPECT_GT(pixels, 0u) << "one end is behind the camera";
}

/// A ball that reflects a lamp in front of the camera, and more to its side.
scene::Scene reflecting_ball(const scene::MaterialModel& model, math::Vec3d lamp = {6, 4, 14}, double radius = 0.9) {
  scene::Scene s = distant_lamp();
  s.render.samples = 1 << 14;
  s.render.max_depth = 2;
  s.spheres[0].center = lamp;
  s.spheres[0].radius = 0.4;
  test::add_ball(s, {-0.6, 0.3, 0}, radius, model);
  return s;
}

TEST(RenderEmitterCoverage, ReflectionsAreFoundWhereTheyAreRendered) {
  const auto mirror = [](double albedo) { return scene::Metal{{albedo, albedo, albedo}, 0}; };
  const double half = 0.5 * kLampRadiance;
  expect_where_rendered(reflecting_ball(mirror(0.5)), "ball", nullptr, 36, half);
  expect_where_rendered(reflecting_ball(mirror(0.5), {6, 4, 14}, 0.5), "small ball", nullptr, 36, half);
  expect_where_rendered(reflecting_ball(mirror(0.5), {-0.6, 0.3, 60}), "behind the camera", nullptr, 36, half);
  expect_where_rendered(reflecting_ball(mirror(0.5), {2.4, 4, 3}), "close lamp", nullptr, 36, half);
  expect_where_rendered(reflecting_ball(mirror(0.5), {-9, 2, -2}), "beside the ball", nullptr, 36, half);
  scene::Scene s = reflecting_ball(mirror(0.5));
  test::make_orthographic(s);
  expect_where_rendered(s, "orthographic", nullptr, 36, half);
  s = reflecting_ball(mirror(0.5));
  scene::Scene closing = s;
  closing.spheres[1].center.x += 0.5;
  expect_where_rendered(s, "moving", &closing, 36, half);
  s = reflecting_ball(mirror(0.5));
  s.camera.defocus_angle = 4;
  s.camera.focus_distance = 5;
  expect_where_rendered(s, "lens", nullptr, 200, half);
  s = reflecting_ball(mirror(0.5));
  s.spheres[1].center = {-20, 0.3, 0};
  EXPECT_TRUE(coverage_of(compile::compile(s)).empty()) << "the ball is beside the image";
  s.spheres[1] = {{0, 0, 10}, 1, 1, ""};
  EXPECT_TRUE(coverage_of(compile::compile(s)).empty()) << "the camera is in the ball";
  s = reflecting_ball(scene::Metal{{0.5, 0.5, 0.5}, 0.1});
  EXPECT_TRUE(coverage_of(compile::compile(s)).empty()) << "a fuzzy ball";
}

TEST(RenderEmitterCoverage, GlassAndCoatsReflectLessThanMirrors) {
  const auto light = [](const scene::MaterialModel& model) {
    double sum = 0;
    for (const EmitterCoverage& e : coverage_of(compile::compile(reflecting_ball(model))))
      sum += static_cast<double>(e.light);
    return sum;
  };
  const double mirror = light(scene::Metal{{1, 1, 1}, 0});
  EXPECT_NEAR(light(scene::Dielectric{1.5}), 0.04 * mirror, 0.01 * mirror);
  EXPECT_NEAR(light(scene::Plastic{{0.5, 0.5, 0.5}, 1.5, 0}), 0.04 * mirror, 0.01 * mirror);
  EXPECT_EQ(light(scene::Lambertian{{1, 1, 1}}), 0);
}

TEST(RenderEmitterCoverage, LargeEmittersAndThoseOutsideTheImageDoNotCount) {
  scene::Scene s = distant_lamp();
  s.spheres[0].radius = 1.5;
  EXPECT_TRUE(coverage_of(compile::compile(s)).empty());
  s = distant_lamp();
  s.spheres[0].center.z = 20;
  EXPECT_TRUE(coverage_of(compile::compile(s)).empty()) << "behind the camera";
  s = distant_lamp();
  s.spheres[0].center.x = -9;
  EXPECT_TRUE(coverage_of(compile::compile(s)).empty()) << "beside the image";
  s = distant_lamp();
  s.materials[0].model = scene::Lambertian{{0.5, 0.5, 0.5}};
  EXPECT_TRUE(coverage_of(compile::compile(s)).empty()) << "no emitter";
}

TEST(RenderEmitterCoverage, DimEmittersDoNotHideBrightOnes) {
  scene::Scene s = distant_lamp();
  const std::vector<EmitterCoverage> alone = coverage_of(compile::compile(s));
  for (int i = 1; i <= 6; ++i) test::add_lamp(s, {-2.13, 1.41, -0.2 * i}, 0.1, {2, 2, 2});
  const std::vector<EmitterCoverage> all = coverage_of(compile::compile(s));
  int lit = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (alone[i].coverage < 1e-9f) continue;
    ++lit;
    EXPECT_GT(all[i].light, alone[i].light);
    EXPECT_LT(alone[i].coverage, 0.2f);
    EXPECT_LT(all[i].coverage, 1.2f * alone[i].coverage) << "hits of the dim ones do not count";
  }
  EXPECT_GT(lit, 0);
}

TEST(RenderEmitterCoverage, HiddenEmittersDoNotCount) {
  const auto with_screen = [](scene::Scene s, math::Vec3d center, double radius) {
    test::add_ball(s, center, radius, scene::Lambertian{{0, 0, 0}});
    return s;
  };
  EXPECT_TRUE(coverage_of(compile::compile(with_screen(distant_lamp(), {-1.065, 0.705, 5}, 0.1))).empty());
  EXPECT_FALSE(coverage_of(compile::compile(with_screen(distant_lamp(), {-1.065 - 0.1, 0.705, 5}, 0.1))).empty())
      << "half";
  scene::Scene s = distant_lamp();
  s.camera.defocus_angle = 4;
  s.camera.focus_distance = 10;
  EXPECT_FALSE(coverage_of(compile::compile(with_screen(s, {-1.065, 0.705, 5}, 0.1))).empty())
      << "seen by the lens's rim";
  s = reflecting_ball(scene::Metal{{0.5, 0.5, 0.5}, 0});
  EXPECT_TRUE(coverage_of(compile::compile(with_screen(s, {5.06, 3.47, 12}, 1))).empty()) << "hidden from the ball";
  EXPECT_TRUE(coverage_of(compile::compile(with_screen(s, {-0.4, 0.2, 5}, 0.8))).empty()) << "the ball is hidden";
  s = distant_lamp();
  s.spheres.clear();
  s.rods.push_back({{-3, 1, 0}, {2, -1.5, 0}, 0.01, {0, 0}});
  const auto light = [](const scene::Scene& of) {
    double sum = 0;
    for (const EmitterCoverage& e : coverage_of(compile::compile(of))) sum += static_cast<double>(e.light);
    return sum;
  };
  EXPECT_NEAR(light(with_screen(s, {-1.5, 0.5, 1}, 1.5)) / light(s), 0.5, 0.2) << "half of a rod";
}

TEST(RenderEmitterCoverage, RectanglesAreClippedToTheImage) {
  // A lamp so far out of focus that its image is larger than the frame.
  scene::Scene s = distant_lamp();
  s.camera.defocus_angle = 120;
  s.camera.focus_distance = 1;
  const std::vector<EmitterCoverage> found = coverage_of(compile::compile(s));
  ASSERT_FALSE(found.empty());
  for (const EmitterCoverage& e : found) EXPECT_NEAR(e.coverage, found[0].coverage, 1e-6f * found[0].coverage);
}

TEST(RenderEmitterCoverage, BrightTexelsAreEmitters) {
  scene::Scene s = distant_lamp();
  s.spheres.clear();
  s.render.samples = 1 << 14;
  s.background.type = scene::BackgroundType::kImage;
  s.background.rotation = 7;
  const auto map = std::make_shared<scene::LatLongMap>(1024, 512);
  for (int y = 0; y < map->height(); ++y) std::fill_n(map->row(y), 3 * map->width(), 0.0f);
  std::fill_n(map->row(250) + 3 * 32, 3, static_cast<float>(kLampRadiance));
  s.background.image = map;
  expect_where_rendered(s, "texel");
  for (int y = 0; y < map->height(); ++y) std::fill_n(map->row(y), 3 * map->width(), 1.0f);
  EXPECT_TRUE(coverage_of(compile::compile(s)).empty()) << "no texel is brighter than the others";
}

TEST(RenderEmitterCoverage, TheSunOfASkyIsASmallEmitter) {
  scene::Scene s = distant_lamp();
  s.spheres.clear();
  s.background.type = scene::BackgroundType::kImage;
  const auto map = std::make_shared<scene::LatLongMap>(32, 16);
  for (int y = 0; y < map->height(); ++y) std::fill_n(map->row(y), 3 * map->width(), 0.0f);
  map->sun.direction = math::normalized(math::Vec3d{0.13, 0.11, -1});
  map->sun.one_minus_cos = 1.08e-5;
  map->sun.radiance = {kLampRadiance, kLampRadiance, kLampRadiance};
  s.background.image = map;
  expect_where_rendered(s, "sun");
  s.background.visible = false;
  EXPECT_TRUE(coverage_of(compile::compile(s)).empty());
}

/// A lamp of a hundredth of a pixel before a bright sky: nothing but the lamp has noise, and 16 samples rarely hit it.
TEST(RenderEmitterCoverage, ADistantLampIsNotMissed) {
  scene::Scene s = distant_lamp();
  s.background.color = {1, 1, 1};
  s.spheres[0].radius = 0.012;
  s.render.direct_lighting = scene::DirectLighting::kBsdf;  // otherwise the lamp is sampled
  const std::vector<EmitterCoverage> found = coverage_of(compile::compile(s));
  ASSERT_FALSE(found.empty());
  const double lamp =
      static_cast<double>(std::max_element(found.begin(), found.end(), [](const auto& a, const auto& b) {
                            return a.light < b.light;
                          })->light);
  ASSERT_GT(lamp, 3);
  Settings settings;
  settings.noise = 0.02;
  settings.unlimited = true;
  double sum = 0;
  constexpr int kSeeds = 16;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    s.render.seed = static_cast<std::uint32_t>(seed);
    const Result r = render(compile::compile(s), settings);
    EXPECT_EQ(r.statistics.ended_by, "noise");
    EXPECT_EQ(r.statistics.min_samples, 16u);
    const double brightest = *std::max_element(r.picture.planes[0].values.begin(), r.picture.planes[0].values.end());
    EXPECT_NEAR(brightest - 1, lamp, 0.5 * lamp) << seed;
    sum += (brightest - 1) / kSeeds;
  }
  EXPECT_NEAR(sum, lamp, 0.15 * lamp);
}

}  // namespace
}  // namespace orrery::render
