// SPDX-License-Identifier: Apache-2.0
// Image textures at the levels of their mip maps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "kernel/texture-inl.h"

namespace orrery::kernel {
/// A point of a sphere, the width of the ray cone there, and the colour.
struct LevelLook {
  double outward[3] = {0, 0, 1};
  double width = 0;  ///< radians, seen from the centre
  double rgb[3] = {};
};
}  // namespace orrery::kernel

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// Consecutive points are lanes of a vector.
template <class D>
void look_at_levels(D d, const TextureImage& image, std::vector<LevelLook>& looks) {
  using T = hn::TFromD<D>;
  HWY_ALIGN T v[4][hn::MaxLanes(D())] = {};
  for (std::size_t i = 0; i < looks.size(); i += hn::Lanes(d)) {
    const std::size_t end = std::min(looks.size() - i, hn::Lanes(d));
    for (std::size_t k = 0; k < end; ++k) {
      for (std::size_t c = 0; c < 3; ++c) v[c][k] = static_cast<T>(looks[i + k].outward[c]);
      v[3][k] = static_cast<T>(looks[i + k].width * looks[i + k].width);
    }
    TexturePoint<D> at;
    at.base = at.rest = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    at.outward = load3(d, v[0], v[1], v[2]);
    at.footprint2 = hn::Load(d, v[3]);
    const auto color = image_color(d, image, at);
    hn::Store(color.x, d, v[0]);
    hn::Store(color.y, d, v[1]);
    hn::Store(color.z, d, v[2]);
    for (std::size_t k = 0; k < end; ++k)
      for (std::size_t c = 0; c < 3; ++c) looks[i + k].rgb[c] = static_cast<double>(v[c][k]);
  }
}
void levels_wide(const TextureImage& t, std::vector<LevelLook>& v) { look_at_levels(hn::ScalableTag<double>(), t, v); }
void levels_one(const TextureImage& t, std::vector<LevelLook>& v) { look_at_levels(hn::FixedTag<double, 1>(), t, v); }
void levels_narrow(const TextureImage& t, std::vector<LevelLook>& v) { look_at_levels(hn::ScalableTag<float>(), t, v); }

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace orrery::kernel {
namespace {

constexpr double kPi = std::numbers::pi;

/// An image whose levels have unrelated texels, so that it shows which of them are read.
struct Levels {
  std::vector<std::vector<float>> texels;
  TextureImage view;

  /// `value`    of a texel, by level, column and row
  template <class Value>
  Levels(std::uint32_t width, std::uint32_t height, std::uint32_t count, Value value) {
    for (std::uint32_t k = 0; k < count; ++k, width /= 2, height /= 2) {
      std::vector<float> level;
      for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
          for (int c = 0; c < 3; ++c) level.push_back(value(k, x, y));
      level.push_back(0);
      texels.push_back(level);
      view.levels[k] = {texels.back().data(), width, height};
    }
    view.level_count = count;
  }
};
Levels numbered(std::uint32_t width, std::uint32_t height) {
  return {width, height, 5, [](std::uint32_t k, std::uint32_t, std::uint32_t) { return static_cast<float>(k); }};
}
Levels random_levels() {
  std::mt19937 random{11};
  return {256, 128, 4,
          [&](std::uint32_t, std::uint32_t, std::uint32_t) { return static_cast<float>(random() % 1024) / 1024; }};
}

double seen(const TextureImage& image, double x, double y, double z, double width) {
  std::vector<LevelLook> one = {{{x, y, z}, width}};
  HWY_NAMESPACE::levels_wide(image, one);
  return one[0].rgb[1];
}

TEST(KernelTextureLevels, TheLevelHasTexelsAsWideAsTheFootprint) {
  const Levels image = numbered(512, 256);
  const double texel = kPi / 256;
  for (const double width : {0.0, 0.01, 0.5, 0.999}) EXPECT_EQ(seen(image.view, 0, 0, 1, width * texel), 0) << width;
  double last = 0;
  for (double width = 1.01; width < 16; width *= 1.01) {
    const double level = seen(image.view, 0, 0, 1, width * texel);
    EXPECT_GT(level, last);
    EXPECT_LE(level, std::log2(width) + 1e-12);
    EXPECT_GE(level, std::log2(width) - 0.05);
    last = level;
  }
  for (const double width : {2, 4, 8}) EXPECT_NEAR(seen(image.view, 0, 0, 1, width * texel), std::log2(width), 1e-12);
  for (const double width : {16.0, 1e9, std::numeric_limits<double>::infinity()})
    EXPECT_EQ(seen(image.view, 0, 0, 1, width * texel), 4) << "the last level";
  EXPECT_EQ(seen(image.view, 0, 0, 1, std::numeric_limits<double>::quiet_NaN()), 0);
}

TEST(KernelTextureLevels, TheSmallerAxisOfATexelDecides) {
  // Four times as many columns as rows need.
  const Levels wide = numbered(2048, 256), square = numbered(512, 256);
  const double width = 8 * kPi / 256;
  EXPECT_NEAR(seen(wide.view, 0, 0, 1, width), 3, 1e-12) << "eight rows, 32 columns";
  EXPECT_NEAR(seen(square.view, 0, 1, 0, width), 3, 1e-12) << "eight rows at the pole, any number of columns";
  EXPECT_NEAR(seen(square.view, 0.6, 0.8, 0, width), 3, 1e-12);
  const Levels high = numbered(512, 1024);
  EXPECT_NEAR(seen(high.view, 0, 0, 1, width), 3, 1e-12) << "eight columns, 32 rows";
  EXPECT_NEAR(seen(high.view, 0, std::sqrt(0.75), 0.5, width), 4, 1e-12) << "columns are half as wide";
}

TEST(KernelTextureLevels, AMagnifiedImageIsInterpolatedBilinearly) {
  const Levels image = random_levels();
  TextureImage alone = image.view;
  alone.level_count = 1;
  std::vector<LevelLook> looks;
  std::mt19937_64 random{3};
  std::normal_distribution<double> normal;
  for (int i = 0; i < 2000; ++i) {
    const double v[3] = {normal(random), normal(random), normal(random)};
    const double length = std::hypot(v[0], v[1], v[2]);
    looks.push_back({{v[0] / length, v[1] / length, v[2] / length}, i % 2 == 0 ? kPi / 128 * 0.99 : 0});
  }
  std::vector<LevelLook> plain = looks;
  for (LevelLook& look : plain) look.width = 0.3;
  HWY_NAMESPACE::levels_wide(image.view, looks);
  HWY_NAMESPACE::levels_wide(alone, plain);
  for (std::size_t i = 0; i < looks.size(); ++i) EXPECT_EQ(looks[i].rgb[0], plain[i].rgb[0]) << i;
}

TEST(KernelTextureLevels, LevelsAreContinuousAcrossTheSeamAndThePoles) {
  const Levels image = random_levels();
  for (const double width : {0.01, 0.03, 0.08, 0.2, 3.0})
    for (double y = -0.95; y < 1; y += 0.05) {
      const double along = std::sqrt(1 - y * y);
      EXPECT_NEAR(seen(image.view, -along, y, 1e-9, width), seen(image.view, -along, y, -1e-9, width), 1e-6) << y;
    }
  // Towards a pole, columns are interpolated along the first row, and a longitude keeps its value.
  for (const double width : {0.03, 0.2})
    EXPECT_NEAR(seen(image.view, 1e-3, 1, 1e-3, width), seen(image.view, 1e-5, 1, 1e-5, width), 1e-9);
}

TEST(KernelTextureLevels, LanesOfDifferentLevelsHaveTheBitsOfOneLane) {
  const Levels image = random_levels();
  std::vector<LevelLook> wide;
  std::mt19937_64 random{5};
  std::normal_distribution<double> normal;
  for (int i = 0; i < 4096; ++i) {
    const double v[3] = {normal(random), normal(random), normal(random)};
    const double length = std::hypot(v[0], v[1], v[2]);
    wide.push_back({{v[0] / length, v[1] / length, v[2] / length}, std::exp(normal(random) - 4)});
  }
  std::vector<LevelLook> one = wide, narrow = wide;
  HWY_NAMESPACE::levels_wide(image.view, wide);
  HWY_NAMESPACE::levels_one(image.view, one);
  HWY_NAMESPACE::levels_narrow(image.view, narrow);
  for (std::size_t i = 0; i < wide.size(); ++i) {
    ASSERT_EQ(wide[i].rgb[0], one[i].rgb[0]) << i;
    ASSERT_NEAR(wide[i].rgb[0], narrow[i].rgb[0], 1e-3) << i;
  }
}

}  // namespace
}  // namespace orrery::kernel
