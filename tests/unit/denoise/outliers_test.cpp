// SPDX-License-Identifier: Apache-2.0
#include "denoise/outliers.h"

#include <gtest/gtest.h>

#include <limits>

namespace orrery::denoise {
namespace {

constexpr Frame kImageFrame{60, 40};

/// A grey image of two halves.
struct TwoHalves {
  Values a = Values(kImageFrame.pixels(), 0.1F), b = Values(kImageFrame.pixels(), 0.1F);

  Outliers outliers() const { return find_outliers({{&a, &b}, {&a, &b}, {&a, &b}}, kImageFrame); }
};

TEST(DenoiseOutliers, AreBrightInOneHalfOnly) {
  TwoHalves image;
  const std::size_t pixels[] = {kImageFrame.at(0, 0), kImageFrame.at(30, 20), kImageFrame.at(32, 20),
                                kImageFrame.at(59, 39)};
  image.a[pixels[0]] = 4;
  image.b[pixels[1]] = 1;
  image.a[pixels[2]] = 1e4F;  // makes no room for the one beside it
  image.b[pixels[3]] = 4;
  const Outliers outliers = image.outliers();
  ASSERT_EQ(outliers.pixels.size(), 4U);
  for (int i = 0; i < 4; ++i) {
    const Outlier& outlier = outliers.pixels[static_cast<std::size_t>(i)];
    EXPECT_EQ(outlier.pixel, pixels[i]);
    EXPECT_EQ(outlier.is_in_a, i % 2 == 0);
    EXPECT_EQ(outlier.is_spread, i != 2);
    const float light = outlier.factors[1] * (image.a[outlier.pixel] + image.b[outlier.pixel]) / 2;
    if (i != 2) {
      EXPECT_NEAR(light, 0.4F, 0.2F) << i;
    }
  }
  EXPECT_EQ(outliers.lower_bound(1)->pixel, pixels[1]);
  EXPECT_EQ(outliers.lower_bound(kImageFrame.pixels()), outliers.pixels.end());
}

TEST(DenoiseOutliers, AreNotHighlightsOfBothHalves) {
  TwoHalves image;
  image.a[kImageFrame.at(30, 20)] = 1000;
  image.b[kImageFrame.at(30, 20)] = 300;
  const Outliers outliers = image.outliers();
  EXPECT_TRUE(outliers.pixels.empty());
  EXPECT_LT(outliers.limits[kImageFrame.at(31, 20)], 30) << "but others do not count its noise as theirs";
}

TEST(DenoiseOutliers, AreNotMany) {
  TwoHalves image;
  for (std::size_t i = 0; i < kImageFrame.pixels(); i += 7) (i % 2 == 0 ? image.a : image.b)[i] = 100;
  EXPECT_TRUE(image.outliers().pixels.empty());
}

TEST(DenoiseOutliers, IgnoreBadValues) {
  TwoHalves image;
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();
  image.a[7] = image.b[100] = kNan;
  image.a[300] = kInfinity;
  EXPECT_TRUE(image.outliers().pixels.empty());
}

TEST(DenoiseOutliers, KeepEnoughToBeRestored) {
  TwoHalves image;
  image.a.assign(kImageFrame.pixels(), 0);
  image.b.assign(kImageFrame.pixels(), 0);
  image.a[500] = 1e6F;
  const Outliers outliers = image.outliers();
  ASSERT_EQ(outliers.pixels.size(), 1U);
  EXPECT_FALSE(outliers.pixels.front().is_spread);
  EXPECT_GT(outliers.pixels.front().factors[0], 0);
}

}  // namespace
}  // namespace orrery::denoise
