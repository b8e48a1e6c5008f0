// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/error.h"
#include "data/data_file.h"
#include "support/data_file_test.h"
#include "support/data_tables.h"

namespace orrery::data {

namespace {

using support::numbers;
using support::texts;
using Numbers = std::vector<double>;
using Texts = std::vector<std::string>;

const std::string kWaterFile =
    "water t=   2.50000 step= 500\n    3\n"
    "    1SOL     OW    1   0.230   0.628   0.113  0.1000  0.2000 -0.5000\n"
    "    1SOL    HW1    2   0.137   0.626   0.150  0.0000  0.0000  0.0000\n"
    "99999NA      NA99999 -10.231  10.589   0.000  0.0000  0.0000  0.0000\n"
    "   2.00000   3.00000   4.00000\n";

class DataGro : public support::DataFileTest {
 protected:
  DataGro() : DataFileTest("a.gro") {}
};

TEST_F(DataGro, FixedColumnsAreReadInAngstrom) {
  const auto file = open(kWaterFile);
  EXPECT_STREQ(file->format, "GRO");
  const FrameInfo info = file->describe(0);
  EXPECT_EQ(info.step, 500);
  EXPECT_EQ(info.header.at(0), (std::pair<std::string, double>("time", 2.5)));
  EXPECT_EQ(info.box->edges[1], (Vec3d{0, 30, 0}));
  const Table table = support::read_table(*file);
  EXPECT_EQ(texts(table, "element"), (Texts{"O", "H", "Na"}));
  EXPECT_EQ(texts(table, "name"), (Texts{"OW", "HW1", "NA"}));
  EXPECT_EQ(texts(table, "residue"), (Texts{"SOL", "SOL", "NA"}));
  EXPECT_EQ(numbers(table, "residue_number"), (Numbers{1, 1, 99999}));
  EXPECT_EQ(numbers(table, "x").at(2), static_cast<double>(-10.231F * 10.0F));
  EXPECT_EQ(numbers(table, "velocity[3]").at(0), -5);
}

TEST_F(DataGro, ColumnsAreAsWideAsTheDecimalPointsSay) {
  const auto file = open("precise\n1\n    1SOL     OW    1   0.23012   0.62812   0.11312\n 1 1 1 0 0 0.5 0 0 0\n");
  EXPECT_NEAR(numbers(file->read(0, {"y"}), "y").at(0), 6.2812, 1e-6);
  EXPECT_FALSE(find_named(file->describe(0).columns, "velocity[1]"));
  EXPECT_EQ(file->describe(0).box->edges[1], (Vec3d{5, 10, 0}));
}

TEST_F(DataGro, FramesFollowEachOther) {
  const auto file = open(kWaterFile + kWaterFile);
  ASSERT_EQ(file->frame_count(), 2);
  EXPECT_EQ(file->read(1, {"x"}).rows, 3u);
  EXPECT_EQ(file->describe(0).rows, 3u);
}

TEST_F(DataGro, FaultsAreNamedWithTheirLine) {
  const auto error = [&](std::string text, const std::string& what, const std::string& by) {
    return error_of(text.replace(text.find(what), what.size(), by));
  };
  EXPECT_NE(error(kWaterFile, "0.626", "0.x26").text.find("malformed"), std::string::npos);
  EXPECT_EQ(error(kWaterFile, "0.626", "0.x26").line, 4u);
  EXPECT_NE(error_of(kWaterFile.substr(0, kWaterFile.find("99999"))).text.find("after 2 of 3 atoms"),
            std::string::npos);
  EXPECT_NE(error_of(kWaterFile.substr(0, kWaterFile.find("   2.00000"))).text.find("box"), std::string::npos);
  EXPECT_NE(error(kWaterFile, "    3\n", "    2\n").text.find("box"), std::string::npos);
  EXPECT_NE(error(kWaterFile, "    3\n", "90000000\n").text.find("truncated"), std::string::npos);
  EXPECT_NE(error(kWaterFile, "   3.00000", "       nan").text.find("box"), std::string::npos);
}

}  // namespace

}  // namespace orrery::data
