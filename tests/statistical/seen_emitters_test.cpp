// SPDX-License-Identifier: Apache-2.0
// Emitters that the camera sees: sampled and found by camera rays, in random scenes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "kernel/scene_view.h"
#include "kernel/seen_emitters.h"
#include "render/render.h"
#include "render/result.h"
#include "render/seen_emitters.h"
#include "render/settings.h"
#include "support/lit_scenes.h"

namespace orrery::test {
namespace {

/// Uniform in an interval.
struct RandomNumber {
  std::mt19937 random;

  double operator()(double low, double high) { return low + (high - low) * (static_cast<double>(random()) * 0x1p-32); }
};

/// Lamps, mirror balls and screens at random places, through a random camera.
scene::Scene random_stars(unsigned seed) {
  RandomNumber number{std::mt19937(seed)};
  scene::Scene s;
  s.image = {24, 16};
  s.image.pixel_aspect = seed % 5 == 0 ? 1.5 : 1;
  s.camera.look_from = {0, 0, 10};
  s.camera.look_at = {number(-1, 1), number(-1, 1), 0};
  s.camera.vfov = number(20, 70);
  if (seed % 4 != 0) {
    s.camera.defocus_angle = number(0.3, 6);
    s.camera.focus_distance = number(4, 20);
  }
  if (seed % 3 == 0) s.render.filter = scene::Filter::kGaussian;
  if (seed % 7 == 0) s.render.precision = scene::Precision::kFast;
  s.render.sampler = scene::Sampler::kIndependent;
  s.render.max_depth = 2;
  s.background.type = scene::BackgroundType::kConstant;
  s.background.color = {0.02, 0.02, 0.02};
  const int lamps = 1 + static_cast<int>(number(0, 8));
  for (int i = 0; i < lamps; ++i) {
    const double z = number(-8, 7), wide = 0.3 * (10 - z), light = std::exp(number(0, 5));
    add_lamp(s, {number(-1, 1) * wide, number(-0.7, 0.7) * wide, z}, number(0.002, 0.02) * (10 - z),
             {light, light, light});
  }
  for (int i = 0; i < 3; ++i) {
    scene::Lambertian screen{{0.5, 0.5, 0.5}};
    if (i == 1) screen.opacity = 0.6;
    add_ball(s, {number(-3, 3), number(-2, 2), number(0, 8)}, number(0.1, 0.5), screen);
  }
  return s;
}

/// Sharp balls with images of lamps and the sun that are smaller than a pixel.
scene::Scene random_glints(unsigned seed) {
  RandomNumber number{std::mt19937(seed)};
  scene::Scene s;
  s.image = {24, 16};
  s.camera.look_from = {0, 0, 10};
  s.camera.look_at = {number(-1, 1), number(-1, 1), 0};
  s.camera.vfov = number(20, 50);
  if (seed % 4 == 0) {
    s.camera.defocus_angle = number(0.05, 0.5);
    s.camera.focus_distance = number(8, 12);
  }
  if (seed % 3 == 0) s.render.filter = scene::Filter::kGaussian;
  s.render.sampler = scene::Sampler::kIndependent;
  s.render.max_depth = 2 + static_cast<int>(seed % 3);
  s.background.type = scene::BackgroundType::kConstant;
  s.background.color = {0.02, 0.02, 0.02};
  if (seed % 5 == 0) {
    const auto map = bright_texel_map(0.1f);
    map->sun.direction = math::normalized(math::Vec3d{number(-1, 1), number(-1, 1), number(-0.5, 1)});
    map->sun.one_minus_cos = number(1e-5, 1e-3);
    map->sun.radiance = {200, 200, 200};
    s.background.type = scene::BackgroundType::kImage;
    s.background.image = map;
  }
  const int lamps = 1 + static_cast<int>(number(0, 4));
  for (int i = 0; i < lamps; ++i) {
    const double light = std::exp(number(4, 6));
    add_lamp(s, {number(-9, 9), number(-9, 9), number(-4, 18)}, number(0.3, 1), {light, light, light});
  }
  const int balls = 1 + static_cast<int>(number(0, 6));
  for (int i = 0; i < balls; ++i) {
    const math::Vec3d center{number(-3, 3), number(-2, 2), number(-2, 3)};
    const double radius = number(0.3, 0.9);
    switch (static_cast<int>(number(0, 4))) {
      case 0: add_ball(s, center, radius, scene::Dielectric{number(1.5, 2), scene::Fresnel::kExact}); break;
      case 1: add_ball(s, center, radius, scene::Plastic{{0.3, 0.3, 0.3}, number(1.3, 2.5), 0}); break;
      default: add_ball(s, center, radius, scene::Metal{{0.9, 0.9, 0.9}, 0});
    }
  }
  scene::Lambertian screen{{0.5, 0.5, 0.5}};
  screen.opacity = 0.6;
  add_ball(s, {number(-4, 4), number(-4, 4), number(2, 9)}, number(0.1, 0.6), screen);
  return s;
}

/// The mean of an image, and its squared standard error.
struct ImageMean {
  double mean = 0, error2 = 0;
};

ImageMean image_mean(const compile::CompiledScene& compiled) {
  render::Settings settings;
  settings.layers.variance = true;
  const render::Result r = render::render(compiled, settings);
  ImageMean out;
  double pixels = 0;
  for (const film::Plane& plane : r.picture.planes) {
    if (plane.name == "R") {
      pixels = static_cast<double>(plane.values.size());
      for (const float v : plane.values) out.mean += static_cast<double>(v) / pixels;
    }
    if (plane.name == "variance.R")
      for (const float v : plane.values) out.error2 += static_cast<double>(v) / (pixels * pixels);
  }
  return out;
}

/// Differences in standard errors have the distribution of a normal variable. ORRERY_SEEN_SCENES and
/// ORRERY_SEEN_SAMPLES set the number of scenes and of samples per pixel.
void expect_same_light(scene::Scene (*scene_of)(unsigned), bool in_balls) {
  const auto setting = [](const char* name, int otherwise) {
    const char* const value = std::getenv(name);
    return value != nullptr ? std::atoi(value) : otherwise;
  };
  const int scenes = setting("ORRERY_SEEN_SCENES", 60), samples = setting("ORRERY_SEEN_SAMPLES", 1024);
  double squares = 0, largest = 0, gain = 0;
  int tested = 0;
  for (int i = 1; i <= scenes; ++i) {
    scene::Scene s = scene_of(static_cast<unsigned>(i));
    s.render.samples = samples;
    const compile::CompiledScene on = compile::compile(s);
    const render::SeenEmitterList list(on.view(), on.precision, on.width, on.height);
    const auto& sights = list.view().sights;
    if (std::ranges::none_of(sights, [&](kernel::Sight at) { return (at.ball != kernel::kCamera) == in_balls; }))
      continue;
    s.render.direct_lighting = scene::DirectLighting::kBsdf;
    s.render.seed = 77;
    s.render.samples = 4 * samples;
    const ImageMean sampled = image_mean(on), found = image_mean(compile::compile(s));
    const double z = (sampled.mean - found.mean) / std::sqrt(sampled.error2 + found.error2);
    EXPECT_LT(std::abs(z), 4) << "scene " << i << ": " << sampled.mean << " against " << found.mean;
    squares += z * z;
    largest = std::max(largest, std::abs(z));
    gain += std::log(4 * found.error2 / sampled.error2);
    ++tested;
  }
  ASSERT_GT(tested, scenes / 2);
  const double rms = std::sqrt(squares / tested), error = std::sqrt(0.5 / tested);
  std::printf("%d scenes: rms of z %.3f, largest %.2f, variance of hits by chance %.3g times\n", tested, rms, largest,
              std::exp(gain / tested));
  EXPECT_NEAR(rms, 1, 3 * error);
}

TEST(StatisticalSeenEmitters, SampledOnesAreAsBrightAsFoundOnes) { expect_same_light(random_stars, false); }

TEST(StatisticalSeenEmitters, SampledGlintsAreAsBrightAsFoundOnes) { expect_same_light(random_glints, true); }

}  // namespace
}  // namespace orrery::test
