// SPDX-License-Identifier: Apache-2.0
#include "accel/sphere_codes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace orrery::accel {
namespace {

TEST(AccelSphereCodes, DecodedBoundsEncloseTheBounds) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (int trial = 0; trial < 2000; ++trial) {
    const float scale = std::exp2(20 * uniform(random));
    std::vector<Bounds> children(1 + random() % kArity);
    for (Bounds& child : children) {
      for (int corner = 0; corner < 2; ++corner) {
        const float at[3] = {scale * uniform(random), scale * uniform(random), scale * uniform(random)};
        child.add(at, at);
      }
    }
    const SphereBvh::Node node = make_node(children, 7);
    EXPECT_EQ(node.first, 7u);
    ASSERT_EQ(node.count, children.size());
    for (std::size_t i = 0; i < children.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        const auto decoded = [&](int side) {
          return std::fma(static_cast<float>(node.bound[side][axis][i]), node.step[axis], node.origin[axis]);
        };
        ASSERT_LE(decoded(0), children[i].lower[axis]);
        ASSERT_GE(decoded(1), children[i].upper[axis]);
      }
    }
  }
}

TEST(AccelSphereCodes, StepsReachTheUpperBound) {
  for (const float upper : {1.0F, 3.0F, 1e-38F, 0x1.fffffep20F}) {
    const float step = step_between(-0.7F * upper, upper);
    EXPECT_GE(std::fma(255.0F, step, -0.7F * upper), upper);
    EXPECT_LT(step, 1.71F * upper / 255 + 1e-37F);
    EXPECT_EQ(code_above(-0.7F * upper, -0.7F * upper, step), 0);
  }
}

}  // namespace
}  // namespace orrery::accel
