// SPDX-License-Identifier: Apache-2.0
#include "render/pixel_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "render/tiles.h"
#include "support/pixel_statistics.h"

namespace orrery::render {
namespace {

kernel::PixelSum sum_of(std::initializer_list<math::Vec3d> samples) {
  kernel::PixelSum out;
  for (const math::Vec3d& s : samples) {
    const double rgb[3] = {s.x, s.y, s.z};
    for (int c = 0; c < 3; ++c) out.rgb[c] += kernel::to_fixed_point(rgb[c]);
    ++out.weight;
  }
  return out;
}

/// Pixels of one radiance without noise.
PixelStatistics even_light(int width, int height, float light, std::uint32_t half = 8) {
  PixelStatistics s(width, height);
  std::fill(s.samples.begin(), s.samples.end(), half);
  std::fill(s.light.begin(), s.light.end(), light);
  return s;
}

/// The squared error of the image, times the number of its pixels.
double total_error(const PixelStatistics& s) {
  TilePool pool(1);
  return estimate_noise(s, pool).mean_square * static_cast<double>(s.samples.size());
}

TEST(RenderPixelNoise, OutlierIsWhatTheLargestSampleAddsToTheMean) {
  PixelStatistics s(1, 1);
  s.set(0, 2, sum_of({{1, 1, 1}, {2, 2, 2}}), sum_of({{1, 1, 1}, {8, 8, 8}}), 24);
  EXPECT_FLOAT_EQ(s.light[0], 3);
  EXPECT_FLOAT_EQ(s.light[0] - s.outlier[0], 4.0f / 3);  // the mean of 1, 2 and 1
  s.set(0, 2, sum_of({{1, 1, 1}, {1, 1, 1}}), sum_of({{1, 1, 1}, {1, 1, 1}}), 3);
  EXPECT_EQ(s.outlier[0], 0);
  EXPECT_EQ(s.variance[0], 0);
}

TEST(RenderPixelNoise, EqualOutliersInBothHalvesAreVariance) {
  PixelStatistics s(1, 1);
  s.set(0, 2, sum_of({{0, 0, 0}, {6, 6, 6}}), sum_of({{6, 6, 6}, {0, 0, 0}}), 18);
  EXPECT_FLOAT_EQ(s.outlier[0], 1);  // the mean is 3, and 2 without one of them
  EXPECT_FLOAT_EQ(s.variance[0], 1);
  // In one channel only: the mean over the channels of the squared errors.
  s.set(0, 2, sum_of({{0, 0, 0}, {6, 0, 0}}), sum_of({{6, 0, 0}, {0, 0, 0}}), 6);
  EXPECT_FLOAT_EQ(s.variance[0], 1.0f / 3);
}

TEST(RenderPixelNoise, DifferentHalvesAreVariance) {
  PixelStatistics s(1, 1);
  s.set(0, 1, sum_of({{1, 1, 1}}), sum_of({{5, 5, 5}}), 15);
  EXPECT_FLOAT_EQ(s.variance[0], 4);
}

TEST(RenderPixelNoise, UpperEstimateIsRarelyBelowTheTrueNoise) {
  TilePool pool(1);
  const auto even = [](int, int, double u) { return static_cast<float>(1 + 0.1 * u); };
  const double truth = 0.01 / 12 / 16 / (4 * 1.05 * 1.05);
  int below = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    const NoiseEstimate noise = estimate_noise(test::statistics_of(24, 16, 8, seed, even), pool);
    below += noise.upper() < truth ? 1 : 0;
  }
  EXPECT_LE(below, 8);
}

TEST(RenderPixelNoise, UpperEstimateOfRareLightIsRarelyBelowTheTrueNoise) {
  // One sample in a hundred hits: the mean is 50 p, the squared error 50^2 p (1 - p) / 2 n.
  TilePool pool(1);
  constexpr double kRare = 0.01;
  const auto rare = [](int, int, double u) { return u < kRare ? 50.0f : 0.0f; };
  for (const std::uint32_t half : {8u, 64u, 512u}) {
    const double truth = (1 - kRare) / (kRare * 2 * half) / 4;
    int below = 0;
    for (unsigned seed = 0; seed < 20; ++seed)
      below += estimate_noise(test::statistics_of(80, 60, half, seed, rare), pool).upper() < truth ? 1 : 0;
    EXPECT_LE(below, 1) << half;
  }
}

TEST(RenderPixelNoise, LightIsClampedToASixtyFourthOfWhite) {
  PixelStatistics s = even_light(9, 9, 0);
  std::fill(s.variance.begin(), s.variance.end(), 1e-6f);
  EXPECT_NEAR(total_error(s), 81 * 1e-6 * 64 * 64 / 4, 1e-6);
}

TEST(RenderPixelNoise, LightOfFewSamplesCountsOnlyIfItIsSeenAround) {
  // All light of the pixel is one sample.
  PixelStatistics s = even_light(9, 9, 0);
  const std::size_t i = s.at(4, 4);
  s.light[i] = s.outlier[i] = 0.5f;
  s.variance[i] = 0.01f;
  EXPECT_NEAR(total_error(s), 0.01 / 4 * 64 * 64, 1e-4) << "black around it";
  std::fill(s.light.begin(), s.light.end(), 0.25f);
  s.light[i] = 0.5f;
  EXPECT_NEAR(total_error(s), 0.01 / 4 / (0.25 * 0.25), 1e-5) << "darker around it";
  std::fill(s.light.begin(), s.light.end(), 4.0f);
  s.light[i] = 0.5f;
  EXPECT_NEAR(total_error(s), 0.01 / 4 / (0.5 * 0.5), 1e-5) << "brighter around it";
}

TEST(RenderPixelNoise, LightBeyondTheThreeLargestSamplesCounts) {
  PixelStatistics s = even_light(9, 9, 0);
  const std::size_t i = s.at(4, 4);
  s.light[i] = 1;
  s.outlier[i] = 0.125f;
  s.variance[i] = 0.01f;
  EXPECT_NEAR(total_error(s), 0.01 / 4 / (0.625 * 0.625), 1e-5);
}

TEST(RenderPixelNoise, ThreeQuartersOfTheNeighboursMustBeAsBright) {
  PixelStatistics s = even_light(5, 5, 1);
  const std::size_t i = s.at(2, 2);
  s.light[i] = s.outlier[i] = 1;
  s.variance[i] = 0.01f;
  const auto darken = [&](int count) {
    for (int k = 0; k < count; ++k) s.light[static_cast<std::size_t>(k)] = 0.5f;
    for (int k = 0; k < count; ++k) s.outlier[static_cast<std::size_t>(k)] = 0.25f;
  };
  darken(5);
  EXPECT_NEAR(total_error(s), 0.01 / 4, 1e-5);
  darken(6);  // of 24
  EXPECT_NEAR(total_error(s), 0.01 / 4 / (0.25 * 0.25), 1e-5) << "their largest samples do not count";
}

/// Rows of wide images are processed many pixels at a time.
TEST(RenderPixelNoise, IsTheSameForATransposedImage) {
  const auto random = [](int, int, double u) { return u < 0.2 ? 3.0f : static_cast<float>(u); };
  const PixelStatistics wide = test::statistics_of(150, 20, 8, 3, random);
  PixelStatistics tall(20, 150);
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 150; ++x) {
      const std::size_t from = wide.at(x, y), to = tall.at(y, x);
      tall.samples[to] = wide.samples[from];
      tall.light[to] = wide.light[from];
      tall.variance[to] = wide.variance[from];
      tall.outlier[to] = wide.outlier[from];
    }
  }
  EXPECT_NEAR(total_error(wide) / total_error(tall), 1, 1e-12);
}

