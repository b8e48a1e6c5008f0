// SPDX-License-Identifier: Apache-2.0
// Pearson's chi-square test of every distribution that the renderer samples, over 32 x 32 bins made equally likely by
// the distribution's inverse. The seed is fixed, so a test fails always or never.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <vector>

#include "support/chi_square.h"
#include "support/samplers.h"

namespace orrery::test {
namespace {

constexpr int kBins = 32;

std::uint32_t sample_count() {
  const char* wanted = std::getenv("ORRERY_STATISTICAL_SAMPLES");
  return wanted != nullptr ? static_cast<std::uint32_t>(std::atof(wanted)) : 20'000'000u;
}

/// Two numbers that are uniform in 0..1 and independent if the samples have the right distribution.
struct Uniforms {
  double u, v;
};

double turn_of(double x, double y) {
  const double turn = std::atan2(y, x) / (2 * std::numbers::pi);
  return turn < 0 ? turn + 1 : turn;
}

/// Cosine to the normal, and the azimuth around it in turns.
Uniforms around_normal(double x, double y, double z) {
  const double across = x * kTangent[0] + y * kTangent[1] + z * kTangent[2];
  const double other = x * kBitangent[0] + y * kBitangent[1] + z * kBitangent[2];
  return {x * kNormal[0] + y * kNormal[1] + z * kNormal[2], turn_of(across, other)};
}

Uniforms uniforms_of(Shape shape, double x, double y, double z) {
  switch (shape) {
    case Shape::kLambertian: {
      const Uniforms a = around_normal(x, y, z);
      return {a.u * a.u, a.v};  // P(cos < c) = c^2
    }
    case Shape::kHemisphere: return around_normal(x, y, z);  // P(cos < c) = c
    case Shape::kFuzzyMetal: {
      // The point n + f s, with s uniform on the unit sphere, has cosine c to n at two heights h of s:
      // f h = c^2 - 1 +- c sqrt(c^2 + f^2 - 1). Heights are uniform, so the interval between the two gives P(cos < c).
      const Uniforms a = around_normal(x, y, z);
      const double root = std::sqrt(std::max(0.0, a.u * a.u + kFuzz * kFuzz - 1));
      return {a.u * root / kFuzz, a.v};
    }
    case Shape::kDisc: return {x * x + y * y, turn_of(x, y)};  // P(radius < r) = r^2
    case Shape::kPixel: break;
  }
  return {x, y};
}

int bin_of(double u) { return std::min(kBins - 1, std::max(0, static_cast<int>(u * kBins))); }

/// Index of the bin of a pair of numbers.
std::size_t cell_of(double u, double v) {
  const int cell = bin_of(u) * kBins + bin_of(v);
  return static_cast<std::size_t>(cell);
}

/// Tests `count` samples of a shape; `bend` distorts samples on purpose.
template <class Bend>
ChiSquare test(Shape shape, Bend bend, std::uint32_t count) {
  constexpr std::uint32_t kBatch = 1 << 14;
  std::vector<double> x(kBatch), y(kBatch), z(kBatch);
  std::vector<std::uint64_t> counts(kBins * kBins);
  for (std::uint32_t first = 0; first < count; first += kBatch) {
    draw(shape, first, kBatch, x.data(), y.data(), z.data());
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      bend(x[i], y[i], z[i]);
      const Uniforms at = uniforms_of(shape, x[i], y[i], z[i]);
      ++counts[cell_of(at.u, at.v)];
    }
  }
  return chi_square_of_equal_bins(counts);
}

constexpr Shape kShapes[] = {Shape::kLambertian, Shape::kHemisphere, Shape::kFuzzyMetal, Shape::kDisc, Shape::kPixel};

TEST(StatisticalSamplers, MatchTheirDistributions) {
  for (const Shape shape : kShapes) {
    const ChiSquare result = test(
        shape, [](double&, double&, double&) {}, sample_count());
    std::printf("shape %d: chi^2 %.1f over %d bins, z %.2f\n", static_cast<int>(shape), result.statistic, kBins * kBins,
                result.z);
    EXPECT_LT(std::abs(result.z), kLargestZ) << static_cast<int>(shape);
  }
}

/// Shows that the test can fail: it detects a shift of a thousandth in every shape.
TEST(StatisticalSamplers, ShiftOfAThousandthIsDetected) {
  for (const Shape shape : kShapes) {
    const ChiSquare result = test(
        shape, [](double& x, double& y, double& z) { x += 1e-3, y += 1e-3, z += 1e-3; }, sample_count());
    EXPECT_GT(result.z, kLargestZ) << static_cast<int>(shape);
  }
}

TEST(StatisticalSamplers, WrongDistributionIsDetected) {
  // Cosine-weighted directions tested as uniform ones, and vice versa.
  std::vector<double> x(1 << 14), y(1 << 14), z(1 << 14);
  for (const auto& [drawn, judged] :
       {std::pair{Shape::kLambertian, Shape::kHemisphere}, {Shape::kHemisphere, Shape::kLambertian}}) {
    draw(drawn, 0, x.size(), x.data(), y.data(), z.data());
    std::vector<std::uint64_t> counts(kBins * kBins);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Uniforms at = uniforms_of(judged, x[i], y[i], z[i]);
      ++counts[cell_of(at.u, at.v)];
    }
    EXPECT_GT(chi_square_of_equal_bins(counts).z, kLargestZ);
  }
}

/// Neighbouring samples, lanes and pixels are independent: their pairs fill the unit square uniformly.
TEST(StatisticalSamplers, NeighboursAreIndependent) {
  std::vector<double> x(1 << 14), y(1 << 14), z(1 << 14);
  for (const std::uint32_t lag : {1u, 16u, 256u}) {  // the next sample, another lane, the next pixel
    std::vector<std::uint64_t> counts(kBins * kBins);
    for (std::uint32_t first = 0; first < sample_count() / 4; first += 1 << 14) {
      draw(Shape::kPixel, first, x.size(), x.data(), y.data(), z.data());
      for (std::size_t i = 0; i + lag < x.size(); ++i) ++counts[cell_of(x[i], x[i + lag])];
    }
    EXPECT_LT(std::abs(chi_square_of_equal_bins(counts).z), kLargestZ) << lag;
  }
}

}  // namespace
}  // namespace orrery::test
