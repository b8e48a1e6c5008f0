// SPDX-License-Identifier: Apache-2.0
#include "compile/mip_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

namespace orrery::compile {
namespace {

using scene::LatLongMap;

template <class Value>
LatLongMap image_of(int width, int height, Value value) {
  LatLongMap out(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) out.row(y)[3 * x + c] = value(x, y, c);
  return out;
}

double latitude_share(double a, double b, int height) {
  return (std::cos(std::numbers::pi * a / height) - std::cos(std::numbers::pi * b / height)) / 2;
}

/// The mean of a channel over the sphere.
double channel_mean(const LatLongMap& image, int channel) {
  double sum = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      sum += static_cast<double>(image.row(y)[3 * x + channel]) * latitude_share(y, y + 1, image.height());
  return sum / image.width();
}

TEST(CompileMipMap, LevelsAreHalvedDownToSixteenRows) {
  const auto sizes = [](int width, int height) {
    LatLongMap image = image_of(width, height, [](int, int, int) { return 0.5F; });
    add_mip_map(image);
    std::vector<int> out;
    std::uint64_t texels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    for (const LatLongMap& level : image.reduced) {
      out.insert(out.end(), {level.width(), level.height()});
      texels += static_cast<std::uint64_t>(level.width()) * static_cast<std::uint64_t>(level.height());
    }
    EXPECT_EQ(mip_map_bytes(width, height), 12 * texels) << width << " x " << height;
    return out;
  };
  EXPECT_EQ(sizes(256, 128), (std::vector<int>{128, 64, 64, 32, 32, 16}));
  EXPECT_EQ(sizes(131, 67), (std::vector<int>{65, 33, 32, 16}));
  EXPECT_EQ(sizes(63, 32), (std::vector<int>{})) << "32 columns";
  EXPECT_EQ(sizes(128, 31), (std::vector<int>{})) << "16 rows";
  EXPECT_EQ(sizes(1, 3), (std::vector<int>{}));
}

TEST(CompileMipMap, ConstantImagesKeepTheirBits) {
  for (const float value : {0.1F, 1.0F / 3, 1e-42F, 3e34F}) {
    LatLongMap image = image_of(331, 173, [&](int, int, int) { return value; });
    add_mip_map(image);
    ASSERT_EQ(image.reduced.size(), 3u);
    for (const LatLongMap& level : image.reduced)
      for (int y = 0; y < level.height(); ++y)
        for (int i = 0; i < 3 * level.width(); ++i) ASSERT_EQ(level.row(y)[i], value) << level.width() << ' ' << y;
  }
}

TEST(CompileMipMap, LevelsKeepTheMeanOverTheSphere) {
  std::mt19937 random{7};
  for (const int width : {512, 331}) {
    // Bright at the poles, so that weights by area of the map would be seen.
    LatLongMap image = image_of(width, 173, [&](int, int y, int c) {
      return static_cast<float>(random() % 1000) * (y < 20 || y > 160 ? 1.0F : 0.1F) * static_cast<float>(c + 1);
    });
    add_mip_map(image);
    for (const LatLongMap& level : image.reduced)
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(channel_mean(level, c) / channel_mean(image, c), 1, 1e-6) << level.width();
  }
}

TEST(CompileMipMap, TexelsAreMeansOfThoseThatTheyCover) {
  // 65 columns become 32, each of 2 1/32; 34 rows become 17 pairs.
  LatLongMap image = image_of(65, 34, [](int x, int y, int c) {
    return c == 0 ? static_cast<float>(x) : c == 1 ? static_cast<float>(y % 2) : x == 64 ? 1.0F : 0.0F;
  });
  add_mip_map(image);
  ASSERT_EQ(image.reduced.size(), 1u);
  const LatLongMap& level = image.reduced[0];
  ASSERT_EQ(level.width(), 32);
  const double extent = 65.0 / 32;
  for (const int y : {0, 8, 16}) {
    EXPECT_NEAR(static_cast<double>(level.row(y)[0]), (0 + 1 + 2 * (extent - 2)) / extent, 1e-6);
    EXPECT_NEAR(static_cast<double>(level.row(y)[1]),
                latitude_share(2 * y + 1, 2 * y + 2, 34) / latitude_share(2 * y, 2 * y + 2, 34), 1e-6)
        << "the odd row's share of the solid angle, row " << y;
    EXPECT_EQ(level.row(y)[2], 0) << "the seam is not crossed";
    EXPECT_NEAR(static_cast<double>(level.row(y)[3 * 31 + 2]), 1 / extent, 1e-6);
  }
}

}  // namespace
}  // namespace orrery::compile
