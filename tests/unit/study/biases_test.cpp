// SPDX-License-Identifier: Apache-2.0
// A study detects bias, and rarely reports one for unbiased choices.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "compare/errors.h"
#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"
#include "scene/scene.h"
#include "study/axes.h"
#include "study/biases.h"
#include "study/study.h"

namespace orrery::study {
namespace {

constexpr int kWidth = 48, kHeight = 27;

class Noise {
 public:
  explicit Noise(std::uint64_t seed) : engine_(seed) {}

  /// An image with mean 1, a bias in the first pixels, and noise with rare large values in every seventh pixel. Each
  /// pixel is the mean of `samples` values that are non-zero with probability 0.02 there and 0.5 elsewhere.
  film::Picture picture(int samples, double bias, int biased_pixels) {
    film::Picture out;
    out.width = kWidth;
    out.height = kHeight;
    for (const char* name : {"R", "G", "B"}) out.planes.push_back({name, {}});
    for (int i = 0; i < kWidth * kHeight; ++i) {
      const double probability = i % 7 == 0 ? 0.02 : 0.5;
      const double light = std::binomial_distribution<int>(samples, probability)(engine_) / (probability * samples) +
                           (i < biased_pixels ? bias : 0);
      for (film::Plane& plane : out.planes) plane.values.push_back(static_cast<float>(light));
    }
    return out;
  }
  Pair pair(int samples, double bias = 0, int biased_pixels = kWidth * kHeight) {
    return {picture(samples, bias, biased_pixels), picture(samples, bias, biased_pixels)};
  }

