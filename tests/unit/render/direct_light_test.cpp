// SPDX-License-Identifier: Apache-2.0
// Direct light in whole renders: closed forms and bounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <vector>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "film/picture.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"
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

/// The power of giant emitters exceeds a float's range. BSDF sampling alone hardly finds them.
TEST(RenderDirectLight, EmittersOfGiantPowerAreSampledInSinglePrecision) {
  constexpr double kRadius = 1e15, kRadiance = 1.6e10, kDistance = 9e17;
  for (const int lamps : {2, 20}) {
    scene::Scene s = lit_floor({0, kDistance, 0}, kRadius, kRadiance);
    s.spheres[0] = {{0, -1000, 0}, 1000, 0};
    for (int i = 1; i < lamps; ++i)
      test::add_lamp(s, {kDistance * (0.1 * (i % 5) - 0.23), kDistance * 0.9, kDistance * (0.1 * (i / 5) - 0.2)},
                     kRadius, {kRadiance, kRadiance, kRadiance});
    double expected = 0;
    for (std::size_t i = 1; i < s.spheres.size(); ++i) {
      const math::Vec3d& to = s.spheres[i].center;
      expected += kRadiance * kRadius * kRadius * to.y / std::pow(math::length(to), 3);
    }
    for (const auto precision : {scene::Precision::kExact, scene::Precision::kFast}) {
      s.render.precision = precision;
      EXPECT_NEAR(static_cast<double>(picture(s).planes[0].values[0]) / expected, 1, 0.02) << lamps;
    }
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
  double largest = 0;
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
    const double error = static_cast<double>(picture(s).planes[0].values[0]) - expected;
    EXPECT_LE(std::abs(error), 1e-4) << angle;
    largest = std::max(largest, std::abs(error));
  }
  std::printf("penumbra of an eclipse against the overlap of two discs: largest difference %.1e\n", largest);
}

/// Light that one vertex reflects, by its light sample and by its BSDF sample, is at most 1.5 albedo L: there are no
/// fireflies. With one sample per pixel and two rays per path, a pixel of the direct layers is one vertex.
/// ORRERY_LIGHT_VERTICES sets the number of vertices.
TEST(RenderDirectLight, NoVertexReflectsMoreThanOneAndAHalfTimesAlbedoAndRadiance) {
  constexpr double kAlbedo = 0.6;
  const char* const wanted = std::getenv("ORRERY_LIGHT_VERTICES");
  const double vertices = wanted != nullptr ? std::atof(wanted) : 1e6;
  double largest_ratio = 0;
  std::vector<test::NamedScene> scenes = test::lit_scenes(192, 128);
  for (test::NamedScene& named : scenes) {
    scene::Scene& s = named.scene;
    double brightest = 0;
    bool has_albedo_1 = false;  // glass, or the coat of plastic, in the specular layers
    for (scene::Material& m : s.materials) {
      has_albedo_1 = has_albedo_1 || std::holds_alternative<scene::Dielectric>(m.model) ||
                     std::holds_alternative<scene::Plastic>(m.model);
      if (const auto* lamp = std::get_if<scene::Emitter>(&m.model)) {
        brightest = std::max({brightest, lamp->radiance.x, lamp->radiance.y, lamp->radiance.z});
      } else if (auto* metal = std::get_if<scene::Metal>(&m.model)) {
        metal->albedo = {kAlbedo, kAlbedo, kAlbedo};
      } else if (auto* plastic = std::get_if<scene::Plastic>(&m.model)) {
        plastic->albedo = {kAlbedo, kAlbedo, kAlbedo};
      } else if (std::holds_alternative<scene::Hemisphere>(m.model)) {
        m.model = scene::Hemisphere{{kAlbedo, kAlbedo, kAlbedo}};
      } else if (std::holds_alternative<scene::Lambertian>(m.model)) {
        m.model = scene::Lambertian{{kAlbedo, kAlbedo, kAlbedo}};
      }
    }
    if (s.background.image) {
      brightest = std::max(brightest, s.background.image->sun.radiance.x);
      for (int y = 0; y < s.background.image->height(); ++y)
        for (int x = 0; x < 3 * s.background.image->width(); ++x)
          brightest = std::max(brightest, static_cast<double>(s.background.image->row(y)[x]));
    }
    s.render.max_depth = 2;
    s.render.samples = 1;
    compile::CompiledScene compiled = compile::compile(s, named.closing ? &*named.closing : nullptr);
    const std::unique_ptr<accel::Accel> accel = build(compiled, available_threads());
    Settings settings;
    settings.layers.diffuse = settings.layers.specular = true;
    settings.traversal = accel::Traversal::kPacket;
    float largest = 0;
    double found = 0;
    for (std::uint32_t seed = 1; found < vertices / static_cast<double>(scenes.size()); ++seed) {
      compiled.sampler.seed = seed;
      const Result result = render(compiled, *accel, settings);
      EXPECT_EQ(result.statistics.bad_samples, 0u);
      for (const film::Plane& plane : result.picture.planes)
        if (plane.name.rfind("diffuse_direct", 0) == 0 ||
            (!has_albedo_1 && plane.name.rfind("specular_direct", 0) == 0))
          largest = std::max(largest, *std::max_element(plane.values.begin(), plane.values.end()));
      found += static_cast<double>(result.statistics.paths);
    }
    // Planes are single precision.
    const double ratio = static_cast<double>(largest) / (kAlbedo * brightest);
    EXPECT_LE(ratio, 1.5 * (1 + 1e-7)) << named.name;
    EXPECT_GT(ratio, 0) << named.name;
    std::printf("%-60s largest %.4f albedo L\n", named.name.c_str(), ratio);
    largest_ratio = std::max(largest_ratio, ratio);
  }
  EXPECT_GT(largest_ratio, 0.9);
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
  std::printf("variance at distance / radius 10, by chance / mis: %.1e\n", variance[1] / variance[0]);
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
