// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/error.h"
#include "points/sources.h"
#include "points_file.h"
#include "scene/scene.h"
#include "support/mentions.h"

namespace orrery::points {
namespace {

using Opacities = std::vector<float>;
constexpr float kMaterial = -1;

class PointsPointOpacity : public PointsFile {
 protected:
  PointsPointOpacity() {
    write("a.xyz",
          "5\nProperties=pos:R:3:type:I:1:w:R:1\n0 0 0 1 0.1\n1 0 0 2 0.2\n2 0 0 2 1\n3 0 0 3 0\n4 0 0 3 0.5\n");
    points.radius.value = 0.1;
  }
};

TEST_F(PointsPointOpacity, NoneAndOneNumberNeedNoArray) {
  EXPECT_EQ(load(), "");
  EXPECT_TRUE(points.opacities.empty());
  points.opacity.value = 0.4;
  EXPECT_EQ(load(), "");
  EXPECT_TRUE(points.opacities.empty());
}

TEST_F(PointsPointOpacity, AConditionThatMatchesNothingIsAWarning) {
  points.opacity.where = {"type == 2: 0.2", "x > 99: 0.7"};
  EXPECT_TRUE(test::mentions(load(), {"points[0].opacity.where[1]", "`x > 99: 0.7`", "particles"}));
  EXPECT_EQ(points.opacities, (Opacities{kMaterial, 0.2F, 0.2F, kMaterial, kMaterial}));
}

TEST_F(PointsPointOpacity, TheLastConditionThatMatchesDecides) {
  points.opacity.where = {"type == 2: 0.2", "x >= 2 && x < 4 : 0.7"};
  EXPECT_EQ(load(), "");
  EXPECT_EQ(points.opacities, (Opacities{kMaterial, 0.2F, 0.7F, 0.7F, kMaterial}));
  points.opacity.where = {"x in [2:3]: 0.7", "type in [2]: 0.2"};
  points.opacity.where.insert(points.opacity.where.begin(), "0.5");
  EXPECT_EQ(load(), "");
  EXPECT_EQ(points.opacities, (Opacities{0.5F, 0.2F, 0.2F, 0.7F, 0.5F}));
}

TEST_F(PointsPointOpacity, TypesThatAreNotListedHaveThatOfTheMaterial) {
  points.opacity.types = {{"2", 0.25}, {"7", 0}};
  points.opacity.where = {"x == 2: 1"};
  EXPECT_EQ(load(), "");
  EXPECT_EQ(points.opacities, (Opacities{kMaterial, 0.25F, 1, kMaterial, kMaterial}));
}

TEST_F(PointsPointOpacity, AColumnHasOpacities) {
  points.opacity.column = "w";
  EXPECT_EQ(load(), "");
  EXPECT_EQ(points.opacities, (Opacities{0.1F, 0.2F, 1, 0, 0.5F}));
}

TEST_F(PointsPointOpacity, FollowsSelectionsCopiesAndClips) {
  write("box.xyz", "2\nLattice=\"5 0 0 0 5 0 0 0 5\" Properties=pos:R:3:w:R:1\n1 0 0 0.1\n2 0 0 0.2\n");
  points.opacity.column = "w";
  points.replicate = {2, 1, 1};
  EXPECT_EQ(load(), "");
  EXPECT_EQ(points.opacities, (Opacities{0.1F, 0.2F, 0.1F, 0.2F}));
  points.clip[0] = scene::Interval{1.5, 6.5};
  EXPECT_EQ(load(), "");
  EXPECT_EQ(points.opacities, (Opacities{0.2F, 0.1F}));
  points.clip[0] = {};
  points.select = "w > 0.15";
  EXPECT_EQ(load(), "");
  EXPECT_EQ(points.opacities, (Opacities{0.2F, 0.2F}));
}

TEST_F(PointsPointOpacity, ReportsValuesOutsideTheRangeWithTheirRows) {
  write("bad.xyz", "3\nProperties=pos:R:3:w:R:1\n0 0 0 0.5\n1 0 0 nan\n2 0 0 1.5\n");
  points.opacity.column = "w";
  EXPECT_EQ(load(),
            "error points[0].opacity.column: row 2 of bad.xyz has opacity nan in column `w`; must be in 0..1\n"
            "error points[0].opacity.column: row 3 of bad.xyz has opacity 1.5 in column `w`; must be in 0..1\n"
            "error points[0].opacity.column: 2 of 3 rows have opacities outside 0..1; leave them out with `select`, or "
            "set others, e.g. `where = [\"!(w >= 0 && w <= 1): 1\"]`\n");
  points.opacity.where = {"!(w >= 0 && w <= 1): 1"};
  EXPECT_EQ(load(), "") << "the remedy that the message names";
  EXPECT_EQ(points.opacities, (Opacities{0.5F, 1, 1}));
}

TEST_F(PointsPointOpacity, ReportsFaultyKeys) {
  points.opacity.column = "weight";
  points.opacity.where = {"type = 2: 0.2", "type == 2"};
  const std::string text = load();
  EXPECT_TRUE(test::mentions(text, {"points[0].opacity.column", "`weight`"}));
  EXPECT_NE(text.find("error points[0].opacity.where[0]: at character 6:"), std::string::npos) << text;
  EXPECT_NE(text.find("error points[0].opacity.where[1]: `type == 2` is not an opacity"), std::string::npos) << text;
  points.opacity = {};
  points.opacity.column = "w";
  points.opacity.types = {{"1", 0.5}};
  EXPECT_TRUE(test::mentions(load(), {"points[0].opacity", "`column`", "`type`"}));
}

}  // namespace
}  // namespace orrery::points