TEST(RenderPixelNoise, ChoiceOfAPixelIgnoresItsOwnValues) {
  TilePool pool(1);
  const auto random = [](int, int, double u) { return u < 0.2 ? 3.0f : static_cast<float>(u); };
  PixelStatistics s = test::statistics_of(90, 70, 8, 3, random);
  const std::vector<float> before = errors_of_one_sample(s, pool);
  const std::vector<std::uint8_t> unreliable = find_unreliable_pixels(s, pool).of_pixel;
  for (const auto& [x, y] : {std::pair{0, 0}, {44, 31}, {89, 69}, {17, 2}}) {
    // The image's mean contains the pixel: another one takes over its value.
    PixelStatistics changed = s;
    const std::size_t own = s.at(x, y), other = s.at(60, 50);
    std::swap(changed.light[own], changed.light[other]);
    std::swap(changed.variance[own], changed.variance[other]);
    std::swap(changed.outlier[own], changed.outlier[other]);
    EXPECT_FLOAT_EQ(errors_of_one_sample(changed, pool)[own], before[own]);
    EXPECT_EQ(find_unreliable_pixels(changed, pool).of_pixel[own], unreliable[own]);
  }
}

TEST(RenderPixelNoise, IsolatedNoisyPixelIsNotIgnored) {
  TilePool pool(1);
  PixelStatistics s = even_light(60, 40, 1);
  s.variance[s.at(30, 20)] = 1;
  EXPECT_GT(errors_of_one_sample(s, pool)[s.at(30, 20)], 0);
  PixelStatistics one = even_light(1, 1, 1);
  one.variance[0] = 1;
  EXPECT_GT(errors_of_one_sample(one, pool)[0], 0);
}

