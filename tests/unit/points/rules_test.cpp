// SPDX-License-Identifier: Apache-2.0
#include "points/rules.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "points/color_map.h"
#include "points_file.h"
#include "support/mentions.h"

namespace orrery::points {
namespace {

using math::Vec3d;

TEST(PointsRules, ExpressionsEndAtTheFirstColonOutsideQuotesAndBrackets) {
  EXPECT_EQ(end_of_expression("x: a: b"), 1u);
  EXPECT_EQ(end_of_expression("name == \"a: b\": X"), 14u);
  EXPECT_EQ(end_of_expression("name == \"O5'\":X"), 13u);
  EXPECT_EQ(end_of_expression("x in [1:2, 5:]: X"), 14u);
  EXPECT_EQ(end_of_expression("name in {a:, b}: X"), 15u);
  EXPECT_EQ(end_of_expression("`points:0` > 1: X"), 14u);
  EXPECT_EQ(end_of_expression("step * 2"), std::string_view::npos);
  EXPECT_EQ(end_of_expression("name == \"a: b"), std::string_view::npos);
}

TEST(PointsRules, AreSplitAtTheColon) {
  EXPECT_EQ(split_rule(" x in [1:2] : 0.25 "), (std::pair<std::string, std::string>("x in [1:2]", "0.25")));
  EXPECT_EQ(split_rule(" 0.25"), (std::pair<std::string, std::string>("", "0.25")));
  EXPECT_EQ(split_rule("resid 2:5: red"), (std::pair<std::string, std::string>("resid 2:5", "red")))
      << "values have no colons";
  EXPECT_EQ(split_rule("id 5: a: b", Colon::kFirst), (std::pair<std::string, std::string>("id 5", "a: b")));
  EXPECT_THROW(split_rule(": 1"), base::Error);
}

TEST(PointsRules, ValuesAreChecked) {
  EXPECT_EQ(parse_opacity("0.25"), 0.25F);
  EXPECT_EQ(parse_radius("2"), 2.0);
  EXPECT_EQ(parse_representation("ball-and-stick"), Representation::kBallAndStick);
  EXPECT_EQ(parse_color("#f00"), (Vec3d{1, 0, 0}));
  for (const char* text : {"", "1.1", "-1", "nan", "x"}) EXPECT_THROW(parse_opacity(text), base::Error) << text;
  for (const char* text : {"", "0", "-1", "inf", "x"}) EXPECT_THROW(parse_radius(text), base::Error) << text;
  for (const char* text : {"", "stick"}) EXPECT_THROW(parse_representation(text), base::Error) << text;
}

class PointsRulesOfAFile : public PointsFile {
 protected:
  PointsRulesOfAFile() {
    write("a.csv", "x,y,z,type,q\n0,0,0,1,0\n1,0,0,2,1\n2,0,0,2,2\n3,0,0,3,nan\n");
    points.radius.value = 0.5;
  }
};

TEST_F(PointsRulesOfAFile, TheLastThatMatchesDecidesTheRadius) {
  points.radius.where = {"type == 2: 2", "x > 1: 3"};
  EXPECT_EQ(load(), "");
  EXPECT_EQ(points.radii, (std::vector<double>{0.5, 2, 3, 3}));
}

TEST_F(PointsRulesOfAFile, ColorsPrecedeThoseOfAMap) {
  points.color.where = {"type == 2: blue", "x == 2: #f00"};
  EXPECT_EQ(load(), "");
  EXPECT_EQ(color(0), (Vec3d{0.8, 0.8, 0.8})) << "of the others, without another colour";
  EXPECT_EQ(color(1), (Vec3d{0, 0, 1}));
  EXPECT_EQ(color(2), (Vec3d{1, 0, 0}));
  points.color.column = "q";
  points.color.nan_color = {0.1, 0.2, 0.3};
  points.color.where = {"x == 1: #f00"};
  EXPECT_EQ(load(), "");
  EXPECT_EQ(color(1), (Vec3d{1, 0, 0}));
  EXPECT_EQ(color(2), palette(*find_color_map("viridis"), 2)[1]) << "others keep the map";
  EXPECT_EQ(color(3), (Vec3d{0.1, 0.2, 0.3}));
  EXPECT_EQ(points.palette.back(), points.color.nan_color) << "which is the last";
  EXPECT_EQ(points.palette_rec709, 257u) << "the map and the rule";
  points.color.column = "type";
  points.color.map = "set2";
  EXPECT_EQ(load(), "");
  EXPECT_EQ(color(1), (Vec3d{1, 0, 0}));
  EXPECT_EQ(color(3), palette(*find_color_map("set2"), 3)[2]);
  EXPECT_EQ(points.color_names, (std::vector<std::string>{"1", "2", "3", ""}));
}

TEST_F(PointsRulesOfAFile, MaterialsPrecedeThatOfTheTable) {
  const std::vector<scene::Material> materials = {{"matte", {}}, {"plastic", {}}, {"glass", {}}};
  request.materials = &materials;
  points.material = 1;
  points.material_where = {"type == 2: matte", "x > 1: glass", "q == 9: matte"};
  EXPECT_TRUE(test::mentions(load(), {"warning", "material_where[2]", "q == 9: matte"}));
  EXPECT_EQ(points.materials, (std::vector<std::uint32_t>{1, 0, 2, 2}));
  points.material_where = {"x > 1: steel"};
  EXPECT_TRUE(test::mentions(load(), {"error points[0].material_where[0]", "steel", "one of matte, plastic, glass"}));
}

TEST_F(PointsRulesOfAFile, ThatMatchNothingAreWarningsAndInvalidOnesErrors) {
  points.color.where = {"type == 9: red"};
  EXPECT_TRUE(test::mentions(load(), {"warning", "color.where[0]", "type == 9: red"}));
  points.color.where = {"type == 2: reddish"};
  points.radius.where = {"typ == 2: 1"};
  points.representation = {"type == 2: cartoon"};
  EXPECT_TRUE(test::mentions(load(), {"error points[0].radius.where[0]", "error points[0].color.where[0]", "reddish",
                                      "error points[0].representation[0]", "cartoon"}));
}

}  // namespace
}  // namespace orrery::points
