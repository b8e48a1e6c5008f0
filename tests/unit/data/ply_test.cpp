// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "data/data_file.h"
#include "support/data_file_test.h"
#include "support/data_tables.h"
#include "support/mentions.h"
#include "support/temp_dir.h"

namespace orrery::data {

namespace {

using support::number_bytes;
using support::numbers;

constexpr const char* kXyz = "property float x\nproperty float y\nproperty float z\n";
constexpr const char* kXyzr = "property float x\nproperty float y\nproperty float z\nproperty float radius\n";

std::string header(const std::string& encoding, const std::string& elements) {
  return "ply\nformat " + encoding + " 1.0\n" + elements + "end_header\n";
}

class DataPly : public support::DataFileTest {
 protected:
  DataPly() : DataFileTest("a.ply") {}
  Table read(const std::string& bytes) { return support::read_table(*open(bytes)); }
  Roles roles(const std::string& properties) {
    return open(header("ascii", "element vertex 0\n" + properties))->describe(0).roles;
  }
  std::string faults(const std::string& bytes) { return support::read_faults(write(bytes)); }
};

TEST_F(DataPly, AsciiNumbersAreFloat64OrInt64) {
  const auto file = open(header("ascii", std::string("element vertex 2\n") + kXyzr + "property uchar red\n") +
                         "1 2 .3 0.5 7\r\n\n-4e2 +5 .25 -1 255");
  EXPECT_STREQ(file->format, "PLY");
  EXPECT_EQ(support::columns_text(file->describe(0)), "x:float64 y:float64 z:float64 radius:float64 red:int64");
  const Table table = support::read_table(*file);
  EXPECT_EQ(numbers(table, "x"), (std::vector<double>{1, -400}));
  EXPECT_EQ(numbers(table, "z"), (std::vector<double>{0.3, 0.25}));
  EXPECT_EQ(numbers(table, "red"), (std::vector<double>{7, 255}));
  EXPECT_EQ(file->read(0, {"red", "y"}).columns[0].name, "red");
  EXPECT_EQ(numbers(file->read(0, {"red", "y"}), "y"), (std::vector<double>{2, 5}));
}

TEST_F(DataPly, HeadersMayHaveCommentsTabsAndOtherLineEnds) {
  const std::string text =
      "ply\r\ncomment made by hand\nformat binary_big_endian 1.0\nobj_info x\nelement vertex 1\nproperty float x\n"
      "property  double\ty\nproperty short z\nelement face 0\nproperty list uchar int corners\nend_header\n";
  const Table table =
      read(text + number_bytes(0.5F, true) + number_bytes(0.1, true) + number_bytes(std::int16_t{-3}, true));
  EXPECT_EQ(numbers(table, "x"), std::vector<double>{0.5});
  EXPECT_EQ(numbers(table, "y"), std::vector<double>{0.1});
  EXPECT_EQ(numbers(table, "z"), std::vector<double>{-3});
}

TEST_F(DataPly, TypesHaveTheirSizes) {
  const std::pair<const char*, std::size_t> types[] = {{"char", 1},  {"int8", 1},    {"uchar", 1},  {"uint8", 1},
                                                       {"short", 2}, {"int16", 2},   {"ushort", 2}, {"uint16", 2},
                                                       {"int", 4},   {"int32", 4},   {"uint", 4},   {"uint32", 4},
                                                       {"float", 4}, {"float32", 4}, {"double", 8}, {"float64", 8}};
  for (const auto& [name, size] : types) {
    const std::string begin =
        header("binary_little_endian", std::string("element vertex 1\n") + kXyz + "property " + name + " p\n");
    EXPECT_EQ(faults(begin + std::string(12 + size, '\0')), "") << name;
    EXPECT_NE(faults(begin + std::string(11 + size, '\0')), "") << name;
    EXPECT_NE(faults(begin + std::string(13 + size, '\0')), "") << name;
  }
}

TEST_F(DataPly, FaultsOfTheHeaderHaveTheirLine) {
  const std::string begin = "ply\nformat ascii 1.0\n";
  EXPECT_TRUE(test::mentions(faults("ply\nend_header\n"), {"2", "header", "format", "line"}));
  EXPECT_TRUE(test::mentions(faults("ply\nformat ascii\n"), {"2", "format", "line", "`format ENCODING 1.0`"}));
  EXPECT_TRUE(
      test::mentions(faults("ply\nformat text 1.0\n"), {"2", "ascii", "binary_little_endian", "binary_big_endian"}));
  EXPECT_TRUE(test::mentions(faults("ply\nformat ascii 2.0\n"), {"2", "format", "version", "`2.0`", "1.0"}));
  EXPECT_EQ(faults(begin + "format ascii 1.0\n"), "3: duplicate format line\n");
  EXPECT_TRUE(test::mentions(faults(begin + "element vertex\n"), {"3", "line", "`element NAME COUNT`"}));
  for (const char* count : {"-1", "1.5", "many", "18446744073709551616"})
    EXPECT_TRUE(test::mentions(faults(begin + "element vertex " + count + "\n"), {"3", "integer"})) << count;
  EXPECT_EQ(faults(begin + "element a 1\nelement a 1\n"), "4: duplicate element `a`\n");
  EXPECT_TRUE(test::mentions(faults(begin + "property float x\n"), {"3", "property"}));
  EXPECT_TRUE(test::mentions(faults(begin + "element a 1\nproperty float\n"), {"4", "line", "`property TYPE NAME`"}));
  EXPECT_TRUE(test::mentions(faults(begin + "element a 1\nproperty half x\n"), {"4", "int8", "float64"}));
  EXPECT_TRUE(test::mentions(faults(begin + "element a 1\nproperty list half int x\n"), {"4", "list"}));
  EXPECT_EQ(faults(begin + "element a 1\nproperty int x\nproperty float x\n"), "5: duplicate property `x`\n");
  EXPECT_TRUE(test::mentions(faults(begin + "texture a\n"), {"3", "header"}));
  EXPECT_TRUE(test::mentions(faults(begin + "element a 1\n"), {"4", "header", "end_header"}));
}

TEST_F(DataPly, TheLengthOfTheHeaderIsLimited) {
  constexpr std::size_t kLongest = std::size_t{1} << 20;
  std::string text = "ply\nformat ascii 1.0\n";
  const std::string end = "end_header\n";
  text += "comment " + std::string(kLongest - text.size() - end.size() - 9, 'x') + "\n";
  EXPECT_TRUE(test::mentions(faults(text + end), {"element", "`vertex`"})) << "the maximum length";
  EXPECT_TRUE(test::mentions(faults(text + "\n" + end), {"5", "header", "1048576", "bytes"}));
}

TEST_F(DataPly, BinaryColumnsKeepTheirTypesInBothByteOrders) {
  const char* const properties =
      "element other 2\nproperty short s\nelement vertex 1\nproperty double x\nproperty float y\nproperty char z\n"
      "property uchar a\nproperty short b\nproperty ushort c\nproperty int d\nproperty uint e\nelement edge 1\n"
      "property int f\n";
  for (const bool big : {false, true}) {
    const auto file =
        open(header(big ? "binary_big_endian" : "binary_little_endian", properties) + "1234" + number_bytes(0.1, big) +
             number_bytes(2.5f, big) + number_bytes<std::int8_t>(-7) + number_bytes<std::uint8_t>(200) +
             number_bytes<std::int16_t>(-3000, big) + number_bytes<std::uint16_t>(60000, big) +
             number_bytes<std::int32_t>(-100000, big) + number_bytes<std::uint32_t>(4000000000u, big) + "edge");
    EXPECT_EQ(support::columns_text(file->describe(0)),
              "x:float64 y:float32 z:int32 a:uint8 b:int32 c:uint16 d:int32 e:int64");
    const Table table = support::read_table(*file);
    std::vector<double> row;
    for (const Column& column : table.columns) row.push_back(column.number(0));
    EXPECT_EQ(row, (std::vector<double>{0.1, 2.5, -7, 200, -3000, 60000, -100000, 4000000000}));
  }
}

TEST_F(DataPly, OtherElementsAreSkipped) {
  const std::string vertex =
      "element vertex 2\nproperty float nx\nproperty float x\nproperty float y\nproperty int z\n";
  const std::string faces = "element face 2\nproperty list uchar int corners\nproperty uchar flag\n";
  const std::string plain = "element edge 3\nproperty int a\n";
  std::string data;
  for (const float x : {1.f, 5.f})
    data += number_bytes(99.f) + number_bytes(x) + number_bytes(x + 1) + number_bytes(static_cast<int>(x) + 2);
  const auto binary =
      open(header("binary_little_endian", plain + vertex + faces) + std::string(12, 'e') + data + "\2anything");
  EXPECT_EQ(support::columns_text(binary->describe(0)), "nx:float32 x:float32 y:float32 z:int32");
  EXPECT_EQ(numbers(support::read_table(*binary), "x"), (std::vector<double>{1, 5}));
  EXPECT_EQ(numbers(binary->read(0, {"z"}), "z"), (std::vector<double>{3, 7}));
  const auto ascii = open(header("ascii", faces + vertex + plain) + "2 1 2 9\n0 9\n99 1 2 3\n99 5 6 7\n1\nnot read\n");
  EXPECT_EQ(support::columns_text(ascii->describe(0)), "nx:float64 x:float64 y:float64 z:int64");
  EXPECT_EQ(numbers(support::read_table(*ascii), "y"), (std::vector<double>{2, 6}));
  EXPECT_EQ(numbers(support::read_table(*ascii), "z"), (std::vector<double>{3, 7}));
}

TEST_F(DataPly, ListsThatHideTheVerticesAreRefused) {
  const std::string vertex = "element vertex 1\n" + std::string(kXyz), list = "property list uchar int v\n";
  const std::string refusal =
      "are not supported; write the vertices first, without lists; lists after them are not read\n";
  EXPECT_EQ(faults(header("binary_little_endian", "element face 0\n" + list + vertex) + std::string(12, '\0')),
            "3: lists in `face` " + refusal);
  EXPECT_EQ(faults(header("binary_little_endian", vertex + list) + std::string(13, '\0')),
            "3: lists in `vertex` " + refusal);
  EXPECT_EQ(faults(header("ascii", vertex + list) + "1 2 3 0\n"), "3: lists in `vertex` " + refusal);
}

TEST_F(DataPly, CustomaryNames) {
  EXPECT_EQ(roles(kXyz).radius, "");
  EXPECT_EQ(roles(std::string(kXyz) + "property float r\n").radius, "r");
  EXPECT_EQ(roles(std::string(kXyz) + "property float scalar_radius\n").radius, "scalar_radius");
  EXPECT_EQ(roles(std::string(kXyz) + "property float r\nproperty float radius\n").radius, "radius");
  const Roles color = roles(std::string(kXyz) + "property uchar r\nproperty uchar g\nproperty uchar b\n");
  EXPECT_EQ(color.radius, "");
  EXPECT_EQ(color.rgb[1], "g");
  EXPECT_EQ(color.rgb_maximum, 255);
  const Roles diameter = roles(std::string(kXyz) + "property float diameter\nproperty int id\nproperty uchar class\n");
  EXPECT_EQ(diameter.radius, "diameter");
  EXPECT_EQ(diameter.radius_scale, 0.5);
  EXPECT_EQ(diameter.id, "id");
  EXPECT_EQ(diameter.type, "class");
  EXPECT_EQ(roles(std::string(kXyz) + "property float red\nproperty float green\nproperty float blue\n").rgb_maximum,
            1);
  EXPECT_EQ(roles(std::string(kXyz) + "property ushort red\nproperty ushort green\nproperty ushort blue\n").rgb_maximum,
            65535);
  EXPECT_EQ(roles(std::string(kXyz) +
                  "property uchar diffuse_red\nproperty uchar diffuse_green\nproperty uchar diffuse_blue\n")
                .rgb[0],
            "diffuse_red");
}

TEST_F(DataPly, ManyBinaryRows) {
  constexpr int kRows = 200000;
  std::string data;
  for (int i = 0; i < kRows; ++i)
    data += number_bytes(static_cast<double>(i)) + number_bytes(0.5) + number_bytes(static_cast<float>(i));
  const Table table = read(header("binary_little_endian",
                                  "element vertex 200000\nproperty double x\nproperty double y\nproperty float z\n"
                                  "element face 1\nproperty list uchar int v\n") +
                           data + std::string(1, '\0'));
  const auto x = numbers(table, "x"), z = numbers(table, "z");
  for (std::size_t i = 0; i < kRows; ++i) {
    ASSERT_EQ(x[i], static_cast<double>(i));
    ASSERT_EQ(z[i], static_cast<double>(i));
  }
}

TEST_F(DataPly, NoVertices) { EXPECT_EQ(read(header("ascii", std::string("element vertex 0\n") + kXyzr)).rows, 0u); }

TEST_F(DataPly, HeadersWithoutPositionsAreRefused) {
  EXPECT_TRUE(test::mentions(faults(header("ascii", "element face 0\n")), {"element", "`vertex`"}));
  EXPECT_TRUE(test::mentions(faults(header("ascii", "element vertex 0\nproperty float x\nproperty float y\n")),
                             {"columns", "numbers", "columns"}));
  EXPECT_TRUE(test::mentions(faults("ply\nformat ascii 1.0\nelement vertex many\n"), {"3", "integer"}));
}

TEST_F(DataPly, AnExcessiveCountIsRefusedBeforeAllocation) {
  const std::string data(31, '\0');
  for (const char* encoding : {"binary_little_endian", "ascii"})
    for (const char* count : {"1152921504606846976", "18446744073709551615", "17"})
      EXPECT_EQ(faults(header(encoding, "element vertex " + std::string(count) + "\n" + kXyzr) + data),
                "3: the header declares " + std::string(count) +
                    " rows of `vertex`, but only 31 bytes follow; the file is truncated, or the count is wrong\n");
  EXPECT_EQ(faults(header("binary_little_endian", std::string("element vertex 1\n") + kXyzr) + data.substr(0, 16)), "");
}

// The rows are on lines 9 and 10.
constexpr const char* kTwo =
    "element vertex 2\nproperty float x\nproperty float y\nproperty float z\nproperty float radius\n";

TEST_F(DataPly, RowsThatDifferFromTheHeaderAreRefused) {
  EXPECT_EQ(faults(header("ascii", kTwo) + "1 2 3 4\n1 2 3 4\n \n\r\n"), "") << "blank lines are not rows";
  EXPECT_EQ(
      faults(header("ascii", kTwo) + "1 2 3 4\n1 2 3 4\n5 6 7 8\n"),
      "3: the header declares 2 rows of `vertex`, but there are 3; the file is truncated, or the count is wrong\n");
  EXPECT_EQ(
      faults(header("ascii", kTwo) + "1 2 3 4       \n"),
      "3: the header declares 2 rows of `vertex`, but there are 1; the file is truncated, or the count is wrong\n");
  EXPECT_TRUE(test::mentions(faults(header("binary_little_endian", kTwo) + std::string(2 * 16 + 3, '\0')),
                             {"3", "bytes", "row", "header", "damaged"}));
  for (const char* wrong : {"1 2 3 4\n1 2 3\n4\n", "1 2 3 4 1\n2 3 4\n", "1 2 3 4\n1 2 three 4\n"})
    EXPECT_NE(faults(header("ascii", kTwo) + wrong), "") << wrong;
  const std::string colors = "element vertex 1\n" + std::string(kXyz) + "property uchar red\n";
  EXPECT_NE(faults(header("ascii", colors) + "1 2 3 0.5\n"), "");
}

}  // namespace
}  // namespace orrery::data
