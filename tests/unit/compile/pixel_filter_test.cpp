// SPDX-License-Identifier: Apache-2.0
#include "compile/pixel_filter.h"

#include <gtest/gtest.h>

#include <cmath>

namespace orrery::compile {
namespace {

scene::Render with(scene::Filter filter, std::optional<double> width = {}) {
  scene::Render render;
  render.filter = filter;
  render.filter_width = width;
  return render;
}

/// The second moment of what a table samples: its steps are as probable as each other, and even inside.
double second_moment(const std::vector<double>& table) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < table.size(); ++i)
    sum += (table[i] * table[i] + table[i] * table[i + 1] + table[i + 1] * table[i + 1]) / 3;
  return sum / static_cast<double>(table.size() - 1);
}

TEST(CompilePixelFilter, ThePixelsOwnSquareNeedsNoTable) {
  const FilterTables tables = compile_filter({});
  EXPECT_TRUE(tables.above.empty());
  EXPECT_EQ(tables.view().above, nullptr);
  EXPECT_EQ(tables.view().weight(0, 100), 100);
}

TEST(CompilePixelFilter, TablesReachFromTheMiddleToTheEnd) {
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
    // Its lobes are apart, and touch.
    EXPECT_NEAR(tables.above.back(), tables.below.front(), 1e-4);
    EXPECT_NEAR(tables.below.back(), 1.5, 1e-4);
  }
}

/// Known: a box of width w has w^2 / 12; a Gaussian cut at three standard deviations 0.97334 of its own.
TEST(CompilePixelFilter, SpreadsAreThoseOfTheFormulas) {
  EXPECT_NEAR(second_moment(compile_filter(with(scene::Filter::kBox, 2.5)).above), 2.5 * 2.5 / 12, 1e-4);
  const double sigma = 3.0 / 6;
  EXPECT_NEAR(second_moment(compile_filter(with(scene::Filter::kGaussian)).above), 0.97334 * sigma * sigma, 2e-4);
}

/// The part above and the part below together come to what the polynomial comes to.
TEST(CompilePixelFilter, MitchellsNegativeLobesHaveTheirShare) {
  const FilterTables tables = compile_filter(with(scene::Filter::kMitchell));
  // By brute force over the polynomial.
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
  // Signs: of a long run of samples the weights come to what the product of two such filters integrates to.
  const double share = 2 * tables.below_mass / ((1 + tables.below_mass) * (1 + tables.below_mass));
  constexpr std::uint64_t kMany = 1'000'000;
  EXPECT_NEAR(static_cast<double>(tables.view().weight(0, kMany)), (1 - 2 * share) * kMany, 2);
  EXPECT_GT(tables.view().weight(0, 1), 0);
  for (std::uint64_t n = 1; n < 200; ++n) ASSERT_GT(tables.view().weight(0, n), 0) << n;
  EXPECT_EQ(tables.view().weight(0, 77) + tables.view().weight(77, 500), tables.view().weight(0, 500));
}

}  // namespace
}  // namespace orrery::compile
