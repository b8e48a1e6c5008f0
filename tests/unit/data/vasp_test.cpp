// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
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

const std::string kVectors = "2 0 0\n0 3 0\n1 0 4\n";

/// The files of VASP have no extensions.
class DataVasp : public support::DataFileTest {
 protected:
  DataVasp() : DataFileTest("POSCAR") {}
};

TEST_F(DataVasp, DirectCoordinatesAreInUnitsOfTheCell) {
  const auto file = open("salt\n2.0\n" + kVectors + "Na Cl_GW/0a1b\n1 2\nDirect\n0 0 0\n.5 .5 .5 comment\n0 0 1\n");
  EXPECT_STREQ(file->format, "VASP");
  const FrameInfo info = file->describe(0);
  EXPECT_EQ(info.title, "salt");
  EXPECT_TRUE(info.is_unit_cell);
  EXPECT_EQ(info.roles.element, "element");
  EXPECT_EQ(info.box->edges[2], (Vec3d{2, 0, 8}));
  const Table table = support::read_table(*file);
  EXPECT_EQ(texts(table, "element"), (Texts{"Na", "Cl", "Cl"}));
  EXPECT_EQ(numbers(table, "x"), (Numbers{0, 3, 2}));
  EXPECT_EQ(numbers(table, "z"), (Numbers{0, 4, 8}));
  EXPECT_EQ(numbers(table, "fract_y"), (Numbers{0, .5, 0}));
  EXPECT_EQ(numbers(file->read(0, {"y"}), "y"), (Numbers{0, 3, 0}));
}

TEST_F(DataVasp, CartesianCoordinatesAreScaled) {
  const std::string text = kVectors + "Na\n1\nSelective dynamics\nCartesian\n1 2 3 T F T\n\n0.1 0.2 0.3\n";
  EXPECT_EQ(numbers(open("a\n2.0\n" + text)->read(0, {"z", "x"}), "z"), Numbers{6}) << "velocities are not read";
  // The cell has a volume of 24, which a negative factor sets.
  const auto file = open("a\n-192\n" + text);
  EXPECT_NEAR(numbers(file->read(0, {"x"}), "x").at(0), 2, 1e-12);
  EXPECT_NEAR(file->describe(0).box->edges[0].x, 4, 1e-12);
  EXPECT_EQ(file->frame_count(), 1);
}

TEST_F(DataVasp, KindsThatAreNoElementsAreTypes) {
  const auto file = open("a\n1\n" + kVectors + "A B\n1 1\nDirect\n0 0 0\n.5 .5 .5\n");
  EXPECT_EQ(file->describe(0).roles.element, "");
  EXPECT_EQ(file->describe(0).roles.type, "type");
  EXPECT_EQ(texts(file->read(0, {"type"}), "type"), (Texts{"A", "B"}));
}

TEST_F(DataVasp, TrajectoriesHaveTheCellOnceOrInEachFrame) {
  const std::string head = "t\n1\n" + kVectors + "Si\n1\n";
  const auto fixed = open(head + "Direct configuration=     1\n0 0 .25\nDirect configuration=     3\n0 0 .5\n");
  ASSERT_EQ(fixed->frame_count(), 2);
  EXPECT_EQ(fixed->describe(1).step, 3);
  EXPECT_EQ(numbers(fixed->read(1, {"z"}), "z"), Numbers{2});
  EXPECT_EQ(numbers(fixed->read(0, {"z"}), "z"), Numbers{1});
  const std::string larger = "t\n2\n" + kVectors + "Si\n1\n";
  const auto changing = open(head + "Direct configuration= 1\n0 0 .5\n" + larger + "Direct configuration= 2\n0 0 .5\n");
  ASSERT_EQ(changing->frame_count(), 2);
  EXPECT_EQ(numbers(changing->read(1, {"z"}), "z"), Numbers{4});
}

TEST_F(DataVasp, FaultsAreNamedWithARemedy) {
  const auto text_of = [&](const std::string& text) { return error_of(text).text; };
  const base::Diagnostic old = error_of("a\n1\n" + kVectors + "1 2\nDirect\n0 0 0\n");
  EXPECT_NE(old.text.find("VASP 4"), std::string::npos) << old.text;
  EXPECT_EQ(old.line, 6u);
  EXPECT_NE(old.remedy.find("insert"), std::string::npos);
  const std::string rest = "Si\n1\nDirect\n0 0 0\n";
  EXPECT_NE(text_of("a\n0\n" + kVectors + rest).find("no volume"), std::string::npos);
  EXPECT_NE(text_of("a\n1\n1 0 0\n2 0 0\n0 0 1\n" + rest).find("no volume"), std::string::npos);
  EXPECT_NE(text_of("a\n1 2 1\n" + kVectors + rest).find("three different"), std::string::npos);
  EXPECT_NE(text_of("a\n1\n" + kVectors + "Si O\n1\nDirect\n0 0 0\n").find("expected 2 numbers"), std::string::npos);
  EXPECT_NE(text_of("a\n1\n" + kVectors + "Si\n1\nSpherical\n0 0 0\n").find("Direct"), std::string::npos);
  EXPECT_NE(text_of("a\n1\n" + kVectors + "Si\n2\nDirect\n0 0 0\n").find("1 of 2"), std::string::npos);
  EXPECT_NE(text_of("a\n1\n" + kVectors + "Si\n1\nDirect\n0 b 0\n").find("'b'"), std::string::npos);
  EXPECT_NE(text_of("a\n1\n" + kVectors + "Si\n9223372036854775807\nDirect\n0 0 0\n").find("too many"),
            std::string::npos);
  const std::string frames = "t\n1\n" + kVectors + "Si\n1\nDirect configuration= 1\n0 0 0\n";
  EXPECT_NE(text_of(frames + "0 0 1\nDirect configuration= 2\n0 0 0\n").find("more rows"), std::string::npos);
}

}  // namespace

}  // namespace orrery::data
