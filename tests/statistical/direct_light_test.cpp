// SPDX-License-Identifier: Apache-2.0
// Direct light: all ways of sampling it converge to the same image.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <variant>
#include <vector>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "render/render.h"
#include "render/result.h"
#include "support/block_means.h"
#include "support/lit_scenes.h"

namespace orrery::test {
namespace {

constexpr int kWidth = 32, kHeight = 24;
constexpr int kBlocks = (kWidth / kBlock) * (kHeight / kBlock);

compile::CompiledScene with(const NamedScene& named, scene::DirectLighting mode, int samples) {
  scene::Scene scene = named.scene;
  scene.render.direct_lighting = mode;
  scene.render.samples = samples;
  return compile::compile(scene, named.closing ? &*named.closing : nullptr);
}

/// How closely the ways of sampling must agree.
struct Demand {
  int samples = 64, seeds = 16;
  /// Of |t| of a block. With 2 x 15 degrees of freedom a correct renderer exceeds 5 about once in 50,000 blocks, with
  /// 2 x 63 it exceeds 4 once in 10,000.
  double largest_t = 5;
  double standard_error = 0.01;  ///< of the image's mean with `mis`, relative
};

/// The largest radiance of an emitter.
double brightest_lamp(const scene::Scene& scene) {
  double brightest = 0;
  for (const scene::Material& m : scene.materials)
    if (const auto* lamp = std::get_if<scene::Emitter>(&m.model))
      brightest = std::max({brightest, lamp->radiance.x, lamp->radiance.y, lamp->radiance.z});
  return brightest;
}

void expect_agreement(const NamedScene& s, const Demand& demand) {
  const BlockMeans mis = block_means(with(s, scene::DirectLighting::kMis, demand.samples), demand.seeds);
  double mean = 0;
  for (const double m : mis.mean) mean += m / kBlocks;
  EXPECT_LE(mis.relative_error(), demand.standard_error) << s.name;
  std::printf("%-56s mean %.5f, standard error: mis %.1e", s.name.c_str(), mean, mis.relative_error());
  const double least = demand.standard_error / 100 * mean;
  // Where BSDF sampling finds a lamp only a few times or never, its error is unknown, and t means nothing.
  const double rare = 10 * brightest_lamp(s.scene) / (kBlock * kBlock * demand.samples * demand.seeds);
  double largest_t = 0;
  for (const auto mode : {scene::DirectLighting::kBsdf, scene::DirectLighting::kLight}) {
    const char* const name = mode == scene::DirectLighting::kBsdf ? "bsdf" : "light";
    const BlockMeans other = block_means(with(s, mode, demand.samples), demand.seeds);
    for (std::size_t b = 0; b < kBlocks; ++b) {
      if (mode == scene::DirectLighting::kBsdf && mis.mean[b] < rare) continue;
      const double error = std::sqrt(mis.error2[b] + other.error2[b]);
      const double t = std::max(std::abs(mis.mean[b] - other.mean[b]) - least, 0.0) / error;
      largest_t = std::max(largest_t, error > 0 ? t : 0);
      EXPECT_TRUE(t < demand.largest_t || std::abs(mis.mean[b] - other.mean[b]) <= least)
          << s.name << ", block " << b << ": " << mis.mean[b] << " against " << other.mean[b] << " (" << name
          << "), error " << error;
    }
    std::printf(", %s %.1e", name, other.relative_error());
  }
  std::printf(", largest |t| %.2f\n", largest_t);
  std::fflush(stdout);
}

/// ORRERY_LIT_SAMPLES sets the samples per pixel of each of 64 seeds; then |t| < 4 and a standard error of 1e-4 are
/// required.
TEST(StatisticalDirectLight, AllWaysOfSamplingAgree) {
  Demand demand;
  if (const char* samples = std::getenv("ORRERY_LIT_SAMPLES")) demand = {std::atoi(samples), 64, 4, 1e-4};
  for (const NamedScene& s : lit_scenes(kWidth, kHeight)) expect_agreement(s, demand);
}

/// Root mean square error of the pixels, relative to the mean, from pairs of seeds.
double relative_noise(const scene::Scene& scene, int pairs) {
  compile::CompiledScene compiled = compile::compile(scene);
  double squares = 0, sum = 0;
  for (int pair = 0; pair < pairs; ++pair) {
    std::vector<float> values[2];
    for (const int i : {0, 1}) {
      compiled.sampler.seed = static_cast<std::uint32_t>(2 * pair + i + 1);
      values[i] = render::render(compiled, {}).picture.planes[1].values;
    }
    for (std::size_t p = 0; p < values[0].size(); ++p) {
      const double a = static_cast<double>(values[0][p]), b = static_cast<double>(values[1][p]);
      squares += (a - b) * (a - b) / 2;
      sum += (a + b) / 2;
    }
  }
  const double pixels = kWidth * kHeight * pairs;
  return std::sqrt(squares / pixels) / (sum / pixels);
}

/// A texel a million times as bright as the rest is sampled as well as a sphere that gives the same light.
TEST(StatisticalDirectLight, ASunOfOneTexelIsAsGoodAsASphere) {
  constexpr int kTexels = 64;
  constexpr double pi = std::numbers::pi;
  scene::Scene texel = dark_stage(kWidth, kHeight);
  texel.render.samples = 64;
  texel.background.type = scene::BackgroundType::kImage;
  const auto map = [&](float brightest) {
    auto image = std::make_shared<scene::LatLongMap>(kTexels, kTexels / 2);
    for (int y = 0; y < kTexels / 2; ++y) std::fill_n(image->row(y), 3 * kTexels, 1e-3F);
    std::fill_n(image->row(kTexels / 8) + 3 * (kTexels / 4 + 5), 3, brightest);
    return image;
  };
  texel.background.image = map(1e3F);
  scene::Scene sphere = texel;
  sphere.background.image = map(1e-3F);
  // The bilinear lookup spreads the texel over its neighbours; its light is that of one texel.
  const double polar = pi * (kTexels / 8 + 0.5) / (kTexels / 2);
  const double longitude = pi - 2 * pi * (kTexels / 4 + 5.5) / kTexels;
  const double solid_angle = 2 * pi / kTexels * (std::cos(polar - pi / kTexels) - std::cos(polar + pi / kTexels));
  const double distance = 1e5, radius = distance * std::sqrt(solid_angle / pi);
  add_lamp(sphere,
           math::Vec3d{std::sin(polar) * std::sin(longitude), std::cos(polar), std::sin(polar) * std::cos(longitude)} *
               distance,
           radius, {1e3, 1e3, 1e3});
  const double by_texel = relative_noise(texel, 20), by_sphere = relative_noise(sphere, 20);
  RecordProperty("error of the texel / of the sphere", std::to_string(by_texel / by_sphere));
  std::printf("relative error with a texel %.4f, with a sphere %.4f, ratio %.2f\n", by_texel, by_sphere,
              by_texel / by_sphere);
  EXPECT_LT(by_texel / by_sphere, 1.3);
  EXPECT_GT(by_texel / by_sphere, 0.5) << "not the same light";
}

/// Russian roulette ends paths, whose light so far remains, and multiplies that of the others.
TEST(StatisticalDirectLight, RussianRouletteIsUnbiased) {
  for (NamedScene& s : lit_scenes(kWidth, kHeight)) {
    s.scene.materials[0].model = scene::Lambertian{{0.06, 0.1, 0.08}};  // a survival probability of 0.8 at the floor
    const auto means = [&](int roulette_depth) {
      s.scene.render.roulette_depth = roulette_depth;
      return block_means(with(s, scene::DirectLighting::kMis, 64), 16);
    };
    const BlockMeans without = means(0), roulette = means(1);
    for (std::size_t b = 0; b < kBlocks; ++b) {
      const double error = std::sqrt(without.error2[b] + roulette.error2[b]);
      EXPECT_LT(std::abs(without.mean[b] - roulette.mean[b]), 5 * error + 1e-12) << s.name << ", block " << b;
    }
    EXPECT_NE(without.mean, roulette.mean) << s.name;
  }
}

}  // namespace
}  // namespace orrery::test
