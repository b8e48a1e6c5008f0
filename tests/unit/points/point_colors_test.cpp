// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/error.h"
#include "points/color_map.h"
#include "points/sources.h"
#include "points_file.h"
#include "support/mentions.h"

namespace orrery::points {
namespace {

using Indices = std::vector<std::uint16_t>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A table of one column.
data::Table table_of(data::Values values) {
  data::Table out;
  out.columns = {{"c", std::move(values)}};
  out.rows = out.columns[0].size();
  return out;
}

/// The colours of all rows of a table, by keys that name column `c`.
class PointsPointColors : public testing::Test {
 protected:
  PointsPointColors() { keys.column = "c"; }

  scene::Points colors(const data::Table& table) { return colors(table, Rows(table.rows)); }
  scene::Points colors(const data::Table& table, const Rows& rows) {
    data::FrameInfo info;
    for (const data::Column& column : table.columns) info.columns.push_back({column.name, column.type()});
    info.roles = roles;
    KeyFaults faults("points[0]");
    const ColorSource source = color_source(info, keys, folder_.path(), faults);
    scene::Points out;
    out.color = keys;
    data::Table all = table;
    add_expression(source, keys, all, faults);
    if (!faults.has_errors()) set_colors(all, rows, source, out, faults);
    diagnostics = text_of(faults);
    EXPECT_LE(out.palette_rec709, out.palette.size());
    for (const std::uint16_t i : out.colors) EXPECT_LT(i, out.palette.size());
    return out;
  }
  Vec3d color_of(const data::Table& table, std::size_t row) {
    const scene::Points all = colors(table);
    return all.palette.at(all.colors.at(row));
  }

