// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "base/error.h"
#include "data/data_file.h"
#include "support/data_file_test.h"
#include "support/data_tables.h"

namespace orrery::data {

namespace {

using support::number_bytes;
using support::numbers;
using Numbers = std::vector<double>;

/// Writes DCD files of two atoms.
struct DcdWriter {
  bool is_big_endian = false, has_cell = true, has_fourth = false;
  std::uint32_t fixed = 0, version = 24;
  std::array<double, 6> cell = {10, 90, 20, 90, 90, 30};

  std::string record(const std::string& bytes) const {
    const std::string mark = number_bytes(static_cast<std::uint32_t>(bytes.size()), is_big_endian);
    return mark + bytes + mark;
  }
  std::string file(int frames = 1) const {
    std::string head = "CORD";
    for (std::uint32_t i = 0; i < 20; ++i)
      head += number_bytes(i == 1    ? 100U
                           : i == 2  ? 50U
                           : i == 8  ? fixed
                           : i == 10 ? std::uint32_t{has_cell}
                           : i == 11 ? std::uint32_t{has_fourth}
                           : i == 19 ? version
                                     : 0U,
                           is_big_endian);
    std::string out = record(head) + record(number_bytes(1U, is_big_endian) + std::string(80, ' ')) +
                      record(number_bytes(2U, is_big_endian));
    for (int frame = 0; frame < frames; ++frame) {
      std::string box;
      for (const double x : cell) box += number_bytes(x, is_big_endian);
      if (has_cell) out += record(box);
      for (int axis = 0; axis < 3 + has_fourth; ++axis)
        out += record(number_bytes(static_cast<float>(frame + axis) + 0.5F, is_big_endian) +
                      number_bytes(static_cast<float>(-axis), is_big_endian));
    }
    return out;
  }
};

class DataDcd : public support::DataFileTest {
 protected:
  DataDcd() : DataFileTest("a.dcd") {}
};

TEST_F(DataDcd, BothByteOrdersAreRead) {
  for (const bool is_big_endian : {false, true}) {
    const auto file = open(DcdWriter{.is_big_endian = is_big_endian}.file(3));
    EXPECT_STREQ(file->format, "DCD");
    ASSERT_EQ(file->frame_count(), 3);
    EXPECT_EQ(file->describe(2).step, 200);
    EXPECT_EQ(file->describe(2).box->edges[1], (Vec3d{0, 20, 0}));
    const Table table = support::read_table(*file, 2);
    EXPECT_EQ(numbers(table, "x"), (Numbers{2.5, 0}));
    EXPECT_EQ(numbers(table, "z"), (Numbers{4.5, -2}));
  }
}

TEST_F(DataDcd, CellsHaveAnglesCosinesOrAMatrix) {
  const auto edges = [&](const std::array<double, 6>& cell) {
    return open(DcdWriter{.cell = cell}.file())->describe(0).box;
  };
  const auto angles = edges({10, 120, 20, 90, 90, 30}), cosines = edges({10, -0.5, 20, 0, 0, 30});
  EXPECT_NEAR(angles->edges[1].x, -10, 1e-9);
  EXPECT_NEAR(angles->edges[1].y, 20 * std::sqrt(0.75), 1e-9);
  EXPECT_NEAR(math::length(angles->edges[1] - cosines->edges[1]), 0, 1e-9);
  EXPECT_EQ(edges({10, -1.5, 20, 0, 0, 30})->edges[1], (Vec3d{-1.5, 20, 0}));
  EXPECT_FALSE(edges({0, 90, 0, 90, 90, 0})) << "without a box";
}

TEST_F(DataDcd, OtherRecordsAreSkipped) {
  const auto four = open(DcdWriter{.has_fourth = true}.file(2));
  ASSERT_EQ(four->frame_count(), 2);
  EXPECT_EQ(numbers(four->read(1, {"y"}), "y"), (Numbers{2.5, -1}));
  const auto none = open(DcdWriter{.has_cell = false}.file(2));
  EXPECT_FALSE(none->describe(1).box);
  EXPECT_EQ(numbers(none->read(1, {"y"}), "y"), (Numbers{2.5, -1}));
  EXPECT_EQ(open(DcdWriter{.has_cell = false, .version = 0}.file(2))->frame_count(), 2) << "X-PLOR";
}

TEST_F(DataDcd, DamageIsNamed) {
  const std::string good = DcdWriter().file(2);
  const auto error = [&](const std::string& text) { return error_of(text).text; };
  EXPECT_NE(error(good.substr(0, 50)).find("header"), std::string::npos);
  EXPECT_NE(error(good.substr(0, good.size() - 100)).find(""), std::string::npos);
  const auto file = open(good.substr(0, good.size() - 20));
  EXPECT_EQ(file->frame_count(), 2);
  EXPECT_EQ(file->read(0, {"x"}).rows, 2u);
  EXPECT_THROW(file->read(1, {"x"}), base::Error);
  EXPECT_NE(error(DcdWriter{.fixed = 1}.file()).find("1 atoms are fixed"), std::string::npos);
  EXPECT_NE(error(DcdWriter{.cell = {10, NAN, 20, 90, 90, 30}}.file()).find("not finite"), std::string::npos);
  std::string other = good;  // the length of the first record of positions
  const std::size_t at = good.size() / 2;
  EXPECT_NE(error(other.replace(other.size() - 2 * (56 + 3 * 16) + 56, 4, number_bytes(12U))).find("instead of 8"),
            std::string::npos)
      << at;
}

}  // namespace

}  // namespace orrery::data
