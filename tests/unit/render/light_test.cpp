// SPDX-License-Identifier: Apache-2.0
// Scenes with known path radiance: depth limits, throughput, Russian roulette, bad samples, precision.
#include <gtest/gtest.h>

#include <cmath>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "math/vec3.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"
#include "scene/scene.h"

namespace orrery::render {
namespace {

scene::Scene grey_sphere() {
  scene::Scene s;
  s.image = {16, 16};
  s.camera.look_from = {0, 0, 3};
  s.camera.look_at = {0, 0, 0};
  s.camera.vfov = 5;
  s.background.bottom = s.background.top = {1, 1, 1};
  s.render.samples = 16;
  s.materials = {{"grey", scene::Lambertian{{0.5, 0.5, 0.5}}}, {"air", scene::Dielectric{1, scene::Fresnel::kExact}}};
  s.spheres = {{{0, 0, 0}, 0.5, 0, ""}};
  return s;
}

TEST(RenderLight, PathsInAClosedSphereReachTheMaximumDepth) {
  scene::Scene s = grey_sphere();
  s.spheres[0].radius = 10;
  s.render.roulette_depth = 0;
  for (int depth = 1; depth < 6; ++depth) {
    s.render.max_depth = depth;
    const Result result = render(compile::compile(s), {});
    EXPECT_EQ(result.statistics.rays, result.statistics.paths * static_cast<unsigned>(depth));
    EXPECT_EQ(result.picture.planes[0].values[0], 0.0f);
  }
}

/// As in the book, the camera ray counts: with depth 1 surfaces are black and the sky is visible; with depth 2 a convex
/// sphere has its full radiance.
TEST(RenderLight, CameraRayCountsTowardsTheDepth) {
  for (const auto precision : {scene::Precision::kExact, scene::Precision::kFast, scene::Precision::kBook}) {
    scene::Scene s = grey_sphere();
    s.render.precision = precision;
    const auto expect_light = [&](int depth, float light) {
      s.render.max_depth = depth;
      const Result result = render(compile::compile(s), {});
      for (const float value : result.picture.planes[0].values) ASSERT_EQ(value, light) << depth;
    };
    expect_light(1, 0);
    expect_light(2, 0.5f);
    s.spheres.clear();
    expect_light(1, 1);
  }
}

TEST(RenderLight, RussianRouletteIsUnbiased) {
  scene::Scene s = grey_sphere();
  s.materials[0].model = scene::Lambertian{{0.05, 0.05, 0.05}};
  s.render.samples = 4096;
  for (const auto sampler : {scene::Sampler::kIndependent, scene::Sampler::kSobol}) {
    s.render.sampler = sampler;
    s.render.roulette_depth = 1;  // at the sphere, with survival probability 8 x 0.05
    const Result result = render(compile::compile(s), {});
    double sum = 0;
    for (const float value : result.picture.planes[0].values) sum += static_cast<double>(value);
    const auto pixels = static_cast<double>(result.picture.planes[0].values.size());
    EXPECT_NEAR(static_cast<double>(result.statistics.rays) / static_cast<double>(result.statistics.paths), 1.4, 0.01);
    // A tolerance of five standard errors of independent samples.
    EXPECT_NEAR(sum / pixels, 0.05, 5 * 0.05 * std::sqrt((1 / 0.4 - 1) / (4096 * pixels)));
  }
}

TEST(RenderLight, EverySurfaceMultipliesTheThroughput) {
  scene::Scene s = grey_sphere();
  s.spheres.push_back({{0, 0, 0}, 1, 1, ""});  // in through the air sphere, off the grey one, and out
  const Result result = render(compile::compile(s), {});
  for (const float value : result.picture.planes[0].values) ASSERT_EQ(value, 0.5f);
}

TEST(RenderLight, BadSampleIsExcludedFromThePixelMean) {
  scene::Scene s = grey_sphere();
  s.camera.vfov = 30;
  s.background.bottom = s.background.top = {1e30, 1e30, 1e30};
  s.render.shading = scene::Shading::kFlat;
  const Result result = render(compile::compile(s), {});
  EXPECT_GT(result.statistics.bad_samples, 0u);
  for (const float value : result.picture.planes[0].values) EXPECT_TRUE(value == 0.5f || value == 0.0f) << value;
}

double mean_red(const scene::Scene& s) {
  const Result result = render(compile::compile(s), {});
  double sum = 0;
  for (const float value : result.picture.planes[0].values) sum += static_cast<double>(value);
  return sum / static_cast<double>(result.picture.planes[0].values.size());
}

/// Pixel positions and directions of the first bounce are independent, so one large pixel is the mean of many small
/// ones. Half of the pixel's view is black, so the other half uses half of the pixel's random numbers.
TEST(RenderLight, LargePixelIsTheMeanOfSmallPixels) {
  scene::Scene s = grey_sphere();
  s.camera.vfov = 18;
  s.background.bottom = {0, 0, 0};
  s.background.top = {1, 1, 1};
  s.materials[1] = {"black", scene::Lambertian{{0, 0, 0}}};
  // Two walls that face the camera and meet at the image centre.
  const math::Vec3d behind{0, 0, -30};
  for (const math::Vec3d side : {math::Vec3d{3, 0, 0}, {-3, 0, 0}, {0, 3, 0}, {0, -3, 0}}) {
    s.spheres = {{behind + side, 30, 0, ""}, {behind - side, 30, 1, ""}};
    s.image = {64, 64};
    s.render.samples = 64;
    const double small = mean_red(s);
    s.image = {1, 1};
    s.render.samples = 64 * 64 * 64;
    EXPECT_NEAR(mean_red(s), small, 0.003) << side.x << ", " << side.y;
  }
}

/// Ray origins keep their rounding error: at 2^40 units from the origin a double is off by up to 2^-13.
TEST(RenderLight, SceneFarFromTheOriginLooksTheSame) {
  scene::Scene s = grey_sphere();
  s.camera.vfov = 40;
  s.background.bottom = {1, 0, 1};
  s.materials[1].model = scene::Metal{{1, 1, 1}, 0};
  s.spheres = {{{0.5, 0, 0}, 0.5, 1, ""}, {{-0.5, 0, 0}, 0.5, 1, ""}, {{0, 0.75, 0}, 0.25, 1, ""}};
  const Result home = render(compile::compile(s), {});
  const math::Vec3d away{0x1p40, 0, -0x1p40};
  s.camera.look_from = s.camera.look_from + away;
  s.camera.look_at = s.camera.look_at + away;
  for (scene::Sphere& sphere : s.spheres) sphere.center = sphere.center + away;
  const Result far = render(compile::compile(s), {});
  int different = 0;
  for (std::size_t i = 0; i < 256; ++i)
    different += std::abs(far.picture.planes[0].values[i] - home.picture.planes[0].values[i]) > 1e-6f;
  EXPECT_LE(different, 2);  // a few paths may pass a silhouette on the other side
}

/// Spheres of a billionth of a unit at a distance of a million, on coordinates exact in double. Rounding the origins of
/// secondary rays would lose an eighth of a radius.
TEST(RenderLight, SmallSceneFarFromTheOriginLooksTheSame) {
  scene::Scene s = grey_sphere();
  s.camera.look_from = {0.5, 0.25, 3};
  s.camera.look_at = {0.5, 0.25, 0};
  s.camera.vfov = 40;
  s.background.bottom = {1, 0, 1};
  s.materials[1].model = scene::Metal{{1, 1, 1}, 0};
  s.spheres = {{{0.5, 0, 0}, 0.5, 1, ""}, {{-0.5, 0, 0}, 0.5, 1, ""}, {{0, 0.75, 0}, 0.25, 1, ""}};
  const Result home = render(compile::compile(s), {});
  const auto moved = [](math::Vec3d v) { return v * 0x1p-30 + math::Vec3d{0x1p20, 0, -0x1p20}; };
  s.camera.look_from = moved(s.camera.look_from);
  s.camera.look_at = moved(s.camera.look_at);
  for (scene::Sphere& sphere : s.spheres) {
    sphere.center = moved(sphere.center);
    sphere.radius *= 0x1p-30;
  }
  const Result far = render(compile::compile(s), {});
  int different = 0;
  for (std::size_t i = 0; i < 256; ++i)
    different += std::abs(far.picture.planes[0].values[i] - home.picture.planes[0].values[i]) > 1e-6f;
  EXPECT_LE(different, 2);
}

/// A ball inside a shell that almost touches it. At 2^30 units from the origin the gap is a twentieth of the rounding
/// error of an origin stored as one double, yet an unrefracted ray from the shell must hit the ball.
TEST(RenderLight, NarrowGapFarFromTheOriginIsNotSkipped) {
  scene::Scene s = grey_sphere();
  const math::Vec3d away{0x1p30, 0x1p30, -0x1p30};
  s.camera.look_from = s.camera.look_from + away;
  s.camera.look_at = s.camera.look_at + away;
  s.spheres = {{away, 1, 0, ""}, {away, 1 + 0x1p-27, 1, ""}};
  const Result result = render(compile::compile(s), {});
  for (const float value : result.picture.planes[0].values) ASSERT_EQ(value, 0.5f);
}

}  // namespace
}  // namespace orrery::render