  scene::PointsColor keys;
  data::Roles roles;
  std::string diagnostics;
  support::TempDir folder_;
};

void expect_color(Vec3d a, Vec3d b) { EXPECT_LT(math::length(a - b), 1e-9) << a.x << ' ' << a.y << ' ' << a.z; }

/// sRGB bytes to linear Rec.709, by the definition of sRGB.
Vec3d light(int r, int g, int b) {
  const auto decoded = [](int byte) {
    const double c = byte / 255.0;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  };
  return {decoded(r), decoded(g), decoded(b)};
}

TEST_F(PointsPointColors, NoneUnlessAKeyIsSet) {
  keys.column.clear();
  const scene::Points none = colors(table_of(std::vector<double>{1, 2}));
  EXPECT_TRUE(none.palette.empty() && none.colors.empty() && !none.color_range && none.color_names.empty());
}

TEST_F(PointsPointColors, ExpressionsAreColumns) {
  keys.column = "c * c - 1";
  const scene::Points of_squares = colors(table_of(std::vector<double>{1, 2, 3, kNan}));
  EXPECT_EQ(of_squares.color_range->low, 0);
  EXPECT_EQ(of_squares.color_range->high, 8);
  EXPECT_EQ(of_squares.colors, (Indices{0, 96, 255, 256}));
  EXPECT_TRUE(test::mentions(diagnostics, {"points[0].color.column", "1", "4", "`c * c - 1`"}));
  keys.column = "1 / c";
  EXPECT_EQ(colors(table_of(std::vector<double>{0, 2, 4})).colors, (Indices{256, 255, 0})) << "division by zero";
  keys.column = "1 / d";
  colors(table_of(std::vector<double>{0}));
  EXPECT_TRUE(test::mentions(diagnostics.substr(0, 90), {"points[0].color.column", "`1 / d`", "5"}));
}

TEST_F(PointsPointColors, LogarithmsShowDecades) {
  keys.log = true;
  const scene::Points decades = colors(table_of(std::vector<double>{1e-3, 1, 1e3, 0, -5, kNan, kInfinity}));
  EXPECT_EQ(decades.color_range->low, 1e-3);
  EXPECT_EQ(decades.color_range->high, 1e3);
  EXPECT_EQ(decades.colors, (Indices{0, 128, 255, 256, 256, 256, 255}));
  EXPECT_TRUE(test::mentions(diagnostics, {"points[0].color.log", "2", "7", "0"}));
  keys.range = scene::Interval{0, 1};
  colors(table_of(std::vector<double>{1}));
  EXPECT_TRUE(test::mentions(diagnostics, {"points[0].color.range", "0", "color.log"}));
}

/// Tables of colour maps are display values. A renderer that takes them for light shows pastel colours.
TEST_F(PointsPointColors, PaletteIsDecodedToLight) {
  keys.map = "viridis";
  const scene::Points out = colors(table_of(std::vector<double>{0, 1}));
  ASSERT_EQ(out.palette.size(), 257u);
  EXPECT_EQ(out.palette_rec709, 256u) << "the colour of NaN is in the scene's space";
  // The published ends of viridis: #440154 and #fde725.
  EXPECT_LT(math::length(out.palette[0] - light(0x44, 0x01, 0x54)), 0.005);
  EXPECT_LT(math::length(out.palette[255] - light(0xfd, 0xe7, 0x25)), 0.02);
  EXPECT_LT(out.palette[0].x, 0.07) << "0.27 if it is not decoded";
}

TEST_F(PointsPointColors, ADerivedRangeIsThatOfTheRows) {
  const data::Table table = table_of(std::vector<double>{-100, 2, 4, 6, kInfinity, kNan});
  const scene::Points out = colors(table, Rows(std::vector<std::uint32_t>{1, 2, 3, 4, 5}));
  ASSERT_TRUE(out.color_range);
  EXPECT_EQ(out.color_range->low, 2);
  EXPECT_EQ(out.color_range->high, 6);
  EXPECT_EQ(out.colors, (Indices{0, 128, 255, 255, 256}));
}

TEST_F(PointsPointColors, AGivenRangeClampsValues) {
  keys.range = scene::Interval{0, 255};
  const scene::Points out = colors(table_of(std::vector<double>{-3, 0, 0.4, 0.6, 100, 254.6, 1e9, -kInfinity}));
  EXPECT_EQ(out.color_range->high, 255);
  EXPECT_EQ(out.colors, (Indices{0, 0, 0, 1, 100, 255, 255, 0}));
}

TEST_F(PointsPointColors, NanHasItsOwnColor) {
  keys.nan_color = {0.1, 0.2, 0.3};
  expect_color(color_of(table_of(std::vector<float>{1, NAN, 2}), 1), {0.1, 0.2, 0.3});
  const scene::Points all = colors(table_of(std::vector<double>{kNan, kNan}));
  EXPECT_FALSE(all.color_range) << "there is no range of no numbers";
  expect_color(all.palette[all.colors[0]], {0.1, 0.2, 0.3});
}

TEST_F(PointsPointColors, AConstantColumnHasTheMiddleColor) {
  EXPECT_EQ(colors(table_of(std::vector<std::int32_t>{7, 7, 7})).colors, (Indices{128, 128, 128}));
}

TEST_F(PointsPointColors, RangesOfAnyMagnitude) {
  const double huge = std::numeric_limits<double>::max(), tiny = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(colors(table_of(std::vector<double>{-huge, 0, huge})).colors, (Indices{0, 128, 255}));
  EXPECT_EQ(colors(table_of(std::vector<double>{0, tiny, 2 * tiny})).colors, (Indices{0, 128, 255}));
  EXPECT_EQ(colors(table_of(std::vector<double>{1e15, 1e15 + 1})).colors, (Indices{0, 255}));
}

TEST_F(PointsPointColors, NoRows) {
  EXPECT_TRUE(colors(table_of(std::vector<double>{})).colors.empty());
  keys.map = "tab10";
  EXPECT_TRUE(colors(table_of(std::vector<double>{})).colors.empty());
  keys.map = "viridis";
  EXPECT_TRUE(colors(table_of(data::Words{})).colors.empty());
  EXPECT_EQ(diagnostics, "");
}

/// Films and selections show the same colour of a type, whichever types occur.
TEST_F(PointsPointColors, CategoriesOfIntegersHaveFixedColors) {
  keys.map = "tab10";
  const std::vector<ColorMap::Knot>& knots = find_color_map("tab10")->knots;
  const scene::Points out = colors(table_of(std::vector<std::int64_t>{3, 1, 11, 0, -9}));
  EXPECT_EQ(out.color_names, (std::vector<std::string>{"-9", "0", "1", "3", "11"}));
  EXPECT_EQ(out.palette_rec709, 5u);
  EXPECT_FALSE(out.color_range);
  const std::size_t expected[] = {2, 0, 0, 9, 0};
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_EQ(out.palette[out.colors[i]], linear_from_srgb(knots[expected[i]].srgb)) << i;
  EXPECT_EQ(color_of(table_of(std::vector<std::uint8_t>{3}), 0), linear_from_srgb(knots[2].srgb));
}

TEST_F(PointsPointColors, CategoriesOfFractionsAreNumbered) {
  keys.map = "tab10";
  const std::vector<ColorMap::Knot>& knots = find_color_map("tab10")->knots;
  const scene::Points out = colors(table_of(std::vector<double>{0.7, 0.5, kInfinity}));
  EXPECT_EQ(out.palette[out.colors[0]], linear_from_srgb(knots[1].srgb));
  EXPECT_EQ(out.palette[out.colors[1]], linear_from_srgb(knots[0].srgb));
  colors(table_of(std::vector<double>{1, kInfinity, -kInfinity, 1e300}));
  EXPECT_EQ(diagnostics, "");
}

TEST_F(PointsPointColors, CategoriesOfStringsDoNotDependOnTheSelection) {
  keys.map = "tab10";
  const std::vector<ColorMap::Knot>& knots = find_color_map("tab10")->knots;
  const data::Table table = table_of(data::Words{{"S", "C", "N"}, {0, 1, 2}});
  const scene::Points out = colors(table, Rows(std::vector<std::uint32_t>{0}));
  EXPECT_EQ(out.palette, std::vector<Vec3d>{linear_from_srgb(knots[2].srgb)});
  EXPECT_EQ(out.color_names, std::vector<std::string>{"S"});
}

TEST_F(PointsPointColors, NanIsASeparateCategory) {
  keys.map = "tab10";
  keys.nan_color = {0.1, 0.2, 0.3};
  const scene::Points out = colors(table_of(std::vector<double>{1, kNan, 2}));
  EXPECT_EQ(out.palette.at(out.colors[1]), keys.nan_color);
  EXPECT_EQ(out.palette_rec709, 2u);
  EXPECT_EQ(out.color_names, (std::vector<std::string>{"1", "2", "nan"}));
}

TEST_F(PointsPointColors, StringsSpreadOverAContinuousMap) {
  const ColorMap& map = *find_color_map("viridis");
  const scene::Points out = colors(table_of(data::Words{{"b", "c", "a"}, {0, 1, 2}}));
  EXPECT_EQ(out.palette, palette(map, 3));
  EXPECT_EQ(out.colors, (Indices{1, 2, 0}));
  EXPECT_FALSE(out.color_range);
}

TEST_F(PointsPointColors, ManyIntegersHaveTheColorsOfTheirRemainders) {
  keys.map = "tab10";
  std::vector<std::int64_t> many(5000);
  for (std::size_t i = 0; i < many.size(); ++i) many[i] = static_cast<std::int64_t>(i) - 7;
  const scene::Points out = colors(table_of(many));
  EXPECT_EQ(diagnostics, "");
  ASSERT_EQ(out.palette.size(), 10u);
  EXPECT_EQ(out.color_names.at(2), "3, 13, ...");
  many.resize(100);
  const scene::Points few = colors(table_of(many));
  for (std::size_t i = 0; i < many.size(); ++i)
    EXPECT_EQ(out.palette.at(out.colors[i]), few.palette.at(few.colors[i])) << "as if they were few: " << many[i];
}

TEST_F(PointsPointColors, TooManyCategories) {
  std::vector<double> many(4097);
  for (std::size_t i = 0; i < many.size(); ++i) many[i] = static_cast<double>(i) + 0.5;
  keys.map = "tab10";
  colors(table_of(many));
  EXPECT_TRUE(test::mentions(diagnostics, {"points[0].color.column", "`c`", "4096"}));
  many.pop_back();
  colors(table_of(many));
  EXPECT_EQ(diagnostics, "");
}

TEST_F(PointsPointColors, ElementsOfJmol) {
  keys.column.clear();
  keys.element = "jmol";
  roles.element = "c";
  const scene::Points out = colors(table_of(data::Words{{"Qq", "O", "fe"}, {2, 1, 0, 1}}));
  expect_color(out.palette.at(out.colors[0]), light(0xE0, 0x66, 0x33));
  expect_color(out.palette.at(out.colors[1]), light(0xFF, 0x0D, 0x0D));
  expect_color(out.palette.at(out.colors[2]), light(255, 20, 147));
  EXPECT_EQ(out.palette_rec709, out.palette.size());
  EXPECT_EQ(out.color_names, (std::vector<std::string>{"O", "Qq", "fe"}));
}

TEST_F(PointsPointColors, TypesHaveTheScenesColors) {
  keys.column.clear();
  roles.type = "c";
  keys.types = {{"2", {0.25, 0.5, 1}}, {"1", {0, 0, 1}}, {"7", {}}};
  const scene::Points out = colors(table_of(std::vector<std::int32_t>{2, 1, 2}));
  EXPECT_EQ(out.palette.at(out.colors[0]), (Vec3d{0.25, 0.5, 1}));
  EXPECT_EQ(out.palette.at(out.colors[1]), (Vec3d{0, 0, 1}));
  EXPECT_EQ(out.palette_rec709, 0u) << "authored colours are in the scene's space";
  colors(table_of(std::vector<std::int32_t>{3, 1, 4}));
  EXPECT_TRUE(test::mentions(diagnostics, {"points[0].color.type", "`3`", "`4`"}));
}

/// A table with colours in the file's own range.
template <class T>
data::Table rgb_table(const std::vector<T>& r, const std::vector<T>& g, const std::vector<T>& b) {
  data::Table out;
  out.rows = r.size();
  out.columns = {{"r", r}, {"g", g}, {"b", b}};
  return out;
}

TEST_F(PointsPointColors, RgbIsDecoded) {
  keys.column.clear();
  keys.rgb = true;
  roles.rgb = {"r", "g", "b"};
  const scene::Points out = colors(rgb_table<std::uint8_t>({255, 0, 128}, {0, 0, 64}, {10, 0, 32}));
  expect_color(out.palette.at(out.colors[0]), light(255, 0, 10));
  expect_color(out.palette.at(out.colors[1]), {0, 0, 0});
  expect_color(out.palette.at(out.colors[2]), light(128, 64, 32));
  EXPECT_EQ(out.palette_rec709, 3u);
  EXPECT_TRUE(out.color_names.empty());

  roles.rgb_maximum = 65535;
  expect_color(color_of(rgb_table<std::uint16_t>({65535}, {257 * 100}, {0}), 0), light(255, 100, 0));
  roles.rgb_maximum = 1;
  expect_color(color_of(rgb_table<float>({2, 0}, {-1, 0}, {NAN, 0}), 0), light(255, 0, 0));
  EXPECT_TRUE(test::mentions(diagnostics, {"points[0].color.rgb", "1", "0", "points[0].color.rgb"}));
}

/// Some programs write floating point colours from 0 to 255.
TEST_F(PointsPointColors, TheRangeOfFloatingPointColorsIsThatOfTheirValues) {
  keys.column.clear();
  keys.rgb = true;
  roles.rgb = {"r", "g", "b"};
  roles.rgb_maximum = 1;
  expect_color(color_of(rgb_table<float>({0, 200}, {0, 100}, {0, 50}), 1), light(200, 100, 50));
  expect_color(color_of(rgb_table<float>({0, 25700}, {0, 257}, {0, 0}), 1), light(100, 1, 0));
  EXPECT_TRUE(test::mentions(diagnostics, {"points[0].color.rgb", "1", "65535"}));
  expect_color(color_of(rgb_table<float>({0.2F, 2.5F}, {0.4F, 0.2F}, {0.6F, 0.2F}), 0), light(51, 102, 153));
  EXPECT_TRUE(test::mentions(diagnostics, {"points[0].color.rgb", "1", "0..1"})) << "one outlier";
}

TEST_F(PointsPointColors, ManyRgbColorsAreReduced) {
  keys.column.clear();
  keys.rgb = true;
  roles.rgb = {"r", "g", "b"};
  std::vector<std::uint8_t> r, g, b;
  for (int i = 0; i < 256 * 256; ++i) {
    r.push_back(static_cast<std::uint8_t>(i >> 8));
    g.push_back(static_cast<std::uint8_t>(i & 255));
    b.push_back(0);
  }
  EXPECT_EQ(colors(rgb_table(r, g, b)).palette.size(), 65'536u) << "as many as indices can distinguish";
  r.push_back(200);
  g.push_back(100);
  b.push_back(50);
  const scene::Points out = colors(rgb_table(r, g, b));
  EXPECT_EQ(out.palette.size(), 128u * 128 + 1);
  expect_color(out.palette.at(out.colors.back()), light(201, 101, 51));
  for (const Vec3d& c : {out.palette[out.colors[0]], out.palette[out.colors[256 * 255 + 255]]})
    EXPECT_LE(std::min(math::length(c - light(0, 0, 0)), math::length(c - light(255, 255, 0))), 0.01);
}

TEST_F(PointsPointColors, MapFromAFile) {
  support::write_bytes(folder_ / "two.txt", "0 0 0\n1 0 0\n");
  keys.map = "two.txt";
  const scene::Points out = colors(table_of(std::vector<double>{0, 1}));
  expect_color(out.palette[255], {1, 0, 0});
  expect_color(out.palette[51], light(51, 0, 0));
  keys.map = "missing.txt";
  EXPECT_THROW(colors(table_of(std::vector<double>{0, 1})), base::Error);
}

TEST_F(PointsPointColors, UnknownNamesAreReportedWithThoseThatExist) {
  const data::Table table = table_of(std::vector<double>{1});
  keys.map = "viridi";
  colors(table);
  EXPECT_TRUE(test::mentions(diagnostics, {"error points[0].color.map", "\"viridi\"", "`viridis`"}));
  keys.map = "viridis";
  keys.column = "charge";
  colors(table);
  EXPECT_TRUE(test::mentions(diagnostics, {"points[0].color.column", "`charge`", "columns"}));
  keys = {};
  keys.element = "jmol";
  colors(table);
  EXPECT_TRUE(test::mentions(diagnostics, {"points[0].color.element", "chemical", "elements"}));
  keys = {};
  keys.types = {{"1", {}}};
  colors(table);
  EXPECT_TRUE(test::mentions(diagnostics, {"points[0].color.type", "particle", "columns"}));
  keys = {};
  keys.rgb = true;
  colors(table);
  EXPECT_TRUE(test::mentions(diagnostics, {"points[0].color.rgb", "colours", "columns"}));
  keys.column = "c";
  colors(table);
  EXPECT_TRUE(test::mentions(diagnostics, {"points[0].color", "`column`", "`element`", "`type`"}));
}

TEST_F(PointsFile, CarbonsHaveTheColorsOfAColumn) {
  points.radius.value = 1;
  points.color.element = "soft";
  points.color.carbon = "chain";
  points.color.map = "set2";
  EXPECT_EQ(load("a.pdb",
                 "ATOM      1  CA  ALA A   1       1.000   2.000   3.000  1.00  0.00           C\n"
                 "ATOM      2  N   ALA A   1       4.000   5.000   6.000  1.00  0.00           N\n"
                 "ATOM      3  CA  ALA B   1       7.000   5.000   6.000  1.00  0.00           C\nEND\n"),
            "");
  const std::vector<Vec3d> set2 = palette(*find_color_map("set2"), 2);
  EXPECT_EQ(color(0), set2[0]);
  EXPECT_EQ(color(2), set2[1]);
  EXPECT_EQ(points.color_names, (std::vector<std::string>{"C (A)", "N", "C (B)"}));
  const Vec3d soft = color(1);
  points.color.element = "jmol";
  points.color.carbon.clear();
  EXPECT_EQ(load(), "");
  EXPECT_GT(soft.x, color(1).x) << "mixed with white";
  EXPECT_NE(color(0), set2[0]);
}

}  // namespace
}  // namespace orrery::points
