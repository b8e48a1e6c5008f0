// SPDX-License-Identifier: Apache-2.0
#include "compile/pixel_filter.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "kernel/camera.h"
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

TEST(CompilePixelFilter, ABoxOfWidthOneNeedsNoTable) { EXPECT_TRUE(compile_filter({}).empty()); }

TEST(CompilePixelFilter, TablesReachFromTheCentreToTheEnd) {
  using enum scene::Filter;
  for (const auto filter : {kBox, kGaussian, kBlackmanHarris}) {
    const std::vector<double> places = compile_filter(with(filter, 3));
    ASSERT_EQ(places.size(), std::size_t{kernel::PixelFilter::kSteps} + 1);
    for (std::size_t i = 0; i + 1 < places.size(); ++i) ASSERT_LE(places[i], places[i + 1]);
    EXPECT_EQ(places.front(), 0);
    EXPECT_NEAR(places.back(), 1.5, 1e-4);
  }
}

/// Expected: w^2 / 12 for a box of width w; 0.97334 sigma^2 for a Gaussian truncated at three standard deviations.
TEST(CompilePixelFilter, VariancesMatchTheFormulas) {
  EXPECT_NEAR(second_moment(compile_filter(with(scene::Filter::kBox, 2.5))), 2.5 * 2.5 / 12, 1e-4);
  const double sigma = 3.0 / 6;
  EXPECT_NEAR(second_moment(compile_filter(with(scene::Filter::kGaussian))), 0.97334 * sigma * sigma, 2e-4);
}

}  // namespace
}  // namespace orrery::compile