TEST(RenderPixelNoise, ErrorsAreAveragedOverNeighbours) {
  TilePool pool(1);
  PixelStatistics s = even_light(120, 120, 1);
  for (int y = 60; y < 120; ++y)
    for (int x = 0; x < 120; ++x) s.variance[s.at(x, y)] = 0.01f;
  const std::vector<float> errors = errors_of_one_sample(s, pool);
  const float noisy = 0.01f * 8 / 4;
  EXPECT_NEAR(errors[s.at(60, 90)], noisy, 0.02f * noisy);  // plus a 64th of the image's mean
  EXPECT_LT(errors[s.at(60, 20)], 0.02f * noisy);
}

TEST(RenderPixelNoise, SparseNoiseIsSpreadOverAllPixelsNearIt) {
  // Each window of 17 x 17 pixels has noisy ones. Neighbours cannot show which, so all get a similar error.
  TilePool pool(1);
  PixelStatistics s = even_light(90, 90, 1);
  for (int y = 2; y < 90; y += 6)
    for (int x = 2; x < 90; x += 6) s.variance[s.at(x, y)] = 0.01f;
  const std::vector<float> errors = errors_of_one_sample(s, pool);
  const auto [least, most] = std::minmax_element(errors.begin(), errors.end());
  EXPECT_GT(*least, 0.25f * *most);
}

TEST(RenderPixelNoise, BlackIsAcceptedAfter1024Samples) {
  TilePool pool(1);
  for (const std::uint32_t half : {8u, 256u, 511u})
    EXPECT_EQ(find_unreliable_pixels(even_light(30, 20, 0, half), pool).count, 600u);
  EXPECT_EQ(find_unreliable_pixels(even_light(30, 20, 0, 512), pool).count, 0u);
  PixelStatistics known = even_light(30, 20, 0, 8);
  known.known_black.assign(600, 1);
  EXPECT_EQ(find_unreliable_pixels(known, pool).count, 0u);
}

TEST(RenderPixelNoise, FewBrightPathsAreNotEvidence) {
  TilePool pool(1);
  PixelStatistics s = even_light(7, 7, 0.01f);  // not dark, but next to nothing
  const auto hit = [&](int x, int y) { s.light[s.at(x, y)] = 10, s.outlier[s.at(x, y)] = 10; };
  hit(1, 1);
  hit(4, 4);
  hit(5, 2);
  EXPECT_EQ(find_unreliable_pixels(s, pool).of_pixel[s.at(3, 3)], 1);
  hit(2, 4);
  EXPECT_EQ(find_unreliable_pixels(s, pool).of_pixel[s.at(3, 3)], 0);
}

TEST(RenderPixelNoise, LightNextToADarkAreaIsNotEvidenceForIt) {
  TilePool pool(1);
  PixelStatistics s = even_light(30, 20, 0);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 15; ++x) s.light[s.at(x, y)] = 1;
  const std::vector<std::uint8_t> missing = find_unreliable_pixels(s, pool).of_pixel;
  EXPECT_EQ(missing[s.at(16, 10)], 1);
  EXPECT_EQ(missing[s.at(13, 10)], 0);
}

TEST(RenderPixelNoise, ASinglePixelIsItsOwnNeighbour) {
  TilePool pool(1);
  EXPECT_EQ(find_unreliable_pixels(even_light(1, 1, 1), pool).count, 0u);
  EXPECT_EQ(find_unreliable_pixels(even_light(1, 1, 0), pool).count, 1u);
}

/// Pixels that are lit without noise, with an emitter of a fiftieth of the middle one.
PixelStatistics with_emitter(std::uint32_t half, float light) {
  PixelStatistics s = even_light(15, 15, 1, half);
  s.emitters.resize(s.samples.size());
  s.emitters[s.at(7, 7)] = {0.02f, light};
  return s;
}

