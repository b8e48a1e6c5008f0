// SPDX-License-Identifier: Apache-2.0
// Convergence rate by sampler, and accuracy and bias of adaptive sampling.
#include <gtest/gtest.h>

#include <cmath>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "film/display_error.h"
#include "film/picture.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"
#include "support/room.h"

namespace orrery::render {
namespace {

/// Views in which all pixels are equivalent, so one render gives the RMS error without several seeds.
enum class View { kSmooth, kSilhouette };

scene::Scene scene_of(View view) {
  scene::Scene s;
  s.image = {64, 64};
  s.materials = {{"white", scene::Lambertian{{0.8, 0.8, 0.8}}}};
  if (view == View::kSmooth) {
    // A lens so wide that every pixel sees half the sky out of focus: smooth in all four dimensions.
    s.camera.vfov = 0.001;
    s.camera.defocus_angle = 60;
    s.camera.focus_distance = 1e-3;
    s.camera.look_at = {0, 1, -1};
  } else {
    // A sphere so large that its edge is straight; the edge crosses the defocused view of every pixel.
    s.camera.vfov = 1e-3;
    s.camera.defocus_angle = 1;
    s.camera.focus_distance = 1;
    s.camera.look_at = {0, 0, -1};
    s.background.type = scene::BackgroundType::kConstant;
    s.render.shading = scene::Shading::kFlat;
    s.spheres = {{{0.3, -1000, -3}, 1000, 0, ""}};
  }
  return s;
}

/// Root mean square error over all pixels.
double error_of(scene::Scene s, scene::Sampler sampler, int samples, const std::vector<float>& truth) {
  s.render.sampler = sampler;
  s.render.samples = samples;
  const Result r = render(compile::compile(s), {});
  double sum = 0;
  const auto& values = r.picture.planes[0].values;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double d = static_cast<double>(values[i]) - static_cast<double>(truth[i]);
    sum += d * d;
  }
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// Slope of log error over log samples, from 16 to 1024 samples.
double slope_of(View view, scene::Sampler sampler) {
  scene::Scene s = scene_of(view);
  s.render.samples = 16384;
  s.render.seed = 77;
  const std::vector<float> truth = render(compile::compile(s), {}).picture.planes[0].values;
  s.render.seed = 1;
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (int samples = 16; samples <= 1024; samples *= 4) {
    const double x = std::log(samples), y = std::log(error_of(s, sampler, samples, truth));
    n += 1;
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  ::testing::Test::RecordProperty("slope", std::to_string(slope));
  std::printf("slope %.3f\n", slope);
  return slope;
}

TEST(Convergence, IndependentSamplesConvergeAsTheInverseSquareRoot) {
  EXPECT_NEAR(slope_of(View::kSmooth, scene::Sampler::kIndependent), -0.5, 0.05);
  EXPECT_NEAR(slope_of(View::kSilhouette, scene::Sampler::kIndependent), -0.5, 0.05);
}

TEST(Convergence, SobolConvergesFasterOnSmoothIntegrands) {
  EXPECT_LT(slope_of(View::kSmooth, scene::Sampler::kSobol), -0.9);
  EXPECT_LT(slope_of(View::kSmooth, scene::Sampler::kBlueNoise), -0.9);
}

TEST(Convergence, SobolConvergesFasterAtEdges) {
  EXPECT_LT(slope_of(View::kSilhouette, scene::Sampler::kSobol), -0.62);
}

/// RMS error after averaging blocks of 4 x 4 pixels.
double error_from_afar(scene::Sampler sampler) {
  scene::Scene s = scene_of(View::kSmooth);
  s.render.samples = 4096;
  const std::vector<float> truth = render(compile::compile(s), {}).picture.planes[1].values;
  s.render.sampler = sampler;
  s.render.samples = 4;
  const std::vector<float> values = render(compile::compile(s), {}).picture.planes[1].values;
  double sum = 0;
  for (std::size_t y = 0; y < 64; y += 4) {
    for (std::size_t x = 0; x < 64; x += 4) {
      double block = 0;
      for (std::size_t i = 0; i < 16; ++i) {
        const std::size_t at = (y + i / 4) * 64 + x + i % 4;
        block += static_cast<double>(values[at]) - static_cast<double>(truth[at]);
      }
      sum += block * block / 256;
    }
  }
  return std::sqrt(sum / 256);
}

TEST(Convergence, BlueNoiseAveragesOutOverNeighbouringPixels) {
  EXPECT_LT(error_from_afar(scene::Sampler::kBlueNoise), 0.5 * error_from_afar(scene::Sampler::kSobol));
}

/// Spheres of several materials on a ground; fast to render.
scene::Scene balls() {
  scene::Scene s;
  s.image = {64, 36};
  s.camera.look_from = {0, 1.2, 4};
  s.camera.look_at = {0, 0.4, 0};
  s.camera.vfov = 40;
  s.camera.defocus_angle = 2;
  s.materials = {{"ground", scene::Lambertian{{0.5, 0.5, 0.5}}},
                 {"red", scene::Lambertian{{0.7, 0.2, 0.1}}},
                 {"steel", scene::Metal{{0.8, 0.8, 0.8}, 0.3}},
                 {"glass", scene::Dielectric{1.5}}};
  s.spheres = {{{0, -1000, 0}, 1000, 0, ""},
               {{-1.1, 0.5, 0}, 0.5, 1, ""},
               {{0, 0.5, 0}, 0.5, 3, ""},
               {{1.1, 0.5, 0}, 0.5, 2, ""},
               {{0.5, 0.2, 1}, 0.2, 1, ""}};
  return s;
}

struct Pictures {
  std::vector<film::Picture> all;

  double mean(std::size_t channel, std::size_t pixel) const {
    double sum = 0;
    for (const film::Picture& p : all) sum += static_cast<double>(p.planes[channel].values[pixel]);
    return sum / static_cast<double>(all.size());
  }
};

TEST(Adaptive, MeetsTheTargetNoiseWithoutBias) {
  scene::Scene s = balls();
  s.render.samples = 8192;
  s.render.seed = 1000;
  const film::Picture truth = render(compile::compile(s), {}).picture;
  Settings settings;
  settings.unlimited = true;
  settings.noise = 0.02;
  constexpr int kSeeds = 24;
  double total = 0, true_total = 0, squares_of_differences = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    s.render.seed = static_cast<std::uint32_t>(seed);
    const Result r = render(compile::compile(s), settings);
    EXPECT_EQ(r.statistics.ended_by, "noise");
    EXPECT_LE(*r.statistics.noise, 0.02);
    double error = 0, light = 0, true_light = 0;
    const std::size_t pixels = truth.planes[0].values.size();
    for (std::size_t i = 0; i < pixels; ++i) {
      double squares = 0, sum = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const double a = static_cast<double>(r.picture.planes[c].values[i]);
        const double b = static_cast<double>(truth.planes[c].values[i]);
        squares += (a - b) * (a - b);
        sum += b;
        light += a;
        true_light += b;
      }
      error += film::display_error_squared(squares, sum);
    }
    const double by_target = std::sqrt(error / static_cast<double>(pixels)) / 0.02;
    EXPECT_LT(by_target, 1.1) << seed;
    EXPECT_GT(by_target, 0.7) << seed;
    total += light;
    true_total += true_light;
    squares_of_differences += (light - true_light) * (light - true_light);
  }
  // The error of the mean over seeds is at most four standard errors, estimated from the seeds themselves.
  const double bias = (total - true_total) / kSeeds;
  const double variance = (squares_of_differences - kSeeds * bias * bias) / (kSeeds - 1);
  const double standard_error = std::sqrt(variance / kSeeds);
  EXPECT_LT(std::abs(bias), 4 * standard_error);
  EXPECT_LT(standard_error / (true_total / kSeeds), 2e-4);
}

/// Sum of the red channel over an image.
double light_of(const film::Picture& picture) {
  double sum = 0;
  for (const float v : picture.planes[0].values) sum += static_cast<double>(v);
  return sum;
}

TEST(Adaptive, RareLightIsNotBiased) {
  // One path in ten finds light. Choosing pixels by the variance of their own samples would lose a seventh of it.
  scene::Scene s = test::room(3.6, 10, 32, 18);
  s.render.sampler = scene::Sampler::kIndependent;
  s.render.samples = 8192;
  s.render.seed = 1000;
  const double truth = light_of(render(compile::compile(s), {}).picture);
  Settings settings;
  settings.unlimited = true;
  settings.noise = 0.3;
  constexpr int kSeeds = 40;
  double sum = 0, squares = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    s.render.seed = static_cast<std::uint32_t>(seed);
    const Result r = render(compile::compile(s), settings);
    EXPECT_LT(r.statistics.min_samples, r.statistics.max_samples);
    const double off = light_of(r.picture) / truth - 1;
    sum += off;
    squares += off * off;
  }
  const double mean = sum / kSeeds;
  const double standard_error = std::sqrt((squares / kSeeds - mean * mean) / (kSeeds - 1));
  EXPECT_LT(standard_error, 0.005);
  EXPECT_LT(std::abs(mean), 4 * standard_error);  // the reference's standard error is an eighth of this
}

}  // namespace
}  // namespace orrery::render
