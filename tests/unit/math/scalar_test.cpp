// SPDX-License-Identifier: Apache-2.0
#include "math/scalar.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace orrery::math {
namespace {

TEST(MathScalar, ExponentialMatchesTheLongDoubleFunction) {
  EXPECT_EQ(exp_nonpositive(0), 1);
  EXPECT_EQ(exp_nonpositive(-0.0), 1);
  for (int i = 1; i <= 100000; ++i) {
    const double x = -700.0 * i / 100000 * i / 100000;
    const long double expected = std::exp(static_cast<long double>(x));
    ASSERT_NEAR(static_cast<double>(exp_nonpositive(x) / expected), 1, 1e-15) << x;
  }
}

TEST(MathScalar, ExponentialStaysAtTheLimitBelowTheDomain) {
  EXPECT_EQ(exp_nonpositive(-1e300), exp_nonpositive(-700));
  EXPECT_GT(exp_nonpositive(-700), 0);
}

struct Numbers {
  double x, y, z, w;
};

TEST(MathScalar, RoundsAllNumbersOfALoop) {
  for (int count = 1; count < 20; ++count) {
    std::vector<Numbers> numbers;
    for (int i = 0; i < count; ++i) numbers.push_back({i + 0.1, i + 0.2, i + 0.3, i + 0.4});
    for (Numbers& n : numbers) n = {in_single_precision(n.x), in_single_precision(n.y), in_single_precision(n.z), n.w};
    for (int i = 0; i < count; ++i) {
      const Numbers& n = numbers[static_cast<std::size_t>(i)];
      volatile float x = static_cast<float>(i + 0.1), y = static_cast<float>(i + 0.2), z = static_cast<float>(i + 0.3);
      EXPECT_EQ(n.x, static_cast<double>(x));
      EXPECT_EQ(n.y, static_cast<double>(y));
      EXPECT_EQ(n.z, static_cast<double>(z));
      EXPECT_EQ(n.w, i + 0.4);
    }
  }
}

}  // namespace
}  // namespace orrery::math
