// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "base/error.h"
#include "points/sources.h"
#include "points_file.h"

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
  EXPECT_EQ(load(), "warning points[0].labels[1]: `kind == 2: B` matches none of the particles that are drawn\n");
  ASSERT_EQ(points.placed_labels.size(), 1u);
  EXPECT_EQ(points.placed_labels[0].at, (math::Vec3d{4, 2, 0}));
}

TEST(PointsEndOfExpression, IsTheFirstColonOutsideQuotesAndBrackets) {
  EXPECT_EQ(end_of_expression("x: a: b"), 1u);
  EXPECT_EQ(end_of_expression("name == \"a: b\": X"), 14u);
  EXPECT_EQ(end_of_expression("name == \"O5'\":X"), 13u);
  EXPECT_EQ(end_of_expression("x in [1:2, 5:]: X"), 14u);
  EXPECT_EQ(end_of_expression("name in {a:, b}: X"), 15u);
  EXPECT_EQ(end_of_expression("`points:0` > 1: X"), 14u);
  EXPECT_EQ(end_of_expression("step * 2"), std::string_view::npos);
  EXPECT_EQ(end_of_expression("name == \"a: b"), std::string_view::npos);
}

TEST_F(PointsLabels, InvalidOnesAreErrors) {
  points.labels = {"kind == 1", "x >: A", "y == \"a: b", ": A", "x == 1: "};
  const std::string text = load();
  for (const char* part : {"labels[0]: `kind == 1` is not a label", "labels[1]: at character",
                           "labels[2]: `y == \"a: b`", "labels[3]: `: A`", "labels[4]: `x == 1: `"})
    EXPECT_NE(text.find(part), std::string::npos) << part << '\n' << text;
}

}  // namespace
}  // namespace orrery::points
