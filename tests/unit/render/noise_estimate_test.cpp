// SPDX-License-Identifier: Apache-2.0
#include "render/noise_estimate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/tiles.h"
#include "support/pixel_statistics.h"

namespace orrery::render {
namespace {

/// Fraction of samples that hit.
constexpr double kRare = 0.01;
float rare(int, int, double u) { return u < kRare ? 50.0f : 0.0f; }

TEST(RenderNoiseEstimate, EstimatesTheNoiseOfRareLight) {
  TilePool pool(1);
  for (const std::uint32_t half : {8u, 64u, 512u}) {
    // The mean is 50 p, the squared error 50^2 p (1 - p) / 2 n, and the display error is half the relative error.
    const double truth = (1 - kRare) / (kRare * 2 * half) / 4;
    const NoiseEstimate noise = estimate_noise(test::statistics_of(80, 60, half, half, rare), pool);
    EXPECT_GT(noise.mean_square, 0.75 * truth) << half;  // biased, because it is a mean of ratios
    EXPECT_LT(noise.mean_square, 1.6 * truth) << half;
    EXPECT_GT(noise.upper(), truth) << half;
  }
}

TEST(RenderNoiseEstimate, UpperEstimateIsRarelyBelowTheTrueNoise) {
  TilePool pool(1);
  const auto even = [](int, int, double u) { return static_cast<float>(u); };  // variance 1 / 12 around 1 / 2
  int below = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    const NoiseEstimate noise = estimate_noise(test::statistics_of(24, 16, 8, seed, even), pool);
    below += noise.upper() < 1.0 / 12 / 16 / (4 * 0.25) ? 1 : 0;
  }
  EXPECT_LE(below, 8);
}

TEST(RenderNoiseEstimate, DarkPixelIsNotScaledByBrightNeighbours) {
  TilePool pool(1);
  PixelStatistics s(40, 30);
  std::fill(s.samples.begin(), s.samples.end(), 8u);
  std::fill(s.light.begin(), s.light.end(), 4.0f);
  s.light[s.at(20, 15)] = 0.25f;
  s.variance[s.at(20, 15)] = 1;
  const NoiseEstimate noise = estimate_noise(s, pool);
  EXPECT_FLOAT_EQ(noise.of_pixel[s.at(20, 15)], 1 / (4 * 0.25f * 0.25f));
}

TEST(RenderNoiseEstimate, LightIsClampedToASixtyFourthOfWhite) {
  TilePool pool(1);
  PixelStatistics s(9, 9);
  std::fill(s.samples.begin(), s.samples.end(), 8u);
  std::fill(s.variance.begin(), s.variance.end(), 1e-6f);
  EXPECT_NEAR(estimate_noise(s, pool).mean_square, 1e-6 * 64 * 64 / 4, 1e-8);
}

TEST(RenderNoiseEstimate, ChoiceOfAPixelIgnoresItsOwnValues) {
  TilePool pool(1);
  const auto random = [](int, int, double u) { return u < 0.2 ? 3.0f : static_cast<float>(u); };
  PixelStatistics s = test::statistics_of(90, 70, 8, 3, random);
  const NoiseEstimate noise = estimate_noise(s, pool);
  const std::vector<float> before = errors_of_one_sample(s, noise, pool);
  const std::vector<std::uint8_t> unreliable = find_unreliable_pixels(s, pool).of_pixel;
  for (const auto& [x, y] : {std::pair{0, 0}, {44, 31}, {89, 69}, {17, 2}}) {
    PixelStatistics changed = s;
    for (int v = 0; v < s.height; ++v) {
      for (int u = 0; u < s.width; ++u) {
        if (class_of(u, v) != class_of(x, y)) continue;
        changed.light[s.at(u, v)] *= 100;
        changed.variance[s.at(u, v)] = 0;
      }
    }
    EXPECT_EQ(errors_of_one_sample(changed, noise, pool)[s.at(x, y)], before[s.at(x, y)]);
    EXPECT_EQ(find_unreliable_pixels(changed, pool).of_pixel[s.at(x, y)], unreliable[s.at(x, y)]);
  }
}

TEST(RenderNoiseEstimate, IsolatedNoisyPixelIsNotIgnored) {
  TilePool pool(1);
  PixelStatistics s(60, 40);
  std::fill(s.samples.begin(), s.samples.end(), 8u);
  std::fill(s.light.begin(), s.light.end(), 1.0f);
  s.variance[s.at(30, 20)] = 1;
  const NoiseEstimate noise = estimate_noise(s, pool);
  const std::vector<float> errors = errors_of_one_sample(s, noise, pool);
  EXPECT_GT(errors[s.at(30, 20)], 0);
  PixelStatistics one(1, 1);
  one.samples[0] = 8;
  one.light[0] = one.variance[0] = 1;
  EXPECT_GT(errors_of_one_sample(one, estimate_noise(one, pool), pool)[0], 0);
}

TEST(RenderNoiseEstimate, ErrorsAreAveragedOverNeighbours) {
  TilePool pool(1);
  PixelStatistics s(120, 120);
  std::fill(s.samples.begin(), s.samples.end(), 8u);
  std::fill(s.light.begin(), s.light.end(), 1.0f);
  for (int y = 60; y < 120; ++y)
    for (int x = 0; x < 120; ++x) s.variance[s.at(x, y)] = 0.01f;
  const std::vector<float> errors = errors_of_one_sample(s, estimate_noise(s, pool), pool);
  const float noisy = 0.01f * 8 / 4;
  EXPECT_NEAR(errors[s.at(60, 90)], noisy, 0.02f * noisy);  // plus a 64th of the image's mean
  EXPECT_LT(errors[s.at(60, 20)], 0.02f * noisy);
}

TEST(RenderNoiseEstimate, SparseNoiseIsSpreadOverAllPixels) {
  // One pixel in a hundred is noisy, at a large spacing. Neighbours cannot show which, so all get a similar error.
  TilePool pool(1);
  PixelStatistics s(90, 90);
  std::fill(s.samples.begin(), s.samples.end(), 8u);
  std::fill(s.light.begin(), s.light.end(), 1.0f);
  for (int y = 5; y < 90; y += 10)
    for (int x = 5; x < 90; x += 10) s.variance[s.at(x, y)] = 0.01f;
  const std::vector<float> errors = errors_of_one_sample(s, estimate_noise(s, pool), pool);
  const auto [least, most] = std::minmax_element(errors.begin(), errors.end());
  EXPECT_GT(*least, 0.4f * *most);
}

TEST(RenderNoiseEstimate, BlackIsAcceptedAfter1024Samples) {
  TilePool pool(1);
  PixelStatistics s(30, 20);
  for (const std::uint32_t half : {8u, 256u, 511u}) {
    std::fill(s.samples.begin(), s.samples.end(), half);
    EXPECT_EQ(find_unreliable_pixels(s, pool).count, 600u);
  }
  std::fill(s.samples.begin(), s.samples.end(), 512u);
  EXPECT_EQ(find_unreliable_pixels(s, pool).count, 0u);
  std::fill(s.samples.begin(), s.samples.end(), 8u);
  s.known_black.assign(600, 1);
  EXPECT_EQ(find_unreliable_pixels(s, pool).count, 0u);
}

TEST(RenderNoiseEstimate, TooFewHitsAreNotEvidence) {
  TilePool pool(1);
  PixelStatistics s(7, 7);
  std::fill(s.samples.begin(), s.samples.end(), 8u);
  std::fill(s.light.begin(), s.light.end(), 0.01f);  // not dark, but all noise
  const auto hit = [&](int x, int y) { s.light[s.at(x, y)] = 10, s.variance[s.at(x, y)] = 100; };
  hit(1, 1);
  hit(4, 4);
  hit(5, 2);
  EXPECT_EQ(find_unreliable_pixels(s, pool).of_pixel[s.at(3, 3)], 1);
  hit(2, 4);
  hit(1, 5);
  EXPECT_EQ(find_unreliable_pixels(s, pool).of_pixel[s.at(3, 3)], 0);
}

TEST(RenderNoiseEstimate, LightNextToADarkAreaIsNotEvidenceForIt) {
  TilePool pool(1);
  PixelStatistics s(30, 20);
  std::fill(s.samples.begin(), s.samples.end(), 8u);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 15; ++x) s.light[s.at(x, y)] = 1;
  const std::vector<std::uint8_t> missing = find_unreliable_pixels(s, pool).of_pixel;
  EXPECT_EQ(missing[s.at(16, 10)], 1);
  EXPECT_EQ(missing[s.at(13, 10)], 0);
}

