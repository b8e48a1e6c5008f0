// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "data/data_file.h"
#include "support/data_tables.h"
#include "support/mentions.h"
#include "support/npy_bytes.h"

namespace orrery::data {

namespace {

using support::npy_bytes;
using support::number_bytes;
using support::numbers;
using support::sequence;

class DataNpy : public testing::Test {
 protected:
  std::unique_ptr<DataFile> open(const std::string& bytes) {
    support::write_bytes(folder_ / "a.npy", bytes);
    return data::open(folder_ / "a.npy");
  }
  Table read(const std::string& bytes) { return support::read_table(*open(bytes)); }
  std::string faults(const std::string& bytes) {
    support::write_bytes(folder_ / "a.npy", bytes);
    return support::read_faults(folder_ / "a.npy");
  }
  support::TempDir folder_;
};

TEST_F(DataNpy, ThreeColumnsArePositionsAndAFourthIsTheRadius) {
  const auto three = open(npy_bytes("'<f8'", false, "(2, 3)", sequence<double>({1, 2, 3, 4, 5, 6})));
  EXPECT_STREQ(three->format, "NPY");
  EXPECT_EQ(support::columns_text(three->describe(0)), "x:float64 y:float64 z:float64");
  EXPECT_EQ(three->describe(0).rows, 2u);
  EXPECT_EQ(three->describe(0).roles.radius, "");
  EXPECT_EQ(numbers(support::read_table(*three), "y"), (std::vector<double>{2, 5}));
  const auto four = open(npy_bytes("'<f4'", false, "(2, 4)", sequence<float>({1, 2, 3, 4, 5, 6, 7, 8})));
  EXPECT_EQ(support::columns_text(four->describe(0)), "x:float32 y:float32 z:float32 radius:float32");
  EXPECT_EQ(four->describe(0).roles.radius, "radius");
  EXPECT_EQ(numbers(support::read_table(*four), "radius"), (std::vector<double>{4, 8}));
}

TEST_F(DataNpy, FortranOrderStoresColumnsContiguously) {
  const Table table = read(npy_bytes("'>f4'", true, "(2, 3)", sequence<float>({1, 2, 3, 4, 5, 6}, true)));
  EXPECT_EQ(numbers(table, "x"), (std::vector<double>{1, 2}));
  EXPECT_EQ(numbers(table, "y"), (std::vector<double>{3, 4}));
  EXPECT_EQ(numbers(table, "z"), (std::vector<double>{5, 6}));
}

template <class T>
void expect_values(const Table& table, const char* name, std::initializer_list<T> expected) {
  const Column* const column = table.find(name);
  ASSERT_NE(column, nullptr);
  EXPECT_EQ(std::get<std::vector<T>>(column->values), std::vector<T>(expected)) << name;
}

TEST_F(DataNpy, EveryNumberTypeInBothByteOrders) {
  for (const bool big : {false, true}) {
    const std::string e = big ? ">" : "<";
    std::string description = "[('x', '" + e + "f4'), ('y', '" + e + "f8'), ('z', '|i1'), ('a', '|u1')";
    for (const char* type : {"i2", "u2", "i4", "u4", "i8", "u8"})
      description += ", ('" + std::string(type) + "', '" + e + type + "')";
    description += ", ('flag', '|b1')]";
    const std::string row = number_bytes(1.5f, big) + number_bytes(-0.1, big) + number_bytes<std::int8_t>(-128) +
                            number_bytes<std::uint8_t>(255) + number_bytes<std::int16_t>(-32768, big) +
                            number_bytes<std::uint16_t>(65535, big) + number_bytes<std::int32_t>(-2147483647 - 1, big) +
                            number_bytes<std::uint32_t>(4294967295u, big) +
                            number_bytes(std::numeric_limits<std::int64_t>::min(), big) +
                            number_bytes<std::uint64_t>(9223372036854775807u, big) + "\1";
    const Table table = read(npy_bytes(description, false, "(1,)", row));
    expect_values<float>(table, "x", {1.5f});
    expect_values<double>(table, "y", {-0.1});
    expect_values<std::int32_t>(table, "z", {-128});
    expect_values<std::uint8_t>(table, "a", {255});
    expect_values<std::int32_t>(table, "i2", {-32768});
    expect_values<std::uint16_t>(table, "u2", {65535});
    expect_values<std::int32_t>(table, "i4", {-2147483647 - 1});
    expect_values<std::int64_t>(table, "u4", {4294967295});
    expect_values<std::int64_t>(table, "i8", {std::numeric_limits<std::int64_t>::min()});
    expect_values<std::int64_t>(table, "u8", {9223372036854775807});
    expect_values<std::uint8_t>(table, "flag", {1});
  }
}

TEST_F(DataNpy, UnsignedIntegersBeyondInt64AreRefused) {
  const std::string description = "[('x', '<f4'), ('y', '<f4'), ('z', '<f4'), ('id', '<u8')]";
  std::string rows;
  for (const std::uint64_t id :
       {std::uint64_t{9223372036854775807u}, std::uint64_t{9223372036854775808u}, ~std::uint64_t{0}})
    rows += std::string(12, '\0') + number_bytes(id);
  EXPECT_TRUE(test::mentions(
      faults(npy_bytes(description, false, "(3,)", rows)),
      {"row", "2", "`id`", "9223372036854775808", "int64", "3", "`id`", "18446744073709551615", "int64"}));
}

TEST_F(DataNpy, FieldsHaveCustomaryRoles) {
  const auto file = open(
      npy_bytes("[('id', '<i8'), ('pos', '<f4', (3,)), ('', '|V4'), ('diameter', '<f4'), ('vel', '<f4', (2,)), "
                "(('kind', 'type'), "
                "'<i4'), ('element', '<U2'), ('tag', '|S3'), ('color', '|u1', (3,))]",
                false, "(1,)",
                number_bytes<std::int64_t>(7) + sequence<float>({1, 2, 3}) + "????" + sequence<float>({0.5, 8, 9}) +
                    number_bytes(4) + number_bytes('C' + 0) + number_bytes(0) + std::string("ab\0", 3) + "\1\2\3"));
  const FrameInfo info = file->describe(0);
  EXPECT_EQ(support::columns_text(info),
            "id:int64 x:float32 y:float32 z:float32 diameter:float32 vel[1]:float32 vel[2]:float32 type:int32 "
            "element:text tag:text color[1]:uint8 color[2]:uint8 color[3]:uint8");
  EXPECT_EQ(info.roles.id, "id");
  EXPECT_EQ(info.roles.radius, "diameter");
  EXPECT_EQ(info.roles.radius_scale, 0.5);
  EXPECT_EQ(info.roles.type, "type");
  EXPECT_EQ(info.roles.element, "element");
  EXPECT_EQ(info.roles.rgb[2], "color[3]");
  EXPECT_EQ(info.roles.rgb_maximum, 255);
  const Table table = support::read_table(*file);
  EXPECT_EQ(numbers(table, "z"), std::vector<double>{3});
  EXPECT_EQ(numbers(table, "vel[2]"), std::vector<double>{9});
  EXPECT_EQ(numbers(table, "type"), std::vector<double>{4});
  EXPECT_EQ(support::texts(table, "element"), std::vector<std::string>{"C"});
  EXPECT_EQ(support::texts(table, "tag"), std::vector<std::string>{"ab"});
  EXPECT_EQ(numbers(table, "color[3]"), std::vector<double>{3});
}

TEST_F(DataNpy, FieldsOfOtherTypesAreLeftOut) {
  const auto file = open(
      npy_bytes("[('half', '<f2'), ('pos', '<f4', (3,)), ('time', '<M8[ns]'), ('c', '<c16', (2,)), ('long', '<f16'), "
                "('radius', '<f4')]",
                false, "(1,)",
                "hh" + sequence<float>({1, 2, 3}) + "tttttttt" + std::string(32, 'c') + std::string(16, 'l') +
                    sequence<float>({0.5})));
  EXPECT_EQ(support::columns_text(file->describe(0)), "x:float32 y:float32 z:float32 radius:float32");
  EXPECT_EQ(numbers(support::read_table(*file), "z"), std::vector<double>{3});
  EXPECT_EQ(numbers(support::read_table(*file), "radius"), std::vector<double>{0.5});
}

TEST_F(DataNpy, StringsAreUnicodeOfBothByteOrders) {
  const std::u32string words[] = {U"O", U"\u00c5", U"\u4e2d", U"\U0001F600"};
  for (const bool big : {false, true}) {
    std::string data;
    for (const auto& word : words) {
      data += std::string(12, '\0');
      data += number_bytes(static_cast<std::uint32_t>(word[0]), big) + number_bytes<std::uint32_t>(0);
    }
    const std::string description =
        std::string("[('x','<f4'),('y','<f4'),('z','<f4'),('name','") + (big ? ">" : "<") + "U2')]";
    EXPECT_EQ(support::texts(read(npy_bytes(description, false, "(4,)", data)), "name"),
              (std::vector<std::string>{"O", "\xC3\x85", "\xE4\xB8\xAD", "\xF0\x9F\x98\x80"}));
  }
  for (const std::uint32_t invalid : {0xD800u, 0x110000u})
    EXPECT_TRUE(test::mentions(faults(npy_bytes("[('x','<f4'),('y','<f4'),('z','<f4'),('name','<U1')]", false, "(1,)",
                                                std::string(12, '\0') + number_bytes(invalid))),
                               {"row", "1", "`name`", "character"}));
}

TEST_F(DataNpy, VersionsTwoAndThreeHaveALongLength) {
  for (const int version : {1, 2, 3})
    EXPECT_EQ(numbers(read(npy_bytes("'<i2'", false, "(1, 3)", sequence<std::int16_t>({1, 2, 3}), version)), "z"),
              std::vector<double>{3})
        << version;
  EXPECT_TRUE(test::mentions(faults(npy_bytes("'<i2'", false, "(1, 3)", "", 4)), {"version", "4", "format", "1", "3"}));
}

TEST_F(DataNpy, ManyRowsAreReadInParallel) {
  constexpr int kRows = 300000;
  std::string data;
  for (int i = 0; i < 3 * kRows; ++i) data += number_bytes(static_cast<double>(i));
  const Table table = read(npy_bytes("'<f8'", false, "(300000, 3)", data));
  const auto x = numbers(table, "x"), z = numbers(table, "z");
  for (std::size_t i = 0; i < kRows; ++i) {
    ASSERT_EQ(x[i], 3 * static_cast<double>(i));
    ASSERT_EQ(z[i], 3 * static_cast<double>(i) + 2);
  }
}

TEST_F(DataNpy, NoRows) {
  const Table table = read(npy_bytes("'<f8'", false, "(0, 3)", ""));
  EXPECT_EQ(table.rows, 0u);
  EXPECT_EQ(numbers(table, "x").size(), 0u);
}

TEST_F(DataNpy, ArraysThatAreNotTablesAreRefused) {
  EXPECT_EQ(
      faults(npy_bytes("'<f8'", false, "(6,)", std::string(48, '\0'))),
      "the array has the shape (6,); a plain array must be (N, 3), or (N, 4) with the radius last; transpose it, or "
      "save a structured array or an NPZ file, whose columns have names\n");
  EXPECT_NE(faults(npy_bytes("'<f8'", false, "(3, 2)", std::string(48, '\0'))), "");
  EXPECT_NE(faults(npy_bytes("'<f8'", false, "()", std::string(8, '\0'))), "");
  EXPECT_TRUE(test::mentions(faults(npy_bytes("'|O'", false, "(2, 3)", "x")), {"e.g", "astype('f8')"}));
  for (const char* type : {"<c8", "<f2", "<f16", "<M8[ns]", "<i3", "f", "", "<f-8"})
    EXPECT_EQ(faults(npy_bytes("'" + std::string(type) + "'", false, "(2, 3)", "x")),
              "the type `" + std::string(type) +
                  "` is not supported; convert the array to numbers, e.g. with `astype('f8')`\n");
  EXPECT_TRUE(test::mentions(faults(npy_bytes("[('x','<f4'),('y','<f4')]", false, "(1,)", std::string(8, '\0'))),
                             {"columns", "numbers", "columns"}));
  EXPECT_EQ(faults(npy_bytes("[('x','<f4'),('x','<f4')]", false, "(1,)", std::string(8, '\0'))),
            "duplicate column `x`\n");
  EXPECT_TRUE(test::mentions(faults(npy_bytes("[('a',[('x','<f4')])]", false, "(1,)", std::string(4, '\0'))),
                             {"`a`", "separately"}));
}

TEST_F(DataNpy, ShapesBeyondTheDataAreRefusedBeforeAllocation) {
  const std::string data(24, '\0');
  EXPECT_TRUE(test::mentions(faults(npy_bytes("'<f8'", false, "(2, 3)", data)),
                             {"header", "2", "3", "8", "bytes", "24", "bytes", "truncated", "header"}));
  EXPECT_NE(faults(npy_bytes("'<f8'", false, "(1, 3)", data + "x")), "") << "excess data";
  for (const char* shape : {"(768614336404564651, 3)", "(18446744073709551615, 3)", "(2305843009213693953, 3)"})
    EXPECT_NE(faults(npy_bytes("'<f8'", false, shape, data)), "") << shape;
  EXPECT_NE(faults(npy_bytes("'<f8'", false, "(18446744073709551616, 3)", data)), "") << "beyond 64 bits";
  EXPECT_NE(faults(npy_bytes("[('x','|S0'),('y','|S0'),('z','|S0')]", false, "(1000000000000000,)", "")), "")
      << "items without bytes";
  EXPECT_NE(faults(npy_bytes("[('x','<f4',(4294967296,4294967296))]", false, "(0,)", "")), "");
  EXPECT_NE(faults(npy_bytes("[('x','|S99999999999999')]", false, "(0,)", "")), "");
}

TEST_F(DataNpy, MalformedHeadersAreRefused) {
  const auto with = [](const std::string& literal) {
    return "\x93NUMPY\x01" + std::string(1, '\0') + number_bytes(static_cast<std::uint16_t>(literal.size())) + literal +
           std::string(24, '\0');
  };
  const std::string good = "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 3)}";
  ASSERT_EQ(faults(with(good)), "");
  EXPECT_EQ(faults(with("{'shape': (1L, 3L,), \"descr\": \"<f8\",'fortran_order':False, } \n")), "") << "older writers";
  EXPECT_TRUE(test::mentions(faults(with("{'descr': '<f8', 'shape': (1, 3)}")),
                             {"header", "`descr`", "`fortran_order`", "`shape`"}));
  EXPECT_TRUE(test::mentions(faults(with("{'descr': '<f8', 'fortran_order': 0, 'shape': (1, 3)}")),
                             {"header", "`descr`", "`fortran_order`", "`shape`"}));
  EXPECT_TRUE(test::mentions(faults(with("{'descr': '\\x41'}")), {"header", "string", "escape"}));
  for (const std::string& literal :
       {good + "x", std::string("{'descr': __import__('os')}"), std::string("{'descr': '<f8}"),
        std::string("{'descr' '<f8'}"), std::string("{'descr': ('<f8' 1)}"), std::string(60000, '['),
        std::string(30000, '[') + std::string(30000, ')')})
    EXPECT_TRUE(test::mentions(faults(with(literal)), {"header"})) << literal.substr(0, 40);
  EXPECT_TRUE(test::mentions(faults(with("{'descr': '<f8', 'fortran_order': False, 'shape': (-1, 3)}")),
                             {"`shape`", "integers"}));
  for (const char* shape : {"3", "(1, 'a')", "{}", "((1,), 3)"})
    EXPECT_NE(faults(with("{'descr': '<f8', 'fortran_order': False, 'shape': " + std::string(shape) + "}")), "")
        << shape;
  for (const char* descr :
       {"1", "True", "[1]", "[('x',)]", "[(1, '<f8')]", "[('x', '<f8', 3)]", "[('x', '<f8', (True,))]"})
    EXPECT_NE(faults(with("{'fortran_order': False, 'shape': (1,), 'descr': " + std::string(descr) + "}")), "")
        << descr;
  const std::string whole = with(good);
  for (std::size_t size = 6; size < whole.size(); size += 3) EXPECT_NE(faults(whole.substr(0, size)), "") << size;
}

}  // namespace
}  // namespace orrery::data
