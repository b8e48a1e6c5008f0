// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "points/sources.h"
#include "points_file.h"
#include "scene/number_array.h"
#include "scene/scene.h"
#include "support/mentions.h"

namespace orrery::points {
namespace {

using Kind = RadiusSource::Kind;
using Radii = scene::NumberArray;

/// A file with columns of all roles.
data::FrameInfo atoms() {
  data::FrameInfo info;
  info.columns = {{"x"}, {"diameter"}, {"element", data::ColumnType::kText}, {"type", data::ColumnType::kInt64}};
  info.roles.radius = "diameter";
  info.roles.radius_scale = 0.5;
  info.roles.element = "element";
  info.roles.type = "type";
  return info;
}
data::Table table() {
  data::Table out;
  out.rows = 3;
  out.columns = {{"diameter", std::vector<float>{1, 2, 4}},
                 {"element", data::Words{{"O", "H", "Qq"}, {0, 1, 2}}},
                 {"type", std::vector<std::int64_t>{2, 1, 12}}};
  return out;
}

/// Radii of the listed rows, and diagnostics if there are any.
Radii radii(const scene::PointsRadius& keys, std::vector<std::uint32_t> rows, std::string* diagnostics = nullptr) {
  KeyFaults faults("points[0]");
  const RadiusSource source = radius_source(atoms(), keys, faults);
  const Radii out = radii_of(table(), Rows(std::move(rows)), source, keys, faults);
  const std::string text = text_of(faults);
  if (diagnostics != nullptr)
    *diagnostics = text;
  else
    EXPECT_EQ(text, "");
  return out;
}

std::string fault(const data::FrameInfo& info, const scene::PointsRadius& keys) {
  KeyFaults faults("points[0]");
  radius_source(info, keys, faults);
  return text_of(faults);
}

TEST(PointsPointRadii, ADiameterOfTheFileIsHalvedOnce) {
  EXPECT_EQ(radii({}, {0, 1, 2}), (Radii{0.5, 1, 2}));
  scene::PointsRadius keys;
  keys.scale = 3;
  EXPECT_EQ(radii(keys, {2}), Radii{6}) << "the scale multiplies the radius";
}

TEST(PointsPointRadii, AColumnIsScaledByTheKeyAlone) {
  scene::PointsRadius keys;
  keys.column = "diameter";
  std::string warning;
  EXPECT_EQ(radii(keys, {0, 2}, &warning), (Radii{1, 4})) << "a named column contains radii, whatever its name";
  EXPECT_TRUE(test::mentions(warning, {"points[0].radius.column", "`diameter`", "0.5"}));
  keys.scale = 0.5;
  EXPECT_EQ(radii(keys, {0, 2}), (Radii{0.5, 2}));
}

TEST(PointsPointRadii, ANumberOverridesTheFile) {
  scene::PointsRadius keys;
  keys.value = 0.75;
  keys.scale = 2;
  EXPECT_EQ(radii(keys, {2, 0}), (Radii{0.75, 0.75}));
}

TEST(PointsPointRadii, Elements) {
  scene::PointsRadius keys;
  keys.element = "vdw";
  EXPECT_EQ(radii(keys, {1, 0}), (Radii{1.20, 1.52}));
  keys.element = "covalent";
  EXPECT_EQ(radii(keys, {1, 0}), (Radii{0.31, 0.66}));
  keys.element = "ball";
  keys.scale = 2;
  EXPECT_EQ(radii(keys, {0}), Radii{2 * 0.25 * 1.52});
}

TEST(PointsPointRadii, UnknownElementsOfTheRowsAreReported) {
  scene::PointsRadius keys;
  keys.element = "vdw";
  std::string text;
  radii(keys, {0, 2}, &text);
  EXPECT_TRUE(test::mentions(text, {"points[0].radius.element", "`Qq`", "`element`", "`select`"}));
}

TEST(PointsPointRadii, Types) {
  scene::PointsRadius keys;
  keys.types = {{"1", 0.5}, {"12", 0.25}, {"2", 1.5}, {"99", 1}};
  EXPECT_EQ(radii(keys, {0, 1, 2}), (Radii{1.5, 0.5, 0.25}));
}

TEST(PointsPointRadii, TypesWithoutARadiusAreReportedTogether) {
  scene::PointsRadius keys;
  keys.types = {{"1", 0.5}};
  std::string text;
  radii(keys, {0, 1, 2}, &text);
  EXPECT_TRUE(test::mentions(text, {"points[0].radius.type", "`2`", "`12`", "`type = { 12 = 0.5 }`"}));
  EXPECT_EQ(radii(keys, {1}), Radii{0.5}) << "types of other rows do not matter";
}

TEST(PointsPointRadii, ManyTypesWithoutARadiusAreShortened) {
  data::Table many;
  many.rows = 12;
  many.columns = {{"type", std::vector<double>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}}};
  scene::PointsRadius keys;
  keys.types = {{"0", 1}};
  KeyFaults faults("points[0]");
  radii_of(many, Rows(12), radius_source(atoms(), keys, faults), keys, faults);
  const std::string text = text_of(faults);
  EXPECT_NE(text.find("`9`, `10` ... has no radius"), std::string::npos) << text;
}

TEST(PointsPointRadii, AColumnOfManyValuesHasNoTypes) {
  data::Table many;
  many.rows = 65'537;
  std::vector<double> values(many.rows);
  for (std::size_t i = 0; i < many.rows; ++i) values[i] = static_cast<double>(i);
  many.columns = {{"type", std::move(values)}};
  scene::PointsRadius keys;
  keys.types = {{"0", 1}};
  KeyFaults faults("points[0]");
  radii_of(many, Rows(many.rows), radius_source(atoms(), keys, faults), keys, faults);
  EXPECT_TRUE(test::mentions(text_of(faults), {"points[0].radius", "`type`", "65536"}));
}

TEST(PointsPointRadii, MissingColumnsAreReportedWithThoseThatExist) {
  data::FrameInfo info;
  info.columns = {{"x"}, {"siz"}, {"name", data::ColumnType::kText}};
  EXPECT_TRUE(test::mentions(fault(info, {}),
                             {"points[0].radius", "`radius`", "`radius = { column = \"size\", scale = 0.5 }`"}));
  scene::PointsRadius keys;
  keys.column = "size";
  EXPECT_TRUE(test::mentions(fault(info, keys), {"points[0].radius.column", "`size`", "`siz`"}));
  keys.column = "name";
  EXPECT_TRUE(test::mentions(fault(info, keys), {"points[0].radius.column", "column", "`name`"}));
  keys = {};
  keys.element = "vdw";
  EXPECT_TRUE(test::mentions(fault(info, keys), {"points[0].radius.element", "chemical", "elements"}));
  keys = {};
  keys.types = {{"1", 1}};
  EXPECT_TRUE(test::mentions(fault(info, keys), {"points[0].radius.type", "particle", "columns"}));
}

TEST(PointsPointRadii, AlternativesExcludeEachOther) {
  scene::PointsRadius keys;
  keys.value = 1;
  keys.element = "vdw";
  const std::string expected = "error points[0].radius: only one of `column`, `element` and `type` can be set\n";
  EXPECT_EQ(fault(atoms(), keys), expected);
  keys.value.reset();
  keys.column = "x";
  EXPECT_EQ(fault(atoms(), keys), expected);
  keys.element.clear();
  keys.types = {{"1", 1}};
  EXPECT_EQ(fault(atoms(), keys), expected);
}

}  // namespace
}  // namespace orrery::points
