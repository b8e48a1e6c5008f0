// SPDX-License-Identifier: Apache-2.0
#include "math/vec3.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace orrery::math {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(MathVec3, LeastAndGreatestAreComponentWise) {
  const Vec3d a{1, -2, 3}, b{-1, 2, 3};
  EXPECT_EQ(least(a, b), (Vec3d{-1, -2, 3}));
  EXPECT_EQ(greatest(a, b), (Vec3d{1, 2, 3}));
}

TEST(MathVec3, LeastAndGreatestKeepTheFirstComponentBesideNan) {
  EXPECT_EQ(least({1, 2, 3}, {kNan, kNan, kNan}), (Vec3d{1, 2, 3}));
  EXPECT_EQ(greatest({1, 2, 3}, {kNan, kNan, kNan}), (Vec3d{1, 2, 3}));
  EXPECT_TRUE(std::isnan(least({kNan, 0, 0}, {1, 0, 0}).x));
  EXPECT_TRUE(std::isnan(greatest({kNan, 0, 0}, {1, 0, 0}).x));
}

}  // namespace
}  // namespace orrery::math