TEST(RenderNoiseEstimate, ThreadsGiveTheSameBits) {
  const auto random = [](int x, int y, double u) { return u < 0.01 * (x % 50) ? static_cast<float>(y) : 0.0f; };
  const PixelStatistics s = test::statistics_of(290, 150, 4, 5, random);
  struct Found {
    double mean_square, standard_error;
    std::vector<float> of_pixel, of_one_sample;
    std::vector<std::uint8_t> missing;

    bool operator==(const Found&) const = default;
  };
  const auto with = [&](int threads) {
    TilePool pool(threads);
    const NoiseEstimate noise = estimate_noise(s, pool);
    return Found{noise.mean_square, noise.standard_error, noise.of_pixel, errors_of_one_sample(s, noise, pool),
                 find_unreliable_pixels(s, pool).of_pixel};
  };
  EXPECT_TRUE(with(1) == with(5));
}

TEST(RenderNoiseEstimate, ExtremeValuesStayFinite) {
  TilePool pool(1);
  PixelStatistics s(40, 40);
  std::fill(s.samples.begin(), s.samples.end(), 0x7fffffffu);
  for (std::size_t i = 0; i < s.light.size(); i += 3) s.light[i] = 0x1p35f, s.variance[i] = 0x1p70f;
  const NoiseEstimate noise = estimate_noise(s, pool);
  EXPECT_TRUE(std::isfinite(noise.upper()));
  for (const float e : errors_of_one_sample(s, noise, pool)) ASSERT_TRUE(std::isfinite(e));
}

}  // namespace
}  // namespace orrery::render
