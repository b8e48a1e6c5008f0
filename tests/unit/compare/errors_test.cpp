// SPDX-License-Identifier: Apache-2.0
#include "compare/errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "unit/compare/images.h"

namespace orrery::compare {
namespace {

TEST(ComparePixelErrors, MatchTheirDefinitions) {
  const Own a(2, 2, [](int x, int y, int c) { return c == 1 && x == 0 && y == 1 ? 1.0 : 0.5; });
  const Own b = flat(0, 0, 0);
  const Own half(2, 2, [](int, int, int) { return 0.5; });
  const PixelErrors e = pixel_errors(a.view, half.view);
  EXPECT_DOUBLE_EQ(e.rmse, std::sqrt(0.25 / 12));
  EXPECT_DOUBLE_EQ(e.mae, 0.5 / 12);
  EXPECT_DOUBLE_EQ(e.relative_mse, 0.25 / (0.25 + kRelativeFloor) / 12);
  EXPECT_DOUBLE_EQ(e.bias, 0.5 / 6);
  EXPECT_DOUBLE_EQ(e.psnr_db(), -10 * std::log10(0.25 / 12));
  // One pixel of four. Its mean squared error is 0.25 / 3, relative to (2 * 0.5)^2.
  EXPECT_NEAR(e.display, std::sqrt(0.25 / 3 / (4 * 0.25) / 4), 1e-7);
  EXPECT_EQ(e.max, 0.5);
  EXPECT_EQ(e.max_channel, 1);
  EXPECT_EQ(e.max_x, 0);
  EXPECT_EQ(e.max_y, 1);
}

TEST(ComparePixelErrors, RelativeErrorsUseTheReference) {
  const Own one(1, 1, [](int, int, int) { return 1; }), ten(1, 1, [](int, int, int) { return 10; });
  EXPECT_DOUBLE_EQ(pixel_errors(one.view, ten.view).relative_mse, 81 / 100.01);
  EXPECT_DOUBLE_EQ(pixel_errors(ten.view, one.view).relative_mse, 81 / 1.01);
  EXPECT_DOUBLE_EQ(pixel_errors(ten.view, one.view).display, 4.5);
}

TEST(ComparePixelErrors, NonFiniteValuesAreSkippedAndCounted) {
  Own a(2, 1, [](int, int, int) { return 0.5; });
  const Own b(2, 1, [](int, int, int) { return 0.5; });
  a.values[0][0] = std::nanf("");
  a.values[1][1] = INFINITY;
  const PixelErrors e = pixel_errors(a.view, b.view);
  EXPECT_EQ(e.not_finite, 2u);
  EXPECT_EQ(e.rmse, 0);
  EXPECT_EQ(e.display, 0);
}

TEST(ComparePixelErrors, ExcludedPixelsDoNotCount) {
  const Own a(2, 1, [](int x, int, int) { return x == 0 ? 1e30 : 3.0; });
  const Own b(2, 1, [](int, int, int) { return 2.0; });
  const PixelErrors e = pixel_errors(a.view, b.view, {true, false});
  EXPECT_EQ(e.values, 3u);
  EXPECT_EQ(e.rmse, 1);
  EXPECT_EQ(e.max, 1);
  EXPECT_EQ(e.display, 0.25) << "half of the relative error of the second pixel";
  EXPECT_EQ(display_error_map(a.view, b.view, {true, false}).values[0], 0);
}

TEST(CompareZTest, QuantilesMatchTables) {
  EXPECT_NEAR(two_sided_quantile(0.05), 1.959964, 1e-6);
  EXPECT_NEAR(two_sided_quantile(0.01), 2.575829, 1e-6);
  EXPECT_NEAR(two_sided_quantile(1e-6), 4.891638, 1e-6);
}

TEST(CompareZTest, FalsePositivesAreRareAndBiasIsDetected) {
  std::mt19937 random(11);
  std::normal_distribution<float> normal(0, 0.1f);
  const Own variance(48, 48, [](int, int, int) { return 0.01; }), zero(48, 48, [](int, int, int) { return 0.5; });
  int alarms = 0;
  for (int i = 0; i < 500; ++i) {
    const Own noisy(48, 48, [&](int, int, int) { return 0.5f + normal(random); });
    alarms += z_test(noisy.view, variance.view, zero.view, {48, 48, {}})->differ();
  }
  EXPECT_LE(alarms, 15);  // expected: 5 of 500; more than 15 with a probability of about 1e-4
  const Own biased(48, 48, [&](int x, int y, int c) {
    return 0.5f + normal(random) + (c == 2 && x >= 16 && x < 32 && y >= 32 ? 0.05f : 0.0f);
  });
  const ZTest z = *z_test(biased.view, variance.view, zero.view, {48, 48, {}});
  EXPECT_EQ(z.tests, 27);
  EXPECT_EQ(z.rejected, 1);
  EXPECT_EQ(z.channel, 2);
  EXPECT_EQ(z.x, 16);
  EXPECT_EQ(z.y, 32);
  EXPECT_NEAR(z.noise, 0.1, 1e-6);
  EXPECT_NEAR(z.mean_bias_error, 0.1 / std::sqrt(3 * 48.0 * 48) / 0.5, 1e-6);
  EXPECT_FALSE(z_test(biased.view, {48, 48, {}}, zero.view, variance.view));
}

/// Without variance no noise explains a difference, except the rounding of half-precision files.
TEST(CompareZTest, BlocksWithoutVarianceMustBeEqual) {
  const Own none(48, 48, [](int, int, int) { return 0.0; }), grey(48, 48, [](int, int, int) { return 0.5; });
  const auto test = [&](double corner) {
    const Own other(48, 48, [=](int x, int y, int) { return x < 16 && y < 16 ? corner : 0.5; });
    return *z_test(other.view, none.view, grey.view, none.view);
  };
  EXPECT_FALSE(test(0.5).differ());
  EXPECT_FALSE(test(0.5002).differ());
  const ZTest darker = test(0.4);
  EXPECT_TRUE(darker.differ());
  EXPECT_EQ(darker.rejected, 3) << "in each channel";
  EXPECT_EQ(darker.largest_z, -kCertainZ);
  EXPECT_FALSE(test(0).differ()) << "black: perhaps no path has found light yet";
  const Own noisy(48, 48, [](int x, int y, int) { return (x + y) % 3 == 0 ? 1.2 : 0.0; });
  EXPECT_FALSE(z_test(noisy.view, none.view, grey.view, none.view)->differ())
      << "one sample has noise, but no variance";
}

}  // namespace
}  // namespace orrery::compare