 private:
  std::mt19937_64 engine_;
};

Point point_of(const Pair& choice, const Pair& reference) {
  Point p;
  p.measured = errors_of(choice, reference);
  p.is_shortcut = true;
  return p;
}

int biased_points(std::vector<Point> points) {
  test_bias(points);
  int biased = 0;
  for (const Point& p : points) biased += p.bias > 0;
  return biased;
}

TEST(StudyBias, RareLightGivesNoFalsePositives) {
  Noise noise(3);
  constexpr int kStudies = 60, kChoices = 30;
  int alarms = 0;
  for (int study = 0; study < kStudies; ++study) {
    const Pair reference = noise.pair(256);
    std::vector<Point> points;
    for (int i = 0; i < kChoices; ++i) points.push_back(point_of(noise.pair(4 << (i % 4 * 2)), reference));
    alarms += biased_points(points) > 0;
  }
  EXPECT_EQ(alarms, 0);
}

/// Known: the display error is half the relative error of radiance.
TEST(StudyBias, ABiasIsDetectedAndMeasured) {
  Noise noise(4);
  const Pair reference = noise.pair(1 << 16);
  std::vector<Point> points = {point_of(noise.pair(256, 0.1), reference), point_of(noise.pair(256), reference),
                               point_of(noise.pair(256, 0.5, 40), reference)};
  test_bias(points);
  EXPECT_NEAR(points[0].bias, 0.05, 0.005);
  EXPECT_EQ(points[1].bias, 0);
  EXPECT_EQ(points[1].error, points[1].measured.noise);
  EXPECT_NEAR(points[2].bias, 0.25 * std::sqrt(40.0 / (kWidth * kHeight)), 0.005) << "bias in a part of the image";
  EXPECT_NEAR(points[2].error, std::hypot(points[2].measured.noise, points[2].bias), 1e-12);
}

/// The light of a sun that bounced paths rarely hit: `hits` of all paths carry a fifth of the image's light.
film::Picture sun_found_by_chance(std::mt19937_64& engine, double hits) {
  film::Picture out;
  out.width = kWidth;
  out.height = kHeight;
  constexpr int kPixels = kWidth * kHeight;
  std::vector<float> values(kPixels, 0.8F);
  for (int n = std::poisson_distribution<int>(hits)(engine); n > 0; --n)
    values[std::uniform_int_distribution<std::size_t>(0, kPixels - 1)(engine)] +=
        static_cast<float>(0.2 * kPixels / hits);
  for (const char* name : {"R", "G", "B"}) out.planes.push_back({name, values});
  return out;
}

TEST(StudyBias, LightThatFewPathsHaveFoundIsNotBias) {
  std::mt19937_64 engine(6);
  Noise noise(6);
  const Pair reference = noise.pair(1 << 20);
  int alarms = 0;
  constexpr int kStudies = 3000;
  for (int i = 0; i < kStudies; ++i)
    alarms += biased_points({point_of({sun_found_by_chance(engine, 4), sun_found_by_chance(engine, 4)}, reference)});
  EXPECT_LE(alarms, kStudies * compare::kFamilyWiseError);
}

/// Where no path has found it, it cannot be distinguished from a bias; but only shortcuts can have one.
TEST(StudyBias, LightThatNoPathHasFoundIsAnError) {
  std::mt19937_64 engine(7);
  Noise noise(7);
  Point missing = point_of({sun_found_by_chance(engine, 0.01), sun_found_by_chance(engine, 0.01)}, noise.pair(1 << 20));
  std::vector<Point> points = {missing};
  test_bias(points);
  EXPECT_NEAR(points[0].bias, 0.1, 0.001);
  missing.is_shortcut = false;
  points = {missing};
  test_bias(points);
  EXPECT_EQ(points[0].bias, 0);
  EXPECT_NEAR(points[0].error, 0.1, 0.001);
}

TEST(StudyBias, ReferenceNoiseIsThatOfTheMeanImage) {
  Noise noise(5);
  const Pair reference = noise.pair(1 << 14);
  // A sample has a variance of 1 in six of seven pixels and of 49 in the others; the mean of two images has half of it.
  EXPECT_NEAR(noise_of_mean(reference), std::sqrt((6 + 49) / 7.0 / (1 << 14) / 2) / 2, 4e-4);
  EXPECT_EQ(mean_of(reference).planes[1].values[5],
            (reference.first.planes[1].values[5] + reference.second.planes[1].values[5]) / 2);
}

scene::Scene twenty_spheres() {
  std::mt19937_64 engine(20);
  const auto number = [&](double a, double b) { return a + (b - a) * static_cast<double>(engine() >> 11) * 0x1p-53; };
  scene::Scene s;
  s.image = {kWidth, kHeight};
  s.camera.look_from = {0, 1.5, 6};
  s.camera.look_at = {0, 0.5, 0};
  s.camera.vfov = 40;
  s.materials = {{"grey", scene::Lambertian{{0.5, 0.5, 0.5}}},
                 {"red", scene::Lambertian{{0.8, 0.2, 0.1}}},
                 {"metal", scene::Metal{{0.8, 0.8, 0.8}, 0.3}},
                 {"glass", scene::Dielectric{1.5, scene::Fresnel::kExact}}};
  s.spheres = {{{0, -1000, 0}, 1000, 0, ""}};
  while (s.spheres.size() < 20)
    s.spheres.push_back({{number(-3, 3), 0.4, number(-3, 2)},
                         0.4,
                         static_cast<std::uint32_t>(s.spheres.size() % s.materials.size()),
                         ""});
  return s;
}

/// ORRERY_STUDIES sets the number of studies, each with different seeds.
TEST(StudyBias, AnUnbiasedSceneGivesNoFalsePositives) {
  const char* wanted = std::getenv("ORRERY_STUDIES");
  const int studies = wanted != nullptr ? std::atoi(wanted) : 2;
  const scene::Scene scene = twenty_spheres();
  const compile::CompiledScene compiled = compile::compile(scene);
  std::vector<Choice> choices;
  for (const Choice& c : plan_axes(scene, compiled, 0.05).choices)
    if (!c.is_shortcut && c.axis != "accelerator" && c.samples <= 64) choices.push_back(c);
  ASSERT_GE(choices.size(), 10u);
  int alarms = 0, biased = 0;
  for (int study = 0; study < studies; ++study) {
    const auto seed = [study](std::uint32_t i) { return 4 * static_cast<std::uint32_t>(study) + i; };
    const auto pair = [&](compile::CompiledScene w, double noise, std::uint32_t first_seed) {
      render::Settings settings;
      settings.noise = noise;
      settings.unlimited = noise > 0;
      Pair out;
      for (std::uint32_t i = 0; i < 2; ++i) {
        w.sampler.seed = seed(first_seed + i);
        (i == 0 ? out.first : out.second) = render::render(w, settings).picture;
      }
      return out;
    };
    compile::CompiledScene w = compiled;
    w.samples = 256;
    const Pair reference = pair(w, 0, 2);
    std::vector<Point> points;
    for (const Choice& choice : choices) {
      w = compiled;
      w.samples = choice.samples;
      if (choice.apply) choice.apply(w);
      points.push_back(point_of(pair(w, choice.noise, 0), reference));
    }
    const int found = biased_points(points);
    alarms += found > 0;
    biased += found;
  }
  std::printf("%d of %d studies of %zu unbiased choices reported a bias, in %d choices\n", alarms, studies,
              choices.size(), biased);
  EXPECT_LE(alarms, studies * compare::kFamilyWiseError + 3 * std::sqrt(studies * compare::kFamilyWiseError));
}

TEST(StudyBiases, TimesThatDifferByMoreThanAThirdAreAWarning) {
  EXPECT_EQ(spread_warning(1, 1.29), "");
  EXPECT_EQ(spread_warning(1.29, 1), "");
  EXPECT_NE(spread_warning(1, 1.31).find("factor of 1.3"), std::string::npos);
  EXPECT_NE(spread_warning(2, 1).find("factor of 2.0"), std::string::npos);
}

}  // namespace
}  // namespace orrery::study
