// SPDX-License-Identifier: Apache-2.0
#include "render/render.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <optional>
#include <random>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "render/result.h"
#include "render/settings.h"
#include "support/everything.h"
#include "support/lit_scenes.h"
#include "support/plane_values.h"

namespace orrery::render {
namespace {

using math::Vec3d;
using test::everything;
using test::translucent;
using test::with_lamps;
using test::with_plastic;

std::vector<float> pixels(const scene::Scene& scene, int threads = 0,
                          std::optional<accel::Traversal> traversal = std::nullopt) {
  const compile::CompiledScene compiled = compile::compile(scene);
  Settings settings;
  settings.threads = threads;
  settings.traversal = traversal;
  const Result result = render(compiled, settings);
  EXPECT_TRUE(result.completed);
  EXPECT_EQ(result.statistics.bad_samples, 0u);
  return test::plane_values(result.picture);
}

TEST(RenderRender, ListAndEmbreeGiveTheSameBits) {
  for (const auto precision : {scene::Precision::kExact, scene::Precision::kFast}) {
    for (scene::Scene s : {everything(), with_lamps(everything()), with_lamps(with_plastic(everything())),
                           translucent(with_lamps(everything()))}) {
      s.render.precision = precision;
      s.render.accelerator = scene::Accelerator::kEmbree;
      const auto embree = pixels(s);
      s.render.accelerator = scene::Accelerator::kList;
      EXPECT_EQ(pixels(s), embree) << static_cast<int>(precision);
    }
  }
}

TEST(RenderRender, TraversalsGiveTheSameBits) {
  for (const auto precision : {scene::Precision::kExact, scene::Precision::kFast})
    for (scene::Scene s : {everything(), with_lamps(everything()), with_lamps(with_plastic(everything())),
                           translucent(with_lamps(everything()))}) {
      s.render.precision = precision;
      EXPECT_EQ(pixels(s, 0, accel::Traversal::kPacket), pixels(s, 0, accel::Traversal::kSingle))
          << static_cast<int>(precision);
    }
}

TEST(RenderRender, ARequestedTraversalIsUsed) {
  const compile::CompiledScene compiled = compile::compile(everything());
  Settings settings;
  settings.traversal = accel::Traversal::kSingle;
  EXPECT_EQ(render(compiled, settings).statistics.traversal, "single");
  settings.traversal = accel::Traversal::kPacket;
  EXPECT_EQ(render(compiled, settings).statistics.traversal, "packet");
  settings.traversal = {};
  EXPECT_EQ(render(compiled, settings).statistics.traversal, "packet");
}

/// Far from the world's origin, `fast` rounds spheres by more than boxes are padded: boxes must enclose rounded
/// spheres.
TEST(RenderRender, ListAndEmbreeGiveTheSameBitsFarFromTheOriginInFast) {
  for (const int count : {300, 10'500}) {
    std::mt19937 random(7);
    const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0 - 0.5; };
    scene::Scene s;
    s.image.width = 32;
    s.image.height = 18;
    s.render.samples = 2;
    s.render.precision = scene::Precision::kFast;
    const Vec3d offset{9e3, -6e3, 3e3};
    s.camera.look_from = offset + Vec3d{0, 0, 3};
    s.camera.look_at = offset;
    s.camera.vfov = 25;
    s.materials.push_back({"m", scene::Lambertian{{0.5, 0.5, 0.5}}});
    for (int i = 0; i < count; ++i)
      s.spheres.push_back({offset + Vec3d{uniform(), uniform(), uniform()}, 0.3 / std::cbrt(count), 0, ""});
    s.render.accelerator = scene::Accelerator::kEmbree;
    const auto embree = pixels(s);
    s.render.accelerator = scene::Accelerator::kList;
    EXPECT_EQ(pixels(s), embree) << count;
  }
}

TEST(RenderRender, AnyNumberOfThreadsGivesTheSameBits) {
  for (const scene::Scene& s : {everything(), with_lamps(everything()), with_lamps(with_plastic(everything())),
                                translucent(with_lamps(everything()))}) {
    const auto one = pixels(s, 1);
    EXPECT_EQ(pixels(s, 2), one);
    EXPECT_EQ(pixels(s, 5), one);
  }
}

TEST(RenderRender, SumsThatAreNotKeptAreFreedAfterTheirLastUse) {
  scene::Scene s = everything();
  s.image = {640, 420};  // several steps, after which pages are returned to the system
  s.render.samples = 2;
  const compile::CompiledScene compiled = compile::compile(s);
  Settings settings;
  settings.layers.halves = true;
  const Result kept = render(compiled, settings);
  settings.keeps_sums = false;
  const Result freed = render(compiled, settings);
  EXPECT_TRUE(kept.sums && !freed.sums);
  EXPECT_EQ(test::plane_values(freed.picture), test::plane_values(kept.picture));
}

TEST(RenderRender, AnotherSeedGivesAnotherImage) {
  scene::Scene s = everything();
  const auto first = pixels(s);
  s.render.seed = 2;
  EXPECT_NE(pixels(s), first);
}

/// Scales all lengths of a scene. A power of two leaves the bits of every ratio unchanged.
scene::Scene scaled(scene::Scene s, double factor) {
  s.camera.look_from = s.camera.look_from * factor;
  s.camera.look_at = s.camera.look_at * factor;
  for (scene::Sphere& sphere : s.spheres) {
    sphere.center = sphere.center * factor;
    sphere.radius *= factor;
  }
  return s;
}

TEST(RenderRender, SceneScaleChangesNoBits) {
  for (const scene::Scene& s : {everything(), with_lamps(everything()), with_lamps(with_plastic(everything())),
                                translucent(with_lamps(everything()))}) {
    const auto unit = pixels(s);
    for (const int k : {-60, -17, 1, 30, 48}) EXPECT_EQ(pixels(scaled(s, std::ldexp(1.0, k))), unit) << "2^" << k;
  }
}

TEST(RenderRender, BookPrecisionDependsOnTheSceneScale) {
  scene::Scene s = everything();
  s.render.precision = scene::Precision::kBook;
  EXPECT_NE(pixels(scaled(s, 0x1p-8)), pixels(s));
}

TEST(RenderRender, EmptySceneShowsTheSky) {
  scene::Scene s;
  s.image = {8, 8};
  s.camera.vfov = 1;
  s.camera.look_at = {0, 1, 0};
  s.camera.up = {0, 0, 1};
  s.render.samples = 4;
  const auto p = pixels(s);
  EXPECT_NEAR(p[0], 0.5, 1e-4);       // red at the top of the gradient
  EXPECT_NEAR(p[2 * 64], 1.0, 1e-4);  // blue
}

/// A convex diffuse sphere of albedo 0.5 in a white sky: every path that hits it escapes after one bounce.
TEST(RenderRender, GreySphereInAWhiteSkyIsExactlyHalf) {
  for (const double radius : {1e-12, 1e-3, 1.0, 1e6, 1e12}) {
    scene::Scene s;
    s.image = {40, 40};
    s.camera.look_from = {0, 0, 3 * radius};
    s.camera.look_at = {0, 0, 0};
    s.camera.vfov = 20;  // the sphere fills the image
    s.background.bottom = s.background.top = {1, 1, 1};
    s.render.samples = 60;
    s.materials = {{"grey", scene::Lambertian{{0.5, 0.5, 0.5}}}};
    s.spheres = {{{0, 0, 0}, radius, 0, ""}};
    const auto p = pixels(s);
    for (int i = 0; i < 3 * 1600; ++i) ASSERT_EQ(p[static_cast<std::size_t>(i)], 0.5f) << radius;
  }
}

/// No material absorbs, so every path that escapes has the sky's radiance of 1.
TEST(RenderRender, WhiteFurnaceIsExactlyOne) {
  scene::Scene s = everything();
  s.background.bottom = s.background.top = {1, 1, 1};
  s.render.max_depth = 1000;
  s.materials = {{"w", scene::Lambertian{{1, 1, 1}}},
                 {"w", scene::Hemisphere{{1, 1, 1}}},
                 {"w", scene::Metal{{1, 1, 1}, 0}},
                 {"w", scene::Metal{{1, 1, 1}, 0}},
                 {"w", scene::Dielectric{1.5, scene::Fresnel::kSchlick}},
                 {"w", scene::Dielectric{2.4, scene::Fresnel::kExact}}};
  for (const float value : pixels(s)) ASSERT_EQ(value, 1.0f);
}

TEST(RenderRender, PlasticLosesNoLightInAWhiteFurnace) {
  scene::Scene s = everything();
  s.background.bottom = s.background.top = {1, 1, 1};
  s.render.max_depth = 1000;
  s.materials = {{"w", scene::Lambertian{{1, 1, 1}}},         {"w", scene::Plastic{{1, 1, 1}, 1.5, 0}},
                 {"w", scene::Plastic{{1, 1, 1}, 1.5, 0.3}},  {"w", scene::Plastic{{1, 1, 1}, 2.5, 1}},
                 {"w", scene::Plastic{{1, 1, 1}, 1.5, 0.05}}, {"w", scene::Plastic{{1, 1, 1}, 1, 0.7}}};
  for (const auto precision : {scene::Precision::kExact, scene::Precision::kFast, scene::Precision::kBook}) {
    s.render.precision = precision;
    for (const float value : pixels(s)) ASSERT_EQ(value, 1.0f) << static_cast<int>(precision);
  }
}

/// A sphere in white light, from far away: the mean over the image of what its coat reflects has a closed form.
TEST(RenderRender, ABlackPlasticSphereReflectsTheMeanOfSchlick) {
  scene::Scene s;
  s.image = {64, 64};
  s.camera.look_from = {0, 0, 10};
  s.camera.look_at = {0, 0, 0};
  s.camera.projection = scene::Projection::kOrthographic;
  s.camera.width = 2;
  s.background.bottom = s.background.top = {1, 1, 1};
  s.background.backdrop = Vec3d{0, 0, 0};
  s.render.samples = 256;
  s.spheres = {{{0, 0, 0}, 1, 0, ""}};
  for (const double ior : {1.0, 1.5, 3.0}) {
    const double r0 = (ior - 1) * (ior - 1) / ((ior + 1) * (ior + 1));
    // Of (1 - cos)^5 over the disc: the integral of 2 c (1 - c)^5 over c in 0..1, which is 1/21.
    const double expected = (r0 + (1 - r0) / 21) * std::numbers::pi / 4;
    for (const double fuzz : {0.0, 0.3, 1.0}) {
      s.materials = {{"black", scene::Plastic{{0, 0, 0}, ior, fuzz}}};
      double mean = 0;
      const std::vector<float> values = pixels(s);  // alpha follows the colours
      for (std::size_t i = 0; i < 3 * 64 * 64; ++i) mean += static_cast<double>(values[i]) / (3 * 64 * 64);
      EXPECT_NEAR(mean / expected, 1, 0.01) << ior << ' ' << fuzz;
    }
  }
}

TEST(RenderRender, NegativeRadiusEqualsTheInverseIndex) {
  scene::Scene s = everything();
  for (const auto fresnel : {scene::Fresnel::kSchlick, scene::Fresnel::kExact, scene::Fresnel::kNone}) {
    s.materials[4] = {"glass", scene::Dielectric{1.5, fresnel}};
    s.materials[5] = {"inverse", scene::Dielectric{1 / 1.5, fresnel}};
    s.spheres[6] = {{1, 0.5, 1.5}, -0.5, 4, ""};
    const auto negative = pixels(s);
    s.spheres[6] = {{1, 0.5, 1.5}, 0.5, 5, ""};
    EXPECT_EQ(pixels(s), negative);
    s.spheres[6] = {{1, 0.5, 1.5}, 0.5, 4, ""};
    EXPECT_NE(pixels(s), negative);
  }
}

TEST(RenderRender, SpheresAreBlackAtDepthOne) {
  scene::Scene s = everything();
  s.camera.vfov = 0.01;
  s.camera.defocus_angle = 0;
  s.render.max_depth = 1;
  for (std::size_t i = 0; const float value : pixels(s)) ASSERT_EQ(value, i++ < 3u * 61 * 37 ? 0.0f : 1.0f);
}

TEST(RenderRender, NormalAndFlatShading) {
  scene::Scene s;
  s.image = {9, 9};
  s.camera.look_from = {0, 0, 5};
  s.camera.look_at = {0, 0, 0};
  s.camera.vfov = 1e-6;
  s.render.samples = 1;
  s.materials = {{"red", scene::Lambertian{{1, 0.25, 0}}}};
  s.spheres = {{{0, 0, 0}, 1, 0, ""}};
  s.render.shading = scene::Shading::kFlat;
  auto p = pixels(s);
  EXPECT_EQ(p[40], 1.0f);
  EXPECT_EQ(p[81 + 40], 0.25f);
  s.render.shading = scene::Shading::kNormal;
  p = pixels(s);
  EXPECT_NEAR(p[40], 0.5, 1e-6);
  EXPECT_NEAR(p[2 * 81 + 40], 1.0, 1e-6);  // towards the camera
}

TEST(RenderRender, StopsWhenCancelled) {
  scene::Scene s = everything();
  const std::atomic<bool> cancel{true};
  Settings settings;
  settings.cancel = &cancel;
  const Result result = render(compile::compile(s), settings);
  EXPECT_FALSE(result.completed);
  EXPECT_TRUE(result.picture.planes.empty());
}

TEST(RenderRender, ReportsStatistics) {
  const scene::Scene s = everything();
  std::uint64_t last = 0;
  Settings settings;
  settings.on_progress = [&](const Progress& p) {
    EXPECT_GE(p.samples_done, last);
    last = p.samples_done;
  };
  const Result result = render(compile::compile(s), settings);
  EXPECT_EQ(result.statistics.paths, 61u * 37 * 7);
  EXPECT_GE(result.statistics.rays, result.statistics.paths);
  EXPECT_LE(last, result.statistics.paths);
}

}  // namespace
}  // namespace orrery::render
