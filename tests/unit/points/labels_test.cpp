// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "base/error.h"
#include "points/sources.h"
#include "points_file.h"
#include "support/mentions.h"

namespace orrery::points {
namespace {

class PointsLabels : public PointsFile {
 protected:
  PointsLabels() {
    points.radius.value = 1;
    write("a.csv", "x,y,z,kind\n0,0,0,1\n4,2,0,1\n9,9,9,2\n");
  }
};

TEST_F(PointsLabels, AreInTheMiddleOfTheirParticles) {
  points.labels = {"kind == 1: Pair: A", "z in [5:10]: B"};
  points.transform.scale = 2;
  EXPECT_EQ(load(), "");
  ASSERT_EQ(points.placed_labels.size(), 2u);
  EXPECT_EQ(points.placed_labels[0].at, (math::Vec3d{4, 2, 0}));
  EXPECT_EQ(points.placed_labels[0].text, "Pair: A");
  EXPECT_EQ(points.placed_labels[1].at, (math::Vec3d{18, 18, 18}));
  EXPECT_EQ(points.placed_labels[1].text, "B");
}

TEST_F(PointsLabels, OnlyParticlesThatAreDrawnCount) {
  points.labels = {"kind == 1: A", "kind == 2: B"};
  points.select = "x > 1 && kind == 1";
  EXPECT_TRUE(test::mentions(load(), {"warning points[0].labels[1]", "`kind == 2: B`", "none"}));
  ASSERT_EQ(points.placed_labels.size(), 1u);
  EXPECT_EQ(points.placed_labels[0].at, (math::Vec3d{4, 2, 0}));
}

TEST_F(PointsLabels, InvalidOnesAreErrors) {
  points.labels = {"x >: A", "y == \"a: b", ": A", "x == 1: ", "kind == 1"};
  const std::string text = load();
  for (const char* part : {"labels[0]: at character", "labels[1]: `y == \"a: b`", "labels[2]: `: A`",
                           "labels[3]: a label has no text", "labels[4]: `kind == 1` has no condition"})
    EXPECT_NE(text.find(part), std::string::npos) << part << '\n' << text;
}

}  // namespace
}  // namespace orrery::points