TEST(RenderPixelNoise, SmallEmittersNeedSeveralExpectedHits) {
  TilePool pool(1);
  const auto needs = [&](const PixelStatistics& s) { return find_unreliable_pixels(s, pool).of_pixel[s.at(7, 7)]; };
  EXPECT_EQ(needs(with_emitter(8, 10)), 1);
  EXPECT_EQ(needs(with_emitter(128, 10)), 1);
  EXPECT_EQ(needs(with_emitter(256, 10)), 0);
  EXPECT_EQ(find_unreliable_pixels(with_emitter(8, 10), pool).count, 1u) << "other pixels";
  EXPECT_EQ(needs(with_emitter(8, 0.1f)), 0) << "negligible light";
  PixelStatistics tiny = with_emitter(511, 10);
  tiny.emitters[tiny.at(7, 7)].coverage = 1e-5f;
  EXPECT_EQ(needs(tiny), 1);
  std::fill(tiny.samples.begin(), tiny.samples.end(), 8191);
  EXPECT_EQ(needs(tiny), 1);
  EXPECT_EQ(find_unreliable_pixels(tiny, pool).count, 1u);
  std::fill(tiny.samples.begin(), tiny.samples.end(), 8192);
  EXPECT_EQ(needs(tiny), 0) << "it is given up";
  EXPECT_EQ(find_unreliable_pixels(tiny, pool).count, 1u) << "and reported";
  tiny.outlier[tiny.at(7, 7)] = 10 / 1e-5f / 16384;
  EXPECT_EQ(find_unreliable_pixels(tiny, pool).count, 0u) << "a path has hit it";
}

TEST(RenderPixelNoise, SmallEmittersMayBeMissedWhereTheTargetAllowsIt) {
  TilePool pool(1);
  const PixelStatistics s = with_emitter(8, 10);
  // Without it, the display error of the pixel would be 10 / 11 / 2, and that of the image a fifteenth.
  const double square = 10.0 / 11 * 10.0 / 11 / 4 / (15 * 15);
  EXPECT_EQ(find_unreliable_pixels(s, pool, 0.99 * square).count, 1u);
  EXPECT_EQ(find_unreliable_pixels(s, pool, 1.01 * square).count, 0u);
}

TEST(RenderPixelNoise, SmallEmittersDetermineTheErrorOfTheirPixelsAlone) {
  TilePool pool(1);
  PixelStatistics s = with_emitter(256, 10);
  const auto error = [&](int x, int y) { return errors_of_one_sample(s, pool)[s.at(x, y)]; };
  const float share = 10.0f / 11;
  EXPECT_NEAR(error(7, 7), share * share * 31 / 4, 1e-3f) << "of a coverage of 1/32";
  s.light[s.at(7, 7)] = 40;
  s.variance[s.at(7, 7)] = 1e3f;
  EXPECT_NEAR(error(7, 7), share * share * 31 / 4, 1e-3f) << "its own values";
  EXPECT_EQ(error(6, 7), 0) << "its neighbour";
  s.emitters[s.at(7, 7)].coverage = 0.5f;
  EXPECT_NEAR(error(7, 7), share * share / 4, 1e-3f);
}

TEST(RenderPixelNoise, ThreadsGiveTheSameBits) {
  const auto random = [](int x, int y, double u) { return u < 0.01 * (x % 50) ? static_cast<float>(y) : 0.0f; };
  const PixelStatistics s = test::statistics_of(290, 150, 4, 5, random);
  struct Found {
    double mean_square, standard_error;
    std::vector<float> of_one_sample;
    std::vector<std::uint8_t> missing;

    bool operator==(const Found&) const = default;
  };
  const auto with = [&](int threads) {
    TilePool pool(threads);
    const NoiseEstimate noise = estimate_noise(s, pool);
    return Found{noise.mean_square, noise.standard_error, errors_of_one_sample(s, pool),
                 find_unreliable_pixels(s, pool).of_pixel};
  };
  EXPECT_TRUE(with(1) == with(5));
}

TEST(RenderPixelNoise, ExtremeValuesStayFinite) {
  TilePool pool(1);
  PixelStatistics s = even_light(40, 40, 0, 0x7fffffffu);
  for (std::size_t i = 0; i < s.light.size(); i += 3) s.light[i] = s.outlier[i] = 0x1p35f, s.variance[i] = 0x1p70f;
  EXPECT_TRUE(std::isfinite(estimate_noise(s, pool).upper()));
  for (const float e : errors_of_one_sample(s, pool)) ASSERT_TRUE(std::isfinite(e));
}

}  // namespace
}  // namespace orrery::render
