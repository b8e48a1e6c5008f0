// SPDX-License-Identifier: Apache-2.0
#include "render/light_guide.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/pixel_statistics.h"

namespace orrery::render {
namespace {

std::vector<float> whole(const PixelStatistics& s, int excluded_class) {
  std::vector<float> out(s.samples.size());
  const LightGuide guide(s, excluded_class);
  for (const PixelBlock& b : blocks_of(s.width, s.height)) {
    const std::vector<float> part = guide.of(b);
    std::size_t i = 0;
    for (int y = b.y; y < b.y + b.height; ++y)
      for (int x = b.x; x < b.x + b.width; ++x) out[s.at(x, y)] = part[i++];
  }
  return out;
}

TEST(RenderLightGuide, UniformImageIsExactUpToBordersAndAcrossBlocks) {
  for (const auto& [width, height] : {std::pair{300, 140}, {7, 5}, {1, 9}, {2, 1}}) {
    PixelStatistics s(width, height);
    std::fill(s.light.begin(), s.light.end(), 0.5f);
    for (int excluded = kNoClass; excluded < kClasses; ++excluded) {
      const std::vector<float> guide = whole(s, excluded);
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
          if (class_of(x, y) == excluded) continue;
          ASSERT_NEAR(guide[s.at(x, y)], 0.5f, 1e-5f) << x << ' ' << y;
        }
      }
    }
  }
}

/// Direct implementation of the guide's definition.
double expected(const PixelStatistics& s, int excluded, int x, int y) {
  struct Means {
    double light = 0, squares = 0, variance = 0, count = 0;
  };
  const auto within = [&](int reach) {
    Means m;
    for (int v = std::max(y - reach, 0); v <= std::min(y + reach, s.height - 1); ++v) {
      for (int u = std::max(x - reach, 0); u <= std::min(x + reach, s.width - 1); ++u) {
        if (class_of(u, v) == excluded) continue;
        const auto l = static_cast<double>(s.light[s.at(u, v)]);
        m.light += l;
        m.squares += l * l;
        m.variance += static_cast<double>(s.variance[s.at(u, v)]);
        ++m.count;
      }
    }
    return Means{m.light / m.count, m.squares / m.count, m.variance / m.count, m.count};
  };
  double g = within(std::max(s.width, s.height)).light;
  for (const int reach : {16, 8, 4, 2}) {
    const Means m = within(reach);
    g += (m.light - g) * g * g / (g * g + m.variance / m.count);
  }
  const Means m = within(2);
  const double spread = std::max(m.squares - m.light * m.light - m.variance, 0.0);
  return g + (static_cast<double>(s.light[s.at(x, y)]) - g) * spread /
                 (spread + static_cast<double>(s.variance[s.at(x, y)]));
}

TEST(RenderLightGuide, MatchesItsDefinition) {
  for (const auto& [width, height] : {std::pair{150, 40}, {20, 140}}) {
    const PixelStatistics s = test::statistics_of(
        width, height, 8, 3, [](int x, int, double u) { return u < 0.3 ? 0.1f * static_cast<float>(x) : 0.2f; });
    for (const int excluded : {kNoClass, 0, 5, 7}) {
      const std::vector<float> guide = whole(s, excluded);
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
          if (class_of(x, y) == excluded || !(s.variance[s.at(x, y)] > 0)) continue;
          const double truth = expected(s, excluded, x, y);
          ASSERT_NEAR(guide[s.at(x, y)], truth, 2e-3 * truth) << x << ' ' << y << ' ' << excluded;
        }
      }
    }
  }
}

TEST(RenderLightGuide, RareHitsGiveTheLocalMean) {
  // One hit in a hundred samples, sixteen samples per pixel: most pixels are black, and a hit is six times the mean.
  const PixelStatistics s =
      test::statistics_of(96, 64, 8, 7, [](int, int, double u) { return u < 0.01 ? 50.0f : 0.0f; });
  const std::vector<float> guide = whole(s, kNoClass);
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < guide.size(); ++i) {
    if (!(s.variance[i] > 0)) continue;
    sum += std::abs(std::log2(static_cast<double>(guide[i]) / 0.5));
    ++count;
  }
  EXPECT_LT(sum / count, 0.6);
}

TEST(RenderLightGuide, ExcludedClassHasNoInfluence) {
  const auto random = [](int, int, double u) { return static_cast<float>(u); };
  PixelStatistics s = test::statistics_of(150, 140, 8, 1, random);
  for (const int excluded : {0, 4, 8}) {
    const std::vector<float> before = whole(s, excluded);
    for (int y = 0; y < s.height; ++y)
      for (int x = 0; x < s.width; ++x)
        if (class_of(x, y) == excluded) s.light[s.at(x, y)] = s.variance[s.at(x, y)] = 1e6f;
    const std::vector<float> after = whole(s, excluded);
    for (int y = 0; y < s.height; ++y) {
      for (int x = 0; x < s.width; ++x) {
        if (class_of(x, y) == excluded) continue;
        ASSERT_EQ(before[s.at(x, y)], after[s.at(x, y)]) << x << ' ' << y;
      }
    }
    s = test::statistics_of(150, 140, 8, 1, random);
  }
}

TEST(RenderLightGuide, RemainderCountsMatchALoop) {
  for (const int size : {1, 2, 3, 7, 40}) {
    for (int at = 0; at < size; ++at) {
      for (const int reach : {0, 2, 16}) {
        int all = 0, of[3] = {0, 0, 0};
        for (int i = std::max(at - reach, 0); i <= std::min(at + reach, size - 1); ++i) ++all, ++of[i % 3];
        EXPECT_EQ(window_size(at, reach, size), all);
        for (int r = 0; r < 3; ++r) EXPECT_EQ(window_size(at, reach, size, r), of[r]);
        EXPECT_EQ(window_size(at, reach, size, -1), 0);
      }
    }
  }
}

}  // namespace
}  // namespace orrery::render
