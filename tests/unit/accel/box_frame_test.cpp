// SPDX-License-Identifier: Apache-2.0
#include "accel/box_frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace orrery::accel {
namespace {

std::vector<std::uint32_t> all(std::size_t count) {
  std::vector<std::uint32_t> ids(count);
  for (std::size_t i = 0; i < count; ++i) ids[i] = static_cast<std::uint32_t>(i);
  return ids;
}

TEST(AccelBoxFrame, BoxesContainPaddedSpheres) {
  const std::vector<kernel::Sphere> spheres = {{1, 2, 3, 0.5}, {-4, 0, 1, 2}, {0, 9, -3, 1e-6}};
  const BoxFrame frame(spheres.data(), all(3));
  for (const kernel::Sphere& s : spheres) {
    const BoxFrame::Box box = frame.box(s);
    const double center[3] = {s.x, s.y, s.z};
    double corner2 = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double at = (center[axis] - frame.middle[axis]) * frame.scale, r = s.radius * frame.scale;
      EXPECT_LE(static_cast<double>(box.lower[axis]), at - r - frame.padding);
      EXPECT_GE(static_cast<double>(box.upper[axis]), at + r + frame.padding);
      const double far =
          std::max(std::abs(static_cast<double>(box.lower[axis])), std::abs(static_cast<double>(box.upper[axis])));
      corner2 += far * far;
    }
    EXPECT_LE(std::sqrt(corner2), frame.reach);
  }
}

TEST(AccelBoxFrame, IsIndependentOfSceneScaleAndPosition) {
  const std::vector<kernel::Sphere> unit = {{1, 2, 3, 0.5}, {-4, 0, 1, 2}};
  const BoxFrame reference(unit.data(), all(2));
  for (const double factor : {0x1p-90, 0x1p-3, 0x1p50}) {
    std::vector<kernel::Sphere> scaled = unit;
    for (kernel::Sphere& s : scaled) s = {s.x * factor, s.y * factor, s.z * factor, s.radius * factor};
    const BoxFrame frame(scaled.data(), all(2));
    EXPECT_EQ(frame.scale * factor, reference.scale);
    EXPECT_EQ(frame.box(scaled[0]).lower[0], reference.box(unit[0]).lower[0]);
  }
  std::vector<kernel::Sphere> moved = unit;
  for (kernel::Sphere& s : moved) s.x += 0x1p30;
  EXPECT_EQ(BoxFrame(moved.data(), all(2)).box(moved[1]).upper[0], reference.box(unit[1]).upper[0]);
}

/// Far from the origin the box corners of a tiny sphere round to the same value; boxes must not become empty.
TEST(AccelBoxFrame, TinySpheresFarAwayHaveNonEmptyBoxes) {
  const std::vector<kernel::Sphere> spheres = {{1e9, 1e9, 1e9, 1e-12}, {1e9, 1e9, 1e9, 3e-12}};
  const BoxFrame frame(spheres.data(), all(2));
  for (const kernel::Sphere& s : spheres)
    for (int axis = 0; axis < 3; ++axis) EXPECT_LT(frame.box(s).lower[axis], frame.box(s).upper[axis]);
}

}  // namespace
}  // namespace orrery::accel
