// SPDX-License-Identifier: Apache-2.0
#include "compare/perceptual.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "unit/compare/images.h"

namespace orrery::compare {
namespace {

TEST(CompareConvolve, SumsOverTheKernelAndExtendsTheEdge) {
  const Map spot{5, 4, {0, 0, 0, 0, 0, 0, 0, 8, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 3}};
  const Map out = convolved(spot, {0.25f, 0.5f, 0.25f}, {0, 0.5f, 0.5f});
  EXPECT_EQ(out.values[2], 2.0f);  // the 8 below: 0.5 * 0.5 * 8
  EXPECT_EQ(out.values[1], 1.0f);
  EXPECT_EQ(out.values[19], 2.25f);  // 0.5 + 0.25 along the row, 0.5 + 0.5 along the column
}

TEST(CompareSsim, IsOneForEqualImagesAndMatchesTheFormulaForFlatOnes) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> u(0, 1);
  const Own noise(24, 16, [&](int, int, int) { return u(random); }),
      other(24, 16, [&](int, int, int) { return u(random); });
  EXPECT_DOUBLE_EQ(ssim(noise.maps(), noise.maps()), 1);
  EXPECT_LT(ssim(noise.maps(), other.maps()), 0.3);
  const Own a = flat(0.5f, 0.5f, 0.5f), b = flat(0.25f, 0.25f, 0.25f);
  const double c1 = 1e-4;  // without structure only the term of the means remains
  EXPECT_NEAR(ssim(a.maps(), b.maps()), (2 * 0.5 * 0.25 + c1) / (0.25 + 0.0625 + c1), 1e-4);
}

/// Reference implementation of FLIP: two-dimensional kernels in double, as in the paper.
class SlowFlip {
 public:
  SlowFlip(const ColorView& a, const ColorView& b) : w_(a.width), h_(a.height), a_(look(a)), b_(look(b)) {}

  double at(int x, int y) const {
    const auto i = static_cast<std::size_t>(y * w_ + x);
    const auto hyab = [](const std::array<double, 3>& p, const std::array<double, 3>& q) {
      return std::abs(p[0] - q[0]) + std::sqrt((p[1] - q[1]) * (p[1] - q[1]) + (p[2] - q[2]) * (p[2] - q[2]));
    };
    const double farthest = std::pow(hyab(lab({0, 1, 0}), lab({0, 0, 1})), 0.7);
    const double d = std::pow(hyab(a_.lab[i], b_.lab[i]), 0.7), knee = 0.4 * farthest;
    const double color = d < knee ? 0.95 * d / knee : 0.95 + 0.05 * (d - knee) / (farthest - knee);
    const double feature = std::max(std::abs(a_.edge[i] - b_.edge[i]), std::abs(a_.point[i] - b_.point[i]));
    return std::pow(color, 1 - std::sqrt(feature / std::numbers::sqrt2));
  }

 private:
  using Triple = std::array<double, 3>;
  struct Look {
    std::vector<Triple> lab;
    std::vector<double> edge, point;
  };
  int w_, h_;
  Look a_, b_;

