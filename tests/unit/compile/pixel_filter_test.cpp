// SPDX-License-Identifier: Apache-2.0
#include "compile/pixel_filter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/scene.h"

namespace orrery::compile {
namespace {

scene::Render with(scene::Filter filter, std::optional<double> width = {}) {
  scene::Render render;
  render.filter = filter;
  render.filter_width = width;
  return render;
}

/// Second moment of the distribution that a table samples: its steps are equally probable and uniform.
double second_moment(const std::vector<double>& table) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < table.size(); ++i)
    sum += (table[i] * table[i] + table[i] * table[i + 1] + table[i + 1] * table[i + 1]) / 3;
  return sum / static_cast<double>(table.size() - 1);
}

TEST(CompilePixelFilter, ABoxOfWidthOneNeedsNoTable) {
  const FilterTables tables = compile_filter({});
  EXPECT_TRUE(tables.above.empty());
  EXPECT_EQ(tables.view().above, nullptr);
  EXPECT_EQ(tables.view().weight(0, 100), 100);
}

TEST(CompilePixelFilter, TablesReachFromTheCentreToTheEnd) {
  using enum scene::Filter;
  for (const auto filter : {kBox, kGaussian, kBlackmanHarris, kMitchell}) {
    const FilterTables tables = compile_filter(with(filter, 3));
    ASSERT_EQ(tables.above.size(), std::size_t{kernel::PixelFilter::kSteps} + 1);
    for (std::size_t i = 0; i + 1 < tables.above.size(); ++i) ASSERT_LE(tables.above[i], tables.above[i + 1]);
    EXPECT_EQ(tables.above.front(), 0);
    EXPECT_LE(tables.above.back(), 1.5);
    if (filter != kMitchell) {
      EXPECT_NEAR(tables.above.back(), 1.5, 1e-4);
      continue;
    }
    // The positive and negative lobes have separate tables, which touch.
    EXPECT_NEAR(tables.above.back(), tables.below.front(), 1e-4);
    EXPECT_NEAR(tables.below.back(), 1.5, 1e-4);
  }
}

/// Expected: w^2 / 12 for a box of width w; 0.97334 sigma^2 for a Gaussian truncated at three standard deviations.
TEST(CompilePixelFilter, VariancesMatchTheFormulas) {
  EXPECT_NEAR(second_moment(compile_filter(with(scene::Filter::kBox, 2.5)).above), 2.5 * 2.5 / 12, 1e-4);
  const double sigma = 3.0 / 6;
  EXPECT_NEAR(second_moment(compile_filter(with(scene::Filter::kGaussian)).above), 0.97334 * sigma * sigma, 2e-4);
}

/// Positive and negative lobes together have the moments of the polynomial.
TEST(CompilePixelFilter, MitchellsNegativeLobesHaveTheirWeight) {
  const FilterTables tables = compile_filter(with(scene::Filter::kMitchell));
  // Numerical integration of the polynomial.
  double above = 0, below = 0, moment = 0;
  for (double x = -2 + 5e-6; x < 2; x += 1e-5) {
    const double t = std::abs(x);
    const double f = t < 1 ? (7 * t * t * t - 12 * t * t + 16.0 / 3) / 6
                           : (-7.0 / 3 * t * t * t + 12 * t * t - 20 * t + 32.0 / 3) / 6;
    (f > 0 ? above : below) += std::abs(f);
    moment += f * x * x;
  }
  moment /= above - below;
  EXPECT_NEAR(tables.below_mass, below / above, 1e-6);
  const double sampled =
      (second_moment(tables.above) - tables.below_mass * second_moment(tables.below)) / (1 - tables.below_mass);
  EXPECT_NEAR(sampled, moment, 1e-3);
  // Signs: over many samples the weights sum to the integral of the product of two such filters.
  const double share = 2 * tables.below_mass / ((1 + tables.below_mass) * (1 + tables.below_mass));
  constexpr std::uint64_t kMany = 1'000'000;
  EXPECT_NEAR(static_cast<double>(tables.view().weight(0, kMany)), (1 - 2 * share) * kMany, 2);
  EXPECT_GT(tables.view().weight(0, 1), 0);
  for (std::uint64_t n = 1; n < 200; ++n) ASSERT_GT(tables.view().weight(0, n), 0) << n;
  EXPECT_EQ(tables.view().weight(0, 77) + tables.view().weight(77, 500), tables.view().weight(0, 500));
}

}  // namespace
}  // namespace orrery::compile
