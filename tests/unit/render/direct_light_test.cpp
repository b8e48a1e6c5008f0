// SPDX-License-Identifier: Apache-2.0
// Direct light in whole renders: closed forms and bounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "compile/compile.h"
#include "render/render.h"
#include "support/lit_scenes.h"

namespace orrery::render {
namespace {

constexpr scene::DirectLighting kModes[] = {scene::DirectLighting::kMis, scene::DirectLighting::kBsdf,
                                            scene::DirectLighting::kLight};

film::Picture picture(const scene::Scene& s) {
  const Result result = render(compile::compile(s), Settings{});
  EXPECT_EQ(result.statistics.bad_samples, 0u);
  return result.picture;
}

/// A sphere in a shell that emits, with the camera inside the shell.
scene::Scene in_a_shell(double albedo) {
  scene::Scene s = test::dark_stage(16, 9);
  s.spheres.clear();
  s.materials = {{"grey", scene::Lambertian{{albedo, albedo, albedo}}}};
  s.spheres = {{{0, 0.7, 0}, 1, 0}};
  test::add_lamp(s, {1, 0, 2}, 50, {3, 3, 3});
  s.render.samples = 16;
  return s;
}

TEST(RenderDirectLight, ASphereInAnEmissiveShellHasItsAlbedoTimesTheRadiance) {
  for (const double albedo : {0.0, 0.5, 1.0}) {
    for (const auto mode : kModes) {
      scene::Scene s = in_a_shell(albedo);
      s.render.direct_lighting = mode;
      // Every path ends on the shell, after at most one reflection: no noise.
      const film::Picture p = picture(s);
      for (std::size_t i = 0; i < p.planes[0].values.size(); ++i) {
        const double value = static_cast<double>(p.planes[0].values[i]);
        const bool at_edge = value > std::min(3 * albedo, 3.0) && value < 3;
        if (at_edge) continue;
        EXPECT_TRUE(value == 3.0 || std::abs(value - 3 * albedo) < 1e-6) << value;
      }
      EXPECT_NEAR(static_cast<double>(p.planes[0].values[16 * 4 + 8]), 3 * albedo, 1e-12 + 2e-7 * albedo);
      EXPECT_EQ(p.planes[0].values[0], 3.0F);
    }
  }
}

/// A floor far from the camera, lit by one lamp; a single pixel sees it at the origin.
scene::Scene lit_floor(math::Vec3d lamp, double radius, double radiance) {
  scene::Scene s = test::dark_stage(1, 1);
  s.spheres.pop_back();
  s.spheres[0].radius = 1e9;
  s.spheres[0].center = {0, -1e9, 0};
  s.camera.look_from = {0, 1, 3};
  s.camera.look_at = {0, 0, 0};
  s.camera.vfov = 1e-4;
  s.materials[0].model = scene::Lambertian{{1, 1, 1}};
  test::add_lamp(s, lamp, radius, {radiance, radiance, radiance});
  s.render.max_depth = 2;
  s.render.samples = 4096;
  return s;
}

TEST(RenderDirectLight, RadianceOfAFloorUnderASphereLight) {
  // E = pi L (r / d)^2 cos, if the whole light is above the horizon.
  for (const double radius : {1e-6, 0.01, 0.5, 1.0}) {
    const math::Vec3d lamp{1, 2, 0.5};
    const double d2 = math::dot(lamp, lamp);
    const double expected = 10 * radius * radius / d2 * (lamp.y / std::sqrt(d2));
    scene::Scene s = lit_floor(lamp, radius, 10);
    s.render.samples = 65536;
    const double found = static_cast<double>(picture(s).planes[0].values[0]);
    EXPECT_NEAR(found / expected, 1, 1e-4) << radius;
  }
}

TEST(RenderDirectLight, RadianceOfAFloorUnderASphereLightCutByTheHorizon) {
  for (const double height : {-0.5, -0.1, 0.2, 0.7}) {
    const math::Vec3d lamp{3, height, 0};
    const double radius = 1, d = math::length(lamp);
    const double angle = std::acos(height / d), half_apex = std::asin(radius / d);
    // Quadrature over the rings of the cone; the part of a ring above the horizon has a closed form.
    double expected = 0;
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) {
      const double theta = half_apex * (i + 0.5) / kSteps;
      const double at_center = std::cos(angle) * std::cos(theta), across = std::sin(angle) * std::sin(theta);
      const double phi = std::acos(std::clamp(-at_center / across, -1.0, 1.0));
      expected += 2 * (at_center * phi + across * std::sin(phi)) * std::sin(theta) * half_apex / kSteps;
    }
    scene::Scene s = lit_floor(lamp, radius, 10);
    s.render.samples = 65536;
    for (const auto mode : {scene::DirectLighting::kMis, scene::DirectLighting::kLight}) {
      s.render.direct_lighting = mode;
      EXPECT_NEAR(static_cast<double>(picture(s).planes[0].values[0]) / (10 * expected / std::numbers::pi), 1, 6e-3)
          << height;
    }
  }
}

/// Fraction of the Sun's disc that the Moon leaves, for discs with these angular radii and distance of the centres.
double uncovered(double sun, double moon, double separation) {
  if (separation >= sun + moon) return 1;
  if (separation <= std::abs(sun - moon)) return moon >= sun ? 0 : 1 - (moon / sun) * (moon / sun);
  const double x = (separation * separation + sun * sun - moon * moon) / (2 * separation);
  const double y = separation - x;
  const double covered = sun * sun * std::acos(x / sun) - x * std::sqrt(sun * sun - x * x) +
                         moon * moon * std::acos(y / moon) - y * std::sqrt(std::max(moon * moon - y * y, 0.0));
  return 1 - covered / (std::numbers::pi * sun * sun);
}

TEST(RenderDirectLight, TheEclipsesPenumbraIsTheOverlapOfTwoDiscs) {
  // True scale, in metres; the observer's place moves across the penumbra with the Moon.
  constexpr double kSun = 6.957e8, kSunDistance = 1.496e11, kMoon = 1.7374e6, kMoonDistance = 3.78e8, kEarth = 6.371e6;
  for (const double angle : {0.0, 2e-5, 1e-3, 3e-3, 6e-3, 9e-3, 9.3e-3}) {
    scene::Scene s = test::dark_stage(1, 1);
    s.spheres = {{{0, -kEarth, 0}, kEarth, 0}};
    s.spheres.push_back({{kMoonDistance * std::sin(angle), kMoonDistance * std::cos(angle), 0}, kMoon, 1});
    s.materials[0].model = scene::Lambertian{{1, 1, 1}};
    s.camera.look_from = {0, 2, 3};
    s.camera.look_at = {0, 0, 0};
    s.camera.vfov = 1e-4;
    const double radiance = (kSunDistance / kSun) * (kSunDistance / kSun);
    test::add_lamp(s, {0, kSunDistance, 0}, kSun, {radiance, radiance, radiance});
    s.render.max_depth = 2;
    s.render.samples = 1 << 19;
    const double expected = uncovered(std::asin(kSun / kSunDistance), std::asin(kMoon / kMoonDistance), angle);
    EXPECT_NEAR(static_cast<double>(picture(s).planes[0].values[0]), expected, 1e-4) << angle;
  }
}

TEST(RenderDirectLight, NoVertexContributesMoreThanOneAndAHalfTimesAlbedoAndRadiance) {
  for (test::NamedScene& named : test::lit_scenes(24, 18)) {
    scene::Scene& s = named.scene;
    double brightest = 0;
    for (const scene::Material& m : s.materials)
      if (const auto* lamp = std::get_if<scene::Emitter>(&m.model))
        brightest = std::max({brightest, lamp->radiance.x, lamp->radiance.y, lamp->radiance.z});
    if (s.background.image) {
      brightest = std::max(brightest, s.background.image->sun.radiance.x);
      for (int y = 0; y < s.background.image->height(); ++y)
        for (int x = 0; x < 3 * s.background.image->width(); ++x)
          brightest = std::max(brightest, static_cast<double>(s.background.image->row(y)[x]));
    }
    // Two rays: the emission that the camera sees, or one vertex. One sample per pixel, many seeds.
    s.render.max_depth = 2;
    s.render.samples = 1;
    float largest = 0;
    for (std::uint32_t seed = 1; seed <= 200; ++seed) {
      s.render.seed = seed;
      for (const film::Plane& plane : picture(s).planes)
        if (plane.name != "A") largest = std::max(largest, *std::max_element(plane.values.begin(), plane.values.end()));
    }
    EXPECT_LE(static_cast<double>(largest), 1.5 * brightest) << named.name;
  }
}

TEST(RenderDirectLight, ASmallLampHasAMillionTimesLessVarianceThanByChance) {
  // r / d = 0.1, head-on and unoccluded.
  double variance[2];
  for (const bool mis : {true, false}) {
    scene::Scene s = lit_floor({0, 10, 0}, 1, 100);
    s.render.direct_lighting = mis ? scene::DirectLighting::kMis : scene::DirectLighting::kBsdf;
    s.render.sampler = scene::Sampler::kIndependent;
    s.render.samples = 64;
    double sum = 0, squares = 0;
    constexpr int kSeeds = 200;
    for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
      s.render.seed = seed;
      const double v = static_cast<double>(picture(s).planes[0].values[0]);
      sum += v;
      squares += (v - 1) * (v - 1);
    }
    EXPECT_NEAR(sum / kSeeds, 1, mis ? 1e-3 : 0.5);
    variance[mis ? 0 : 1] = squares / kSeeds;
  }
  EXPECT_GE(variance[1] / variance[0], 1e6);
}

TEST(RenderDirectLight, MotionIsThatOfTheRaysTime) {
  // A lamp that moves along the floor gives the mean of static lamps.
  scene::Scene open = lit_floor({-3, 2, 0}, 0.2, 100), closed = open;
  closed.spheres[1].center.x = 3;
  closed.camera = open.camera;
  open.render.samples = 16384;
  const Result moving = render(compile::compile(open, &closed), Settings{});
  double mean = 0;
  constexpr int kSteps = 400;
  for (int i = 0; i < kSteps; ++i) {
    const double x = -3 + 6 * (i + 0.5) / kSteps, d2 = x * x + 4;
    mean += 100 * 0.04 / d2 * (2 / std::sqrt(d2)) / kSteps;
  }
  EXPECT_NEAR(static_cast<double>(moving.picture.planes[0].values[0]) / mean, 1, 1e-3);
}

}  // namespace
}  // namespace orrery::render
