// SPDX-License-Identifier: Apache-2.0
#include "rows/ply_header.h"

#include <gtest/gtest.h>

namespace orrery::rows {

using namespace data;  // NOLINT(google-build-using-namespace)

namespace {

/// "line: fault" of a header; empty if it is valid.
std::string fault_of(const std::string& text) {
  PlyHeader header;
  int line = 0;
  const std::string fault = parse_ply_header(text, header, line);
  return fault.empty() ? "" : std::to_string(line) + ": " + fault;
}

TEST(RowsPlyHeader, ParsesElementsPropertiesAndTheStartOfTheData) {
  const std::string text =
      "ply\r\ncomment made by hand\nformat binary_big_endian 1.0\nobj_info x\nelement vertex 12\nproperty float x\n"
      "property  double\ty\nproperty list uchar int neighbours\nelement face 0\nend_header\n";
  PlyHeader header;
  int line = 0;
  ASSERT_EQ(parse_ply_header(text + "DATA", header, line), "");
  EXPECT_EQ(header.encoding, PlyEncoding::kBigEndian);
  EXPECT_EQ(header.bytes, text.size());
  EXPECT_EQ(header.lines, 10);
  ASSERT_EQ(header.elements.size(), 2u);
  EXPECT_EQ(header.elements[0].name, "vertex");
  EXPECT_EQ(header.elements[0].count, 12u);
  ASSERT_EQ(header.elements[0].properties.size(), 3u);
  EXPECT_EQ(header.elements[0].properties[0].type, NumberType::kFloat32);
  EXPECT_EQ(header.elements[0].properties[1].type, NumberType::kFloat64);
  EXPECT_EQ(header.elements[0].properties[1].name, "y");
  EXPECT_TRUE(header.elements[0].properties[2].is_list);
  EXPECT_EQ(header.elements[0].properties[2].count_type, NumberType::kUint8);
  EXPECT_EQ(header.elements[0].properties[2].type, NumberType::kInt32);
  EXPECT_TRUE(header.elements[0].has_list());
  EXPECT_FALSE(header.elements[1].has_list());
}

TEST(RowsPlyHeader, TypesHaveTheirSizes) {
  const std::pair<const char*, std::size_t> types[] = {{"char", 1},  {"int8", 1},    {"uchar", 1},  {"uint8", 1},
                                                       {"short", 2}, {"int16", 2},   {"ushort", 2}, {"uint16", 2},
                                                       {"int", 4},   {"int32", 4},   {"uint", 4},   {"uint32", 4},
                                                       {"float", 4}, {"float32", 4}, {"double", 8}, {"float64", 8}};
  for (const auto& [name, size] : types) {
    PlyHeader header;
    int line = 0;
    ASSERT_EQ(parse_ply_header(std::string("ply\nformat ascii 1.0\nelement e 1\nproperty ") + name + " p\nend_header\n",
                               header, line),
              "");
    EXPECT_EQ(size_of(header.elements[0].properties[0].type), size) << name;
  }
}

TEST(RowsPlyHeader, FaultsHaveTheirLine) {
  const std::string begin = "ply\nformat ascii 1.0\n";
  EXPECT_EQ(fault_of(""), "1: not a PLY file: the first line is not `ply`");
  EXPECT_EQ(fault_of("polygon\n"), "1: not a PLY file: the first line is not `ply`");
  EXPECT_EQ(fault_of("ply\nend_header\n"), "2: the header has no format line");
  EXPECT_EQ(fault_of("ply\nformat ascii\n"), "2: a format line must be `format ENCODING 1.0`");
  EXPECT_EQ(fault_of("ply\nformat text 1.0\n"),
            "2: unknown encoding; allowed are ascii, binary_little_endian, binary_big_endian");
  EXPECT_EQ(fault_of("ply\nformat ascii 2.0\n"), "2: unsupported format version `2.0`; supported is 1.0");
  EXPECT_EQ(fault_of(begin + "format ascii 1.0\n"), "3: duplicate format line");
  EXPECT_EQ(fault_of(begin + "element vertex\n"), "3: an element line must be `element NAME COUNT`");
  for (const char* count : {"-1", "1.5", "many", "18446744073709551616"})
    EXPECT_EQ(fault_of(begin + "element vertex " + count + "\n"),
              "3: the count of an element must be a non-negative integer")
        << count;
  EXPECT_EQ(fault_of(begin + "element a 1\nelement a 1\n"), "4: duplicate element `a`");
  EXPECT_EQ(fault_of(begin + "property float x\n"), "3: property before the first element");
  EXPECT_EQ(fault_of(begin + "element a 1\nproperty float\n"), "4: a property line must be `property TYPE NAME`");
  EXPECT_EQ(fault_of(begin + "element a 1\nproperty half x\n"),
            "4: unknown type; allowed are char .. double, int8 .. float64");
  EXPECT_EQ(fault_of(begin + "element a 1\nproperty list half int x\n"), "4: unknown type of the list length");
  EXPECT_EQ(fault_of(begin + "element a 1\nproperty int x\nproperty float x\n"), "5: duplicate property `x`");
  EXPECT_EQ(fault_of(begin + "texture a\n"), "3: unknown keyword in the header");
  EXPECT_EQ(fault_of(begin + "element a 1\n"), "4: the header has no end_header");
}

TEST(RowsPlyHeader, TheLengthIsLimited) {
  std::string text = "ply\nformat ascii 1.0\n";
  const std::string end = "end_header\n";
  text += "comment " + std::string(kLongestHeader - text.size() - end.size() - 9, 'x') + "\n";
  EXPECT_EQ(fault_of(text + end), "") << "the maximum length";
  EXPECT_EQ(fault_of(text + "\n" + end), "5: the header exceeds the limit of 1048576 bytes");
}

}  // namespace
}  // namespace orrery::rows