  static Triple xyz(const Triple& c) {
    return {(10135552 * c[0] + 8788810 * c[1] + 4435075 * c[2]) / 24577794 / 0.950428545,
            (2613072 * c[0] + 8788810 * c[1] + 887015 * c[2]) / 12288897,
            (1425312 * c[0] + 8788810 * c[1] + 70074185 * c[2]) / 73733382 / 1.088900371};
  }
  static Triple lab(const Triple& light) {
    Triple t = xyz(light);
    for (double& v : t) v = v > std::pow(6.0 / 29, 3) ? std::cbrt(v) : v * 841 / 108 + 4.0 / 29;
    const double l = 116 * t[1] - 16;
    return {l, 5 * l * (t[0] - t[1]), 2 * l * (t[1] - t[2])};
  }
  template <class Kernel, class Value>
  double filtered(int x, int y, int radius, Kernel kernel, Value value) const {
    double sum = 0;
    for (int dy = -radius; dy <= radius; ++dy)
      for (int dx = -radius; dx <= radius; ++dx)
        sum += kernel(dx, dy) * value(std::clamp(x + dx, 0, w_ - 1), std::clamp(y + dy, 0, h_ - 1));
    return sum;
  }
  Look look(const ColorView& codes) const {
    const double ppd = kPixelsPerDegree, pi = std::numbers::pi;
    std::vector<Triple> opponent;
    for (std::size_t i = 0; i < codes.pixels(); ++i) {
      Triple light;
      for (std::size_t c = 0; c < 3; ++c) {
        const double v = static_cast<double>(codes.channel[c][i]);
        light[c] = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
      }
      const Triple t = xyz(light);
      opponent.push_back({116 * t[1] - 16, 500 * (t[0] - t[1]), 200 * (t[1] - t[2])});
    }
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd));
    const double b[3] = {0.0047, 0.0053, 0.04};
    const auto eye = [&](std::size_t c, int dx, int dy) {
      const double r2 = (dx * dx + dy * dy) / (ppd * ppd);
      if (c < 2) return std::exp(-pi * pi * r2 / b[c]);
      return 34.1 * std::sqrt(pi / 0.04) * std::exp(-pi * pi * r2 / 0.04) +
             13.5 * std::sqrt(pi / 0.025) * std::exp(-pi * pi * r2 / 0.025);
    };
    double sums[3] = {};
    for (std::size_t c = 0; c < 3; ++c)
      for (int dy = -radius; dy <= radius; ++dy)
        for (int dx = -radius; dx <= radius; ++dx) sums[c] += eye(c, dx, dy);
    const double sigma = 0.041 * ppd;
    const int reach = static_cast<int>(std::ceil(3 * sigma));
    const auto edge = [&](int dx, int dy) { return -dx * std::exp(-(dx * dx + dy * dy) / (2 * sigma * sigma)); };
    const auto point = [&](int dx, int dy) {
      return (dx * dx / (sigma * sigma) - 1) * std::exp(-(dx * dx + dy * dy) / (2 * sigma * sigma));
    };
    const auto strength = [&](auto kernel, int x, int y) {
      double positive = 0, negative = 0;
      for (int dy = -reach; dy <= reach; ++dy)
        for (int dx = -reach; dx <= reach; ++dx) (kernel(dx, dy) > 0 ? positive : negative) += std::abs(kernel(dx, dy));
      const auto balanced = [&](int dx, int dy) {
        const double k = kernel(dx, dy);
        return k / (k > 0 ? positive : negative);
      };
      const auto value = [&](int px, int py) {
        return (opponent[static_cast<std::size_t>(py * w_ + px)][0] + 16) / 116;
      };
      return std::hypot(filtered(x, y, reach, balanced, value),
                        filtered(
                            x, y, reach, [&](int dx, int dy) { return balanced(dy, dx); }, value));
    };
    Look out;
    for (int y = 0; y < h_; ++y) {
      for (int x = 0; x < w_; ++x) {
        Triple o;
        for (std::size_t c = 0; c < 3; ++c)
          o[c] = filtered(
              x, y, radius, [&](int dx, int dy) { return eye(c, dx, dy) / sums[c]; },
              [&](int px, int py) { return opponent[static_cast<std::size_t>(py * w_ + px)][c]; });
        const double n = (o[0] + 16) / 116;
        const double tx = (n + o[1] / 500) * 0.950428545, tz = (n - o[2] / 200) * 1.088900371;
        Triple light = {3.241003275 * tx - 1.537398934 * n - 0.498615861 * tz,
                        -0.969224334 * tx + 1.875930071 * n + 0.041554224 * tz,
                        0.055639423 * tx - 0.204011202 * n + 1.057148933 * tz};
        for (double& v : light) v = std::clamp(v, 0.0, 1.0);
        out.lab.push_back(lab(light));
        out.edge.push_back(strength(edge, x, y));
        out.point.push_back(strength(point, x, y));
      }
    }
    return out;
  }
};

TEST(CompareFlip, MatchesThePapersFormula) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> u(0, 1);
  const Own a(20, 14,
              [&](int x, int, int c) { return 0.1 + 0.03 * x + 0.1 * c + 0.2 * static_cast<double>(u(random)); });
  const Own b(20, 14,
              [&](int, int y, int c) { return 0.9 - 0.04 * y - 0.1 * c + 0.1 * static_cast<double>(u(random)); });
  const SlowFlip slow(a.view, b.view);
  const Map fast = flip(a.maps(), b.maps());
  for (int y = 0; y < 14; y += 3)
    for (int x = 0; x < 20; x += 2)
      EXPECT_NEAR(static_cast<double>(fast.values[static_cast<std::size_t>(y * 20 + x)]), slow.at(x, y), 2e-4);
}

TEST(CompareFlip, MatchesThePaperForBlackAndWhite) {
  // By hand: a lightness difference of 100 against the distance 203.3 of Hunt-adjusted green and blue, both to the 0.7.
  EXPECT_NEAR(flip(flat(0, 0, 0).maps(), flat(1, 1, 1).maps()).mean(), 0.9674, 5e-4);
  EXPECT_EQ(flip(flat(0.3f, 0.4f, 0.5f).maps(), flat(0.3f, 0.4f, 0.5f).maps()).mean(), 0);
}

TEST(CompareHdrFlip, TakesTheMaximumOverTheExposures) {
  // The lower half is a hundredth as bright as the upper: at the exposure for the upper half it is black.
  const auto scene = [](double dark) { return Own(24, 16, [dark](int, int y, int) { return y < 8 ? 50.0 : dark; }); };
  const Own a = scene(0.5), b = scene(0.4), c = scene(0.5);
  EXPECT_EQ(hdr_flip(a.maps(), c.maps()).mean(), 0);
  const Map map = hdr_flip(b.maps(), a.maps());
  EXPECT_GT(map.values[12 * 24 + 12], 0.04f);
  EXPECT_LT(map.values[1 * 24 + 12], 0.02f);
  // The metric is independent of the scale of radiance.
  const Own a1000(24, 16, [](int, int y, int) { return 1000 * (y < 8 ? 50.0 : 0.5); });
  const Own b1000(24, 16, [](int, int y, int) { return 1000 * (y < 8 ? 50.0 : 0.4); });
  EXPECT_NEAR(hdr_flip(b1000.maps(), a1000.maps()).mean(), map.mean(), 1e-5);
}

TEST(CompareHdrFlip, IsTheSameOnAnyNumberOfThreads) {
  const Own a(24, 16, [](int x, int y, int c) { return (x + 1) * (y + 1) * 0.1 + c; });
  const Own b(24, 16, [](int x, int y, int c) { return (x + 2) * (y + 1) * 0.1 + c; });
  EXPECT_EQ(hdr_flip(a.maps(), b.maps(), 3).values, hdr_flip(a.maps(), b.maps()).values);
}

}  // namespace
}  // namespace orrery::compare
