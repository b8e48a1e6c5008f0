// SPDX-License-Identifier: Apache-2.0
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <random>

#include "data/data_file.h"
#include "support/data_tables.h"
#include "support/mentions.h"
#include "support/shared_data.h"

namespace orrery::data {

namespace {

using support::number_bytes;
using support::numbers;

/// A LAS file in parts that a test can change.
struct Las {
  int minor = 2;
  std::uint8_t format = 0;
  std::uint16_t header_bytes = 227, record_bytes = 20;
  std::uint32_t count = 0, variable_records = 0;
  std::uint64_t long_count = 0;
  std::array<double, 3> scale = {0.01, 0.01, 0.01}, offset = {0, 0, 0};
  std::string gap, points;  ///< `gap` is between header and points

  std::string bytes() const {
    std::string out = "LASF" + std::string(20, '\0');
    out += static_cast<char>(1);
    out += static_cast<char>(minor);
    out.resize(94);
    out += number_bytes(header_bytes) + number_bytes(static_cast<std::uint32_t>(header_bytes + gap.size())) +
           number_bytes(variable_records) + static_cast<char>(format) + number_bytes(record_bytes) +
           number_bytes(count);
    out.resize(131);
    for (const auto& three : {scale, offset})
      for (const double v : three) out += number_bytes(v);
    out.resize(247);
    out += number_bytes(long_count);
    out.resize(header_bytes);
    return out + gap + points;
  }
};

/// A record with the numbers that all point formats begin with; the rest is zero.
std::string record(std::uint16_t bytes, std::int32_t x, std::int32_t y, std::int32_t z, std::uint16_t intensity = 0) {
  std::string out = number_bytes(x) + number_bytes(y) + number_bytes(z) + number_bytes(intensity);
  out.resize(bytes);
  return out;
}

void put(std::string& record, std::size_t at, const std::string& bytes) { record.replace(at, bytes.size(), bytes); }

class DataLas : public testing::Test {
 protected:
  std::unique_ptr<DataFile> open(const Las& las) {
    support::write_bytes(folder_ / "a.las", las.bytes());
    return data::open(folder_ / "a.las");
  }
  std::string faults(const Las& las) {
    support::write_bytes(folder_ / "a.las", las.bytes());
    return support::read_faults(folder_ / "a.las");
  }
  support::TempDir folder_;
};

TEST_F(DataLas, CoordinatesAreScaledAndOffset) {
  Las las;
  las.count = 2;
  las.scale = {0.01, 0.5, 2};
  las.offset = {1000, -1, 0.25};
  las.points = record(20, 123, -3, 7, 400) + record(20, 2147483647, -2147483647 - 1, 0, 65535);
  const auto file = open(las);
  EXPECT_STREQ(file->format, "LAS");
  const FrameInfo info = file->describe(0);
  EXPECT_EQ(info.rows, 2u);
  EXPECT_TRUE(info.z_up);
  EXPECT_EQ(info.roles.type, "classification");
  EXPECT_TRUE(info.roles.rgb[0].empty());
  EXPECT_EQ(support::columns_text(info),
            "x:float64 y:float64 z:float64 intensity:uint16 return_number:uint8 number_of_returns:uint8 "
            "classification:uint8 scan_angle:float64 user_data:uint8 point_source_id:uint16");
  const Table table = support::read_table(*file);
  EXPECT_EQ(table.rows, 2u);
  EXPECT_EQ(numbers(table, "x"), (std::vector<double>{123 * 0.01 + 1000, 2147483647 * 0.01 + 1000}));
  EXPECT_EQ(numbers(table, "y"), (std::vector<double>{-2.5, -1073741825}));
  EXPECT_EQ(numbers(table, "z"), (std::vector<double>{14.25, 0.25}));
  EXPECT_EQ(numbers(table, "intensity"), (std::vector<double>{400, 65535}));
}

TEST_F(DataLas, OnlyRequestedColumnsAreReadInTheirOrder) {
  Las las;
  las.count = 1;
  las.points = record(20, 100, 200, 300);
  const Table table = open(las)->read(0, {"z", "x"});
  ASSERT_EQ(table.columns.size(), 2u);
  EXPECT_EQ(table.columns[0].name, "z");
  EXPECT_EQ(table.columns[0].number(0), 3);
  EXPECT_EQ(table.columns[1].name, "x");
}

TEST_F(DataLas, BitFieldsOfShortAndLongFormats) {
  Las las;
  las.count = 1;
  las.points = record(20, 0, 0, 0);
  las.points[14] = static_cast<char>(0xC0 | 5 << 3 | 2);  // both upper bits are flags
  las.points[15] = static_cast<char>(0xE0 | 9);           // three flags and the class
  las.points[16] = static_cast<char>(-17);
  Table table = support::read_table(*open(las));
  EXPECT_EQ(numbers(table, "return_number"), std::vector<double>{2});
  EXPECT_EQ(numbers(table, "number_of_returns"), std::vector<double>{5});
  EXPECT_EQ(numbers(table, "classification"), std::vector<double>{9});
  EXPECT_EQ(numbers(table, "scan_angle"), std::vector<double>{-17});

  las.format = 6;
  las.record_bytes = 30;
  las.points = record(30, 0, 0, 0);
  las.points[14] = static_cast<char>(12 << 4 | 11);
  las.points[15] = static_cast<char>(0xFF);  // flags
  las.points[16] = static_cast<char>(200);
  put(las.points, 18, number_bytes<std::int16_t>(-1000));
  put(las.points, 20, number_bytes<std::uint16_t>(777));
  put(las.points, 22, number_bytes(1.5e9));
  table = support::read_table(*open(las));
  EXPECT_EQ(numbers(table, "return_number"), std::vector<double>{11});
  EXPECT_EQ(numbers(table, "number_of_returns"), std::vector<double>{12});
  EXPECT_EQ(numbers(table, "classification"), std::vector<double>{200});
  EXPECT_EQ(numbers(table, "scan_angle"), std::vector<double>{-1000 * 0.006});
  EXPECT_EQ(numbers(table, "point_source_id"), std::vector<double>{777});
  EXPECT_EQ(numbers(table, "gps_time"), std::vector<double>{1.5e9});
}

TEST_F(DataLas, EveryPointFormatHasItsTimeAndItsColors) {
  // Point format, record size, offsets of time, red and near infrared; 0: absent.
  constexpr int kFormats[][5] = {{0, 20, 0, 0, 0},    {1, 28, 20, 0, 0},  {2, 26, 0, 20, 0},   {3, 34, 20, 28, 0},
                                 {4, 57, 20, 0, 0},   {5, 63, 20, 28, 0}, {6, 30, 22, 0, 0},   {7, 36, 22, 30, 0},
                                 {8, 38, 22, 30, 36}, {9, 59, 22, 0, 0},  {10, 67, 22, 30, 36}};
  for (const auto& [format, size, time, red, infrared] : kFormats) {
    Las las;
    las.minor = 4;
    las.header_bytes = 375;
    las.format = static_cast<std::uint8_t>(format);
    las.record_bytes = static_cast<std::uint16_t>(size + 3);  // with extra bytes
    las.count = 2;
    for (int row = 0; row < 2; ++row) {
      std::string point = record(las.record_bytes, row, 0, 0);
      if (time > 0) put(point, static_cast<std::size_t>(time), number_bytes(row + 0.5));
      for (int i = 0; i < 3 && red > 0; ++i)
        put(point, static_cast<std::size_t>(red + 2 * i), number_bytes(static_cast<std::uint16_t>(1000 * i + row)));
      if (infrared > 0)
        put(point, static_cast<std::size_t>(infrared), number_bytes(static_cast<std::uint16_t>(9 + row)));
      las.points += point;
    }
    const auto file = open(las);
    const Table table = support::read_table(*file);
    EXPECT_EQ(table.find("gps_time") != nullptr, time > 0) << format;
    EXPECT_EQ(file->describe(0).roles.rgb[0], red > 0 ? "red" : "") << format;
    EXPECT_EQ(table.find("near_infrared") != nullptr, infrared > 0) << format;
    if (time > 0) {
      EXPECT_EQ(numbers(table, "gps_time"), (std::vector<double>{0.5, 1.5})) << format;
    }
    if (red > 0) {
      EXPECT_EQ(numbers(table, "red"), (std::vector<double>{0, 1})) << format;
    }
    if (red > 0) {
      EXPECT_EQ(numbers(table, "blue"), (std::vector<double>{2000, 2001})) << format;
    }
    if (infrared > 0) {
      EXPECT_EQ(numbers(table, "near_infrared"), (std::vector<double>{9, 10})) << format;
    }
    las.record_bytes = static_cast<std::uint16_t>(size - 1);
    EXPECT_NE(faults(las).find("needs " + std::to_string(size)), std::string::npos) << format;
  }
}

TEST_F(DataLas, ColorsOfEightBitsAreRecognised) {
  Las las;
  las.format = 2;
  las.record_bytes = 26;
  las.count = 300000;  // more than are examined at a time
  las.points.resize(las.count * 26u);
  put(las.points, 299999 * 26 + 22, number_bytes<std::uint16_t>(255));
  EXPECT_EQ(open(las)->describe(0).roles.rgb_maximum, 255);
  put(las.points, 299999 * 26 + 22, number_bytes<std::uint16_t>(256));
  EXPECT_EQ(open(las)->describe(0).roles.rgb_maximum, 65535);
}

TEST_F(DataLas, TheLongCountOfVersion14) {
  Las las;
  las.minor = 4;
  las.header_bytes = 375;
  las.count = 0;
  las.long_count = 3;
  las.points = record(20, 1, 0, 0) + record(20, 2, 0, 0) + record(20, 3, 0, 0);
  EXPECT_EQ(numbers(support::read_table(*open(las)), "x"), (std::vector<double>{0.01, 0.02, 0.03}));
  las.long_count = 0;
  las.count = 2;
  EXPECT_EQ(open(las)->describe(0).rows, 2u);
  las.long_count = std::uint64_t{1} << 63;
  EXPECT_NE(faults(las).find("declares 9223372036854775808 points of 20 bytes"), std::string::npos);
}

TEST_F(DataLas, BytesAfterThePointsAreAllowed) {
  Las las;
  las.count = 1;
  las.gap = std::string(10, 'x');
  las.points = record(20, 1, 2, 3) + "extended variable-length records";
  EXPECT_EQ(numbers(support::read_table(*open(las)), "y"), std::vector<double>{0.02});
}

std::unique_ptr<void, int (*)(void*)> las_library(const char* name) { return {dlopen(name, RTLD_NOW), dlclose}; }

bool has_laszip() { return las_library("liblaszip.so.8") != nullptr; }

TEST_F(DataLas, CompressedPointsAreRefusedWithoutTheLibrary) {
  if (has_laszip()) GTEST_SKIP() << "LASzip is installed";
  Las las;
  las.format = 0x80 | 3;
  las.record_bytes = 34;
  EXPECT_TRUE(
      test::mentions(faults(las), {"LAZ", "liblaszip8", "`laszip -i a.las -o a.las`", "`pdal translate a.las a.las`"}));
  las.format = 0x40;
  EXPECT_NE(faults(las).find("LAZ"), std::string::npos);
  las.format = 3;
  EXPECT_EQ(faults(las), "");
  std::string first(54, '\0'), second(54, '\0');
  put(first, 20, number_bytes<std::uint16_t>(7));
  put(second, 2, "laszip encoded");
  las.variable_records = 2;
  las.gap = first + "1234567" + second;
  EXPECT_NE(faults(las).find("LAZ"), std::string::npos);
  las.variable_records = 0xFFFFFFFF;
  put(las.gap, 54 + 7, std::string(16, ' '));
  EXPECT_EQ(faults(las), "") << "the number of records is limited by the space for them";
}

/// Points of random bytes.
Las random_las(int format) {
  constexpr std::uint16_t kBytes[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
  Las las;
  las.minor = format >= 6 ? 4 : 3;
  las.header_bytes = format >= 6 ? 375 : 235;
  las.format = static_cast<std::uint8_t>(format);
  las.record_bytes = kBytes[format];
  las.count = 100;
  std::mt19937 random(static_cast<std::uint32_t>(format));
  for (int i = 0; i < 100 * las.record_bytes; ++i) las.points += static_cast<char>(random());
  return las;
}

std::string bytes_of(const Table& table) {
  std::string out;
  for (const Column& column : table.columns) {
    out += column.name;
    for (std::size_t row = 0; row < table.rows; ++row) out += number_bytes(column.number(row));
  }
  return out;
}

TEST_F(DataLas, CompressedPointsHaveTheColumnsOfTheOthers) {
  if (has_laszip()) GTEST_SKIP() << "LASzip is installed";
  const auto library = las_library(ORRERY_LASZIP_STAND_IN);
  ASSERT_NE(library, nullptr);
  for (int format = 0; format <= 10; ++format) {
    Las las = random_las(format);
    const std::string expected = bytes_of(support::read_table(*open(las)));
    las.format |= 0x80;
    const auto file = open(las);
    EXPECT_STREQ(file->format, "LAZ");
    EXPECT_EQ(bytes_of(support::read_table(*file)), expected) << format;
    EXPECT_EQ(file->memory(), 100u * las.record_bytes);
  }
}

TEST_F(DataLas, CompressedPointsThatTheLibraryRefuses) {
  if (has_laszip()) GTEST_SKIP() << "LASzip is installed";
  const auto library = las_library(ORRERY_LASZIP_STAND_IN);
  Las las = random_las(3);
  las.format |= 0x80;
  las.points.pop_back();
  EXPECT_TRUE(test::mentions(faults(las), {"point 100 of 100: end-of-file\\x07is there", "truncated"}));
  las.count = 0xFFFFFFFF;
  EXPECT_TRUE(test::mentions(faults(las), {"4294967295 points decompress to more than 16.0 GiB"}));
  las.points.resize(7);
  EXPECT_TRUE(test::mentions(faults(las), {"4294967295 points", "the file has 242 bytes", "truncated"}));
  las = random_las(3);
  las.format |= 0x80;
  las.scale[1] = NAN;
  EXPECT_TRUE(test::mentions(faults(las), {"not finite"}));
}

/// Skipped where LASzip is not installed: the stand-in does not decompress.
TEST_F(DataLas, CompressedFilesOfLaszip) {
  if (!has_laszip()) GTEST_SKIP() << "LASzip is not installed";
  const std::filesystem::path seeds = ORRERY_ROOT "/tests/fuzz/corpus/data/laz";
  for (const std::string name : {"compressed3", "compressed7"})
    EXPECT_EQ(bytes_of(support::read_table(seeds / (name + ".laz"))),
              bytes_of(support::read_table(seeds / (name + ".las"))));
}

TEST_F(DataLas, WrongHeadersAreRefused) {
  Las good;
  good.count = 2;
  good.points = record(20, 1, 2, 3) + record(20, 1, 2, 3);
  ASSERT_EQ(faults(good), "");
  Las las = good;
  las.points.pop_back();
  EXPECT_TRUE(
      test::mentions(faults(las), {"header", "2", "20", "bytes", "227", "266", "bytes", "truncated", "header"}));
  las = good;
  las.count = 4294967295u;
  EXPECT_NE(faults(las), "");
  las = good;
  las.record_bytes = 19;
  EXPECT_TRUE(test::mentions(faults(las), {"19", "bytes", "format", "0", "20"}));
  las = good;
  las.format = 11;
  las.record_bytes = 90;
  EXPECT_TRUE(test::mentions(faults(las), {"format", "11", "0", "10"}));
  las = good;
  las.minor = 5;
  EXPECT_TRUE(test::mentions(faults(las), {"version", "1.5", "LAS", "1.0", "1.4"}));
  las = good;
  las.scale[1] = 0;
  EXPECT_TRUE(test::mentions(faults(las), {"coordinates", "finite"}));
  las.scale[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(faults(las), "");
  las = good;
  las.offset[2] = std::numeric_limits<double>::infinity();
  EXPECT_NE(faults(las), "");
  const std::string bytes = good.bytes();
  for (std::size_t size = 4; size < bytes.size(); size += 7) {
    support::write_bytes(folder_ / "cut.las", bytes.substr(0, size));
    EXPECT_NE(support::read_faults(folder_ / "cut.las"), "") << size;
  }
}

TEST_F(DataLas, AnAirborneScan) {
  const auto path = support::shared_data() / "autzen_trim.las";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is missing";
  const auto file = data::open(path);
  const FrameInfo info = file->describe(0);
  EXPECT_EQ(info.rows, 110000u);
  EXPECT_EQ(info.roles.rgb_maximum, 255);
  const Table table = support::read_table(*file);
  // The extent that the header of this file states.
  const auto x = numbers(table, "x"), y = numbers(table, "y"), z = numbers(table, "z");
  EXPECT_DOUBLE_EQ(*std::max_element(x.begin(), x.end()), 637179.22);
  EXPECT_DOUBLE_EQ(*std::min_element(x.begin(), x.end()), 636001.76);
  EXPECT_DOUBLE_EQ(*std::max_element(y.begin(), y.end()), 849497.90);
  EXPECT_DOUBLE_EQ(*std::min_element(z.begin(), z.end()), 406.26);
}

}  // namespace
}  // namespace orrery::data
