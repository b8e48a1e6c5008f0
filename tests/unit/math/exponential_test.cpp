// SPDX-License-Identifier: Apache-2.0
#include "math/exponential.h"

#include <gtest/gtest.h>

#include <cmath>

namespace orrery::math {
namespace {

TEST(MathExponential, MatchesTheLongDoubleFunction) {
  EXPECT_EQ(exp_nonpositive(0), 1);
  EXPECT_EQ(exp_nonpositive(-0.0), 1);
  for (int i = 1; i <= 100000; ++i) {
    const double x = -700.0 * i / 100000 * i / 100000;
    const long double expected = std::exp(static_cast<long double>(x));
    ASSERT_NEAR(static_cast<double>(exp_nonpositive(x) / expected), 1, 1e-15) << x;
  }
}

TEST(MathExponential, StaysAtTheLimitBelowTheDomain) {
  EXPECT_EQ(exp_nonpositive(-1e300), exp_nonpositive(-700));
  EXPECT_GT(exp_nonpositive(-700), 0);
}

}  // namespace
}  // namespace orrery::math
