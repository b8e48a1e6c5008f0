// SPDX-License-Identifier: Apache-2.0
#include "denoise/planes.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace orrery::denoise {
namespace {

constexpr Frame kFrame{9, 6};

Values random_values(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0, 1);
  Values out(kFrame.pixels());
  for (float& v : out) v = uniform(random);
  return out;
}

TEST(DenoisePlanes, WindowMeansRepeatTheEdge) {
  const Values in = random_values(1);
  for (const int radius : {0, 1, 3}) {
    const Values means = window_means(in, kFrame, radius);
    for (int y = 0; y < kFrame.height; ++y)
      for (int x = 0; x < kFrame.width; ++x) {
        double sum = 0;
        for (int dy = -radius; dy <= radius; ++dy)
          for (int dx = -radius; dx <= radius; ++dx) sum += static_cast<double>(in[kFrame.at(x + dx, y + dy)]);
        ASSERT_NEAR(means[kFrame.at(x, y)], sum / ((2 * radius + 1) * (2 * radius + 1)), 1e-6) << x << " " << y;
      }
  }
}

TEST(DenoisePlanes, VarianceOfHalvesIsThatOfTheirMeanAndAddsUpOverPlanes) {
  constexpr Frame kLarge{200, 100};
  std::mt19937 random(2);
  std::normal_distribution<float> normal(1, 0.5F);
  const auto noise = [&] {
    Values out(kLarge.pixels());
    for (float& v : out) v = normal(random);
    return out;
  };
  const Values a = noise(), b = noise(), c = noise(), d = noise();
  double sum = 0;
  for (const float v : variance_of({{&a, &b}, {&c, &d, 3}}, kLarge, 2)) sum += static_cast<double>(v);
  // A half has the variance 1/4, the mean of two 1/8, and three times the mean 9/8.
  EXPECT_NEAR(sum / static_cast<double>(kLarge.pixels()), 1.25, 0.03);
}

TEST(DenoisePlanes, VarianceCountsPixelsUpToALimit) {
  Values a(kFrame.pixels()), b = a;
  const Values limits(kFrame.pixels(), 3);
  a[kFrame.at(4, 3)] = 1000;
  EXPECT_FLOAT_EQ(variance_of({{&a, &b}}, kFrame, 1, &limits)[kFrame.at(5, 3)], 1);
}

TEST(DenoisePlanes, TheLeastValueAroundAPixel) {
  Values in(kFrame.pixels(), 5);
  in[kFrame.at(3, 3)] = 1;
  const Values out = least_around(in, kFrame, 2);
  EXPECT_EQ(out[kFrame.at(3, 3)], 1);
  EXPECT_EQ(out[kFrame.at(5, 3)], 1);
  EXPECT_EQ(out[kFrame.at(3, 1)], 1);
  EXPECT_EQ(out[kFrame.at(4, 3)], 5);
  EXPECT_EQ(out[kFrame.at(4, 4)], 5);
}

TEST(DenoisePlanes, APixelIsScaledWithItsRepetitions) {
  const Values in = random_values(3);
  for (const std::size_t pixel : {kFrame.at(0, 0), kFrame.at(kFrame.width - 1, 2), kFrame.at(4, 3)}) {
    PaddedPlane plane = padded(in, kFrame);
    scale_pixel(plane, kFrame, pixel, 0.5F);
    Values scaled = in;
    scaled[pixel] *= 0.5F;
    constexpr int kBorder = PaddedPlane::kBorder;
    for (int y = -kBorder; y < kFrame.height + kBorder; ++y)
      for (int x = -kBorder; x < kFrame.width + kBorder; ++x)
        ASSERT_EQ(*plane.at(x, y), scaled[kFrame.at(x, y)]) << x << " " << y;
  }
}

TEST(DenoisePlanes, PaddedPlanesRepeatTheEdgeAndAreFinite) {
  Values in = random_values(3);
  in[kFrame.at(4, 2)] = std::numeric_limits<float>::quiet_NaN();
  in[kFrame.at(8, 5)] = std::numeric_limits<float>::infinity();
  const PaddedPlane plane = padded(in, kFrame, 2);
  constexpr int kBorder = PaddedPlane::kBorder;
  for (int y = -kBorder; y < kFrame.height + kBorder; ++y)
    for (int x = -kBorder; x < kFrame.width + kBorder; ++x)
      ASSERT_EQ(*plane.at(x, y), 2 * usable(in[kFrame.at(x, y)])) << x << " " << y;
  EXPECT_EQ(*plane.at(4, 2), 0);
}

}  // namespace
}  // namespace orrery::denoise
