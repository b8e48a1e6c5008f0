// SPDX-License-Identifier: Apache-2.0
#include "points/rows.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "points_file.h"

namespace orrery::points {
namespace {

using data::Column;
using data::Words;
using Names = std::vector<std::string>;
using RowList = std::vector<std::uint32_t>;

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

TEST(PointsRows, AllRowsOrTheListedOnes) {
  EXPECT_EQ(Rows(3).size(), 3u);
  EXPECT_EQ(Rows(3)[2], 2u);
  const Rows listed(RowList{5, 1});
  EXPECT_EQ(listed.size(), 2u);
  EXPECT_EQ(listed[0], 5u);
  EXPECT_EQ(Rows(RowList{}).size(), 0u) << "an empty list is not all rows";
}

TEST(PointsRows, NumbersOfEveryType) {
  const Rows rows(RowList{2, 0});
  const auto numbers = [&](data::Values values) {
    std::vector<double> out(2, -1);
    for_each_number({"c", std::move(values)}, rows, [&](std::size_t i, double v) { out[i] = v; });
    return out;
  };
  const std::vector<double> expected = {3, 1};
  EXPECT_EQ(numbers(std::vector<double>{1, 2, 3}), expected);
  EXPECT_EQ(numbers(std::vector<float>{1, 2, 3}), expected);
  EXPECT_EQ(numbers(std::vector<std::int64_t>{1, 2, 3}), expected);
  EXPECT_EQ(numbers(std::vector<std::int32_t>{1, 2, 3}), expected);
  EXPECT_EQ(numbers(std::vector<std::uint16_t>{1, 2, 3}), expected);
  EXPECT_EQ(numbers(std::vector<std::uint8_t>{1, 2, 3}), expected);
  EXPECT_EQ(numbers(Words{{"a"}, {0, 0, 0}}), (std::vector<double>{-1, -1})) << "texts are not numbers";
}

TEST(PointsRows, LabelsOfNumbersAscendByValue) {
  const Column column{"type", std::vector<double>{10, 9, 0.5, 10, -1}};
  const Labels labels = labels_of(column, Rows(5), 4);
  EXPECT_EQ(labels.names, (Names{"-1", "0.5", "9", "10"})) << "10 sorts after 9";
  EXPECT_EQ(labels.values, (std::vector<double>{-1, 0.5, 9, 10}));
  EXPECT_EQ(labels.of_rows, (RowList{3, 2, 1, 3, 0}));
  EXPECT_TRUE(labels_of(column, Rows(5), 3).of_rows.empty()) << "more than the limit";
}

TEST(PointsRows, LabelsOfNanAreTheLast) {
  const Column column{"type", std::vector<double>{kNotANumber, 2, kNotANumber, kNotANumber, 1}};
  const Labels labels = labels_of(column, Rows(5), 5);
  EXPECT_EQ(labels.names, (Names{"1", "2", "nan"}));
  EXPECT_TRUE(std::isnan(labels.values.back()));
  EXPECT_EQ(labels.of_rows, (RowList{2, 1, 2, 2, 0}));
}

TEST(PointsRows, LabelsOfLargeNumbersAreNotRounded) {
  const Column column{"id", std::vector<std::int64_t>{999'999'999'999'999, 4}};
  EXPECT_EQ(labels_of(column, Rows(2), 5).names, (Names{"4", "999999999999999"}));
  const Column huge{"v", std::vector<double>{1e300, std::numeric_limits<double>::infinity()}};
  EXPECT_EQ(labels_of(huge, Rows(2), 5).names, (Names{"1e+300", "inf"}));
}

TEST(PointsRows, LabelsOfStringsAreThoseOfTheRows) {
  const Column column{"chain", Words{{"B", "unused", "A", "C"}, {0, 2, 3, 0}}};
  const Labels labels = labels_of(column, Rows(RowList{3, 0, 1}), 2);
  EXPECT_EQ(labels.names, (Names{"A", "B"}));
  EXPECT_TRUE(labels.values.empty());
  EXPECT_EQ(labels.of_rows, (RowList{1, 1, 0}));
  EXPECT_TRUE(labels_of(column, Rows(4), 2).of_rows.empty()) << "more than the limit";
}

/// Also of more rows than are taken at a time.
TEST(PointsRows, TakenPointsAreThoseOfTheColumns) {
  const std::size_t count = (1 << 20) + 5000;  // the rest fills more than a page
  std::vector<double> doubles, singles;
  std::vector<float> floats;
  for (std::size_t i = 0; i < count; ++i) {
    floats.push_back(static_cast<float>(i) + 0.5F);
    singles.push_back(static_cast<double>(floats.back()));
    doubles.push_back(static_cast<double>(i) + 0.1);
  }
  const std::vector<std::int32_t> integers(count, 7);
  const data::Values values[] = {floats, singles, doubles, integers};
  const std::array<std::string, 3> names = {"a", "b", "c"};
  for (const data::Values& a : values)
    for (const data::Values& b : {values[0], values[2]})
      for (const Rows& rows : {Rows(count), Rows(RowList{5, 0})}) {
        data::Table table;
        table.rows = count;
        table.columns = {{"a", a}, {"mass", integers}, {"b", b}, {"c", b}};
        const scene::PointArray expected = points_of(table, rows, names), points = take_points(table, rows, names);
        EXPECT_TRUE(points == expected);
        EXPECT_EQ(points.numbers().fits_single(), expected.numbers().fits_single());
        ASSERT_EQ(table.columns.size(), 1u);
        EXPECT_EQ(table.columns[0].name, "mass");
        EXPECT_EQ(table.columns[0].number(count - 1), 7);
      }
}

TEST(PointsRows, ColumnsAreRequired) {
  data::FrameInfo info;
  info.columns = {{"x", data::ColumnType::kFloat64}, {"name", data::ColumnType::kText}};
  KeyFaults faults("points[2]");
  EXPECT_TRUE(require_column(info, "x", true, ".radius", faults));
  EXPECT_TRUE(require_column(info, "name", false, ".color", faults));
  EXPECT_FALSE(faults.has_errors());
  EXPECT_FALSE(require_column(info, "name", true, ".radius", faults));
  EXPECT_FALSE(require_column(info, "nam", false, ".color", faults));
  EXPECT_FALSE(require_column(info, "weight", false, "", faults));
  EXPECT_TRUE(faults.has_errors());
  EXPECT_EQ(text_of(faults),
            "error points[2].radius: column `name` is text; it must be a number\n"
            "error points[2].color: the file has no column `nam`; did you mean `name`? its columns are x, name\n"
            "error points[2]: the file has no column `weight`; its columns are x, name\n");
}

TEST(PointsRows, ManyColumnsAreCounted) {
  data::FrameInfo info;
  for (int i = 0; i < 33; ++i) info.columns.push_back({std::string(1, static_cast<char>('A' + i))});
  KeyFaults faults("points[2]");
  EXPECT_EQ(require_role(info, "", "column of particle types", ".radius", faults), "");
  const std::string text = text_of(faults);
  EXPECT_NE(text.find("its columns are A, B, C"), std::string::npos) << text;
  EXPECT_NE(text.find(", ... (33 in all)"), std::string::npos) << text;
}

}  // namespace
}  // namespace orrery::points
