// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "annotation/legend.h"

namespace orrery::annotation {
namespace {

std::string labels(double first, double last) {
  std::string out;
  for (const Tick& tick : nice_ticks(first, last)) out += (out.empty() ? "" : " ") + tick.label;
  return out;
}

TEST(AnnotationTicks, AreAtRoundNumbers) {
  EXPECT_EQ(labels(0, 12), "0 2 4 6 8 10 12");
  EXPECT_EQ(labels(-2, 2), "-2.0 -1.5 -1.0 -0.5 0.0 0.5 1.0 1.5 2.0");
  EXPECT_EQ(labels(0.013, 0.087), "0.02 0.03 0.04 0.05 0.06 0.07 0.08");
  EXPECT_EQ(labels(0, 1), "0.0 0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8 0.9 1.0");
  EXPECT_EQ(labels(3, 997), "100 200 300 400 500 600 700 800 900");
  EXPECT_EQ(labels(273.15, 274.95), "273.2 273.4 273.6 273.8 274.0 274.2 274.4 274.6 274.8");
}

std::string log_labels(double first, double last) {
  const points::ValueScale scale(first, last, true);
  std::string out;
  double share = -1;
  for (const Tick& tick : ticks_of(scale)) {
    out += (out.empty() ? "" : " ") + tick.label;
    EXPECT_GT(scale.share_of(tick.value), share);
    share = scale.share_of(tick.value);
  }
  return out;
}

TEST(AnnotationTicks, LogarithmicBarsHaveDecades) {
  EXPECT_EQ(log_labels(1e-3, 1e4), "0.001 0.01 0.1 1 10 100 1000 10000");
  EXPECT_EQ(log_labels(0.3, 40), "0.5 1 2 5 10 20");
  EXPECT_EQ(log_labels(1e-20, 1e12), "1e-20 1e-16 1e-12 1e-08 1e-04 1 10000 1e08 1e12");
  EXPECT_EQ(log_labels(3, 7), "3.0 3.5 4.0 4.5 5.0 5.5 6.0 6.5 7.0") << "less than a decade";
}

TEST(AnnotationTicks, LargeAndSmallNumbersHaveExponents) {
  EXPECT_EQ(labels(0, 3e7), "0 0.5e7 1.0e7 1.5e7 2.0e7 2.5e7 3.0e7");
  EXPECT_EQ(labels(-1e-9, 1e-9), "-1.0e-9 -0.8e-9 -0.6e-9 -0.4e-9 -0.2e-9 0 0.2e-9 0.4e-9 0.6e-9 0.8e-9 1.0e-9");
  EXPECT_EQ(labels(1.9e100, 2.4e100),
            "1.90e100 1.95e100 2.00e100 2.05e100 2.10e100 2.15e100 2.20e100 2.25e100 2.30e100 2.35e100 2.40e100");
}

TEST(AnnotationTicks, OneTickIfNothingCanBeDistinguished) {
  EXPECT_EQ(labels(3.5, 3.5), "3.5");
  EXPECT_EQ(labels(0, 0), "0");
  EXPECT_EQ(labels(1, std::nextafter(1, 2)), "1");
  EXPECT_EQ(labels(1e300, 1e300), "1e300");
  EXPECT_EQ(labels(0, 2e-310), "0");
}

TEST(AnnotationTicks, RangesThatOverflowHaveTheirEnds) {
  const std::vector<Tick> ticks = nice_ticks(1e308, -1e308);
  ASSERT_EQ(ticks.size(), 2u);
  EXPECT_EQ(ticks[0].value, -1e308);
  EXPECT_EQ(ticks[0].label, "-1e308");
  EXPECT_EQ(ticks[1].label, "1e308");
}

TEST(AnnotationTicks, AnyRangeHasAFewTicksInside) {
  std::mt19937_64 engine(18);
  std::uniform_real_distribution<double> uniform(-1, 1), exponent(-285, 290);
  for (int i = 0; i < 20'000; ++i) {
    const double size = std::pow(10, exponent(engine));
    const double a = size * uniform(engine), b = size * uniform(engine);
    const std::vector<Tick> ticks = nice_ticks(a, b);
    ASSERT_GE(ticks.size(), 4u) << a << ' ' << b;
    ASSERT_LE(ticks.size(), 11u) << a << ' ' << b;
    const double slack = 1e-8 * std::abs(a - b);
    EXPECT_GE(ticks.front().value, std::min(a, b) - slack);
    EXPECT_LE(ticks.back().value, std::max(a, b) + slack);
    for (std::size_t k = 0; k < ticks.size(); ++k) {
      EXPECT_NEAR(std::stod(ticks[k].label), ticks[k].value, slack) << ticks[k].label;
      EXPECT_LT(ticks[k].label.size(), 16u) << ticks[k].label;
      if (k > 0) {
        EXPECT_GT(ticks[k].value, ticks[k - 1].value);
        EXPECT_NE(ticks[k].label, ticks[k - 1].label);
      }
    }
  }
}

}  // namespace
}  // namespace orrery::annotation
