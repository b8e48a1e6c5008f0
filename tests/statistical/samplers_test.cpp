// SPDX-License-Identifier: Apache-2.0
// Every distribution that the renderer samples, against the distribution that it should have: Pearson's test over
// 32 x 32 bins that are equally likely by the distribution's own inverse. Fixed seed, so it fails always or never.
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

/// Two numbers that are uniform in 0..1 and independent where the sample is as it should be.
struct Uniforms {
  double u, v;
};

double turn_of(double x, double y) {
  const double turn = std::atan2(y, x) / (2 * std::numbers::pi);
  return turn < 0 ? turn + 1 : turn;
}

/// Cosine to the normal, and the turn around it.
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
      // The tip n + f s, with s uniform over the unit sphere, is seen under the cosine c from two heights h of s:
      // f h = c^2 - 1 +- c sqrt(c^2 + f^2 - 1). Heights are uniform, so what lies between the two is P(cos < c).
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

/// Counts of a million samples at a time; `bend` deforms samples on purpose.
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
      ++counts[static_cast<std::size_t>(bin_of(at.u) * kBins + bin_of(at.v))];
    }
  }
  return chi_square_of_equal_bins(counts);
}

constexpr Shape kShapes[] = {Shape::kLambertian, Shape::kHemisphere, Shape::kFuzzyMetal, Shape::kDisc, Shape::kPixel};

TEST(StatisticalSamplers, HaveTheirDistributions) {
  for (const Shape shape : kShapes) {
    const ChiSquare result = test(
        shape, [](double&, double&, double&) {}, sample_count());
    std::printf("shape %d: chi^2 %.1f over %d bins, z %.2f\n", static_cast<int>(shape), result.statistic, kBins * kBins,
                result.z);
    EXPECT_LT(std::abs(result.z), kLargestZ) << static_cast<int>(shape);
  }
}

/// The judge can condemn: a shift of a thousandth is found in every shape.
TEST(StatisticalSamplers, AShiftOfAThousandthIsFound) {
  for (const Shape shape : kShapes) {
    const ChiSquare result = test(
        shape, [](double& x, double& y, double& z) { x += 1e-3, y += 1e-3, z += 1e-3; }, sample_count());
    EXPECT_GT(result.z, kLargestZ) << static_cast<int>(shape);
  }
}

TEST(StatisticalSamplers, OneDistributionIsNotTakenForAnother) {
  // Cosine-weighted directions judged as uniform ones, and the other way round.
  std::vector<double> x(1 << 14), y(1 << 14), z(1 << 14);
  for (const auto& [drawn, judged] :
       {std::pair{Shape::kLambertian, Shape::kHemisphere}, {Shape::kHemisphere, Shape::kLambertian}}) {
    draw(drawn, 0, x.size(), x.data(), y.data(), z.data());
    std::vector<std::uint64_t> counts(kBins * kBins);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Uniforms at = uniforms_of(judged, x[i], y[i], z[i]);
      ++counts[static_cast<std::size_t>(bin_of(at.u) * kBins + bin_of(at.v))];
    }
    EXPECT_GT(chi_square_of_equal_bins(counts).z, kLargestZ);
  }
}

/// Neighbouring samples, pixels and dimensions must know nothing of each other: pairs fill the unit square.
TEST(StatisticalSamplers, NeighboursAreIndependent) {
  std::vector<double> x(1 << 14), y(1 << 14), z(1 << 14);
  for (const std::uint32_t lag : {1u, 16u, 256u}) {  // the next sample, another lane, the next pixel
    std::vector<std::uint64_t> counts(kBins * kBins);
    for (std::uint32_t first = 0; first < sample_count() / 4; first += 1 << 14) {
      draw(Shape::kPixel, first, x.size(), x.data(), y.data(), z.data());
      for (std::size_t i = 0; i + lag < x.size(); ++i)
        ++counts[static_cast<std::size_t>(bin_of(x[i]) * kBins + bin_of(x[i + lag]))];
    }
    EXPECT_LT(std::abs(chi_square_of_equal_bins(counts).z), kLargestZ) << lag;
  }
}

}  // namespace
}  // namespace orrery::test
