// SPDX-License-Identifier: Apache-2.0
#include "generate/generate_random.h"

#include <gtest/gtest.h>

#include "unit/generate/expectations.h"

namespace orrery::generate {
namespace {

using math::Vec3d;

TEST(GenerateRandom, TheEngineIsStandard) {
  // The C++ standard specifies the 10000th number of this engine at its default seed, [rand.predef].
  GenerateRandom random(5489);
  for (int i = 0; i < 9999; ++i) random.unit();
  EXPECT_EQ(random.unit(), static_cast<double>(9981545732273789042u >> 11) * 0x1p-53);
}

TEST(GenerateRandom, BallIsUniformByVolume) {
  GenerateRandom random(1);
  constexpr int kCount = 100'000;
  double sum_cube = 0;
  Vec3d sum;
  for (int i = 0; i < kCount; ++i) {
    const Vec3d p = random.in_ball();
    const double r = math::length(p);
    ASSERT_LE(r, 1.0);
    sum_cube += r * r * r;  // uniform in 0..1 if points are uniform by volume
    sum = sum + p;
  }
  expect_near_mean(sum_cube / kCount, 0.5, 1.0 / 12, kCount, "cube of the radius");
  for (const double component : {sum.x, sum.y, sum.z})
    expect_near_mean(component / kCount, 0, 0.2, kCount, "component");
}

}  // namespace
}  // namespace orrery::generate
