// SPDX-License-Identifier: Apache-2.0
#include "points/sources.h"

#include <gtest/gtest.h>

namespace orrery::points {
namespace {

TEST(PointsReadMemory, CopiesOfAssembliesAreInSinglePrecision) {
  data::FrameInfo info;
  info.roles.position = {"x", "y", "z"};
  scene::Points assembly;
  assembly.assembly = "1";
  EXPECT_EQ(bytes_per_sphere(info, {}, RadiusSource(), false), 3 * sizeof(double));
  EXPECT_EQ(bytes_per_sphere(info, assembly, RadiusSource(), true), 3 * sizeof(float));
  EXPECT_EQ(bytes_per_sphere(info, assembly, RadiusSource(), false), 3 * sizeof(double));
}

}  // namespace
}  // namespace orrery::points
