// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "data/data_file.h"
#include "support/data_file_test.h"
#include "support/data_tables.h"
#include "support/mentions.h"
#include "support/shared_data.h"
#include "support/temp_dir.h"

namespace orrery::data {

namespace {

using support::column_names;
using support::data_errors;
using support::numbers;
using support::texts;
using Numbers = std::vector<double>;
using Texts = std::vector<std::string>;

class DataXyz : public support::DataFileTest {
 protected:
  DataXyz() : DataFileTest("a.xyz") {}
  std::string errors(const std::string& text) { return data_errors(write(text)); }
};

TEST_F(DataXyz, PlainFilesHaveElementsAndPositions) {
  const auto file = open("2\nwater\nH 1 2 3\nO\t-1.5 0 1e1 rest\n\n");
  EXPECT_STREQ(file->format, "XYZ");
  EXPECT_EQ(file->frame_count(), 1);
  const FrameInfo info = file->describe(0);
  EXPECT_EQ(info.title, "water");
  EXPECT_EQ(info.roles.element, "element");
  EXPECT_EQ(info.roles.type, "");
  EXPECT_FALSE(info.box);
  const Table table = file->read(0, column_names(info));
  EXPECT_EQ(texts(table, "element"), (Texts{"H", "O"}));
  EXPECT_EQ(numbers(table, "x"), (Numbers{1, -1.5}));
  EXPECT_EQ(numbers(table, "z"), (Numbers{3, 10}));
}

TEST_F(DataXyz, PlainFilesMayHaveMoreColumns) {
  const auto file = open("2\n\nH 1 2 3 0.5 a\nO 1 2 3 0.25 b c\n");
  EXPECT_EQ(column_names(file->describe(0)), (Texts{"element", "x", "y", "z", "column5", "column6"}));
  const Table table = file->read(0, {"column5", "column6"});
  EXPECT_EQ(numbers(table, "column5"), (Numbers{0.5, 0.25}));
  EXPECT_EQ(texts(table, "column6"), (Texts{"a", "b"}));
  // Columns that are not requested may be missing.
  EXPECT_EQ(open("2\n\nH 1 2 3 0.5\nO 1 2 3\n")->read(0, {"x"}).rows, 2u);
}

TEST_F(DataXyz, NamesAreElementsOnlyIfAllAre) {
  for (const std::string names : {"A B", "C1 H2", "C X", "LJ LJ"}) {
    const std::string a = names.substr(0, names.find(' ')), b = names.substr(names.find(' ') + 1);
    const auto plain = open("2\n\n" + a + " 1 2 3\n" + b + " 1 2 3\n");
    EXPECT_EQ(plain->describe(0).roles.element, "") << names;
    EXPECT_EQ(plain->describe(0).roles.type, "type") << names;
    EXPECT_EQ(texts(plain->read(0, {"type"}), "type"), (Texts{a, b}));
    const auto extended = open("2\nProperties=pos:R:3:species:S:1\n1 2 3 " + a + "\n1 2 3 " + b + "\n");
    EXPECT_EQ(extended->describe(0).roles.element, "") << names;
    EXPECT_EQ(extended->describe(0).roles.type, "species") << names;
  }
  EXPECT_EQ(open("3\n\nC 1 2 3\nfe 1 2 3\nD 1 2 3\n")->describe(0).roles.element, "element");
}

/// Otherwise, radii and colours would change within an animation.
TEST_F(DataXyz, TheFirstFrameWithAtomsDecidesWhatNamesAre) {
  const std::string empty = "0\n\n", types = "2\n\nA 1 2 3\nC 1 2 3\n", carbon = "1\n\nC 1 2 3\n";
  const auto file = open(empty + types + carbon);
  for (const int frame : {2, 0, 1}) {
    EXPECT_EQ(file->describe(frame).roles.type, "type") << frame;
    EXPECT_EQ(column_names(file->describe(frame)).at(0), "type") << frame;
  }
  EXPECT_EQ(open(empty + carbon + types)->describe(2).roles.element, "element");
}

TEST_F(DataXyz, NumbersInThePlaceOfElementsAreTypes) {
  const auto file = open("1\nAtoms. Timestep: 0\n2 1 2 3\n");
  EXPECT_EQ(file->describe(0).roles.type, "type");
  EXPECT_EQ(file->describe(0).roles.element, "");
  EXPECT_EQ(numbers(file->read(0, {"type"}), "type"), (Numbers{2}));
}

TEST_F(DataXyz, ExtendedFilesDeclareTheirColumns) {
  const auto file = open(
      "2\nLattice=\"1 0 0 0.5d0 2 0 0 0 3D0\" Origin=\"-1 -2 -3\" pbc=\"T F 1\" Timestep=40 "
      "Properties=species:S:1:pos:R:3:id:I:1:radius:R:1:color:R:3:forces:R:2:fixed:L:1\n"
      "Si 1 2 3 7 0.5 1 0.5 0 10 20 T\nO 4 5 6 8 0.25 0 0 0 1d1 2D-1 F\n");
  const FrameInfo info = file->describe(0);
  EXPECT_EQ(column_names(info), (Texts{"species", "x", "y", "z", "id", "radius", "color[1]", "color[2]", "color[3]",
                                       "forces[1]", "forces[2]", "fixed"}));
  EXPECT_EQ(info.roles.element, "species");
  EXPECT_EQ(info.roles.id, "id");
  EXPECT_EQ(info.roles.radius, "radius");
  EXPECT_EQ(info.roles.rgb[2], "color[3]");
  EXPECT_EQ(info.roles.rgb_maximum, 1);
  EXPECT_EQ(info.step, 40);
  const Box box = info.box.value();
  EXPECT_EQ(box.edges[1].x, 0.5);
  EXPECT_EQ(box.edges[2].z, 3);
  EXPECT_EQ(box.origin.y, -2);
  EXPECT_EQ(box.periodic, (std::array<bool, 3>{true, false, true}));
  const Table table = file->read(0, column_names(info));
  EXPECT_EQ(numbers(table, "y"), (Numbers{2, 5}));
  EXPECT_EQ(numbers(table, "forces[1]"), (Numbers{10, 10}));
  EXPECT_EQ(numbers(table, "forces[2]"), (Numbers{20, 0.2}));
  EXPECT_EQ(texts(table, "fixed"), (Texts{"T", "F"}));
}

TEST_F(DataXyz, ColumnsOfOneNameAreNumbered) {
  const auto file = open("1\nProperties=x:R:1:pos:R:3:v:R:1:v:R:1\n9 1 2 3 4 5\n");
  const FrameInfo info = file->describe(0);
  EXPECT_EQ(column_names(info), (Texts{"x", "x_2", "y", "z", "v", "v_2"}));
  EXPECT_EQ(info.roles.position[0], "x_2");
  EXPECT_EQ(numbers(file->read(0, {"x_2", "v_2"}), "v_2"), (Numbers{5}));
}

TEST_F(DataXyz, RolesHaveTheTypeThatTheyNeed) {
  const Roles roles = open("1\nProperties=species:R:1:pos:R:3:id:S:1:radius:L:1\n0.5 1 2 3 a T\n")->describe(0).roles;
  EXPECT_EQ(roles.type, "species") << "a number is no element";
  EXPECT_EQ(roles.element + roles.id + roles.radius, "");
}

TEST_F(DataXyz, ExtendedFilesAreRecognisedByTheirContent) {
  support::write_bytes(folder_ / "frame", "1\nProperties=species:S:1:pos:R:3\nH 0 0 0\n");
  EXPECT_STREQ(data::open(folder_ / "frame")->format, "XYZ");
}

TEST_F(DataXyz, ValuesMayBeQuotedInManyWays) {
  const std::string columns = "species:S:1:pos:R:3";
  for (const std::string& comment :
       {"flag Properties=" + columns + " step=7", "Properties = \"" + columns + "\" e=\"a \\\"b\\\"\" step='7'",
        "Properties={" + columns + "} Step={7} f= g=2 ", "Properties=[" + columns + "] d=[[1,2],[3,4]] step=[7]",
        "\"Properties\"='" + columns + "' \"quoted key\"='x' 'step'=\"7\""}) {
    const FrameInfo info = open("1\n" + comment + "\nH 1 2 3\n")->describe(0);
    EXPECT_EQ(support::columns_text(info), "species:text x:float64 y:float64 z:float64") << comment;
    EXPECT_EQ(info.step, 7) << comment;
  }
  for (const char* const odd : {"=", "= =", "a=\"", "{", "a=[[", "\"", "a={b", "= \"", "\\", "a=\"\\"})
    EXPECT_EQ(errors(std::string("1\n") + odd + "\nH 1 2 3\n"), "") << odd;
}

TEST_F(DataXyz, NumbersOfTheCommentAreInTheHeader) {
  using Header = std::vector<std::pair<std::string, double>>;
  const std::string extended = "1\nProperties=pos:R:3 energy=-3.5 name=5x pbc=\"T T T\" cutoff=inf time=2d1\n1 2 3\n";
  EXPECT_EQ(open(extended)->describe(0).header, (Header{{"energy", -3.5}, {"time", 20}}));
  const FrameInfo plain = open("1\n i = 5, time = 2.5, E = -17.1\nH 1 2 3\n")->describe(0);
  EXPECT_EQ(plain.header, (Header{{"E", -17.1}, {"i", 5}, {"time", 2.5}})) << "as CP2K writes it";
}

TEST_F(DataXyz, LatticeMayBeNested) {
  const Box box =
      open("1\nLattice=[[1,2,3], [4,5,6], [7,8,9]] pbc=[T, F, T] Properties=pos:R:3\n1 2 3\n")->describe(0).box.value();
  EXPECT_EQ(box.edges[1].x, 4);
  EXPECT_EQ(box.edges[2].z, 9);
  EXPECT_EQ(box.periodic, (std::array<bool, 3>{true, false, true}));
}

TEST_F(DataXyz, FramesAreReadInAnyOrder) {
  std::string text;
  for (int frame = 0; frame < 100; ++frame) {
    text += std::to_string(frame) + "\nframe " + std::to_string(frame) + "\r\n";
    for (int row = 0; row < frame; ++row) text += "He " + std::to_string(frame) + " 0 0\n";
    if (frame % 7 == 0) text += "\n";
  }
  const auto file = open(text);
  EXPECT_EQ(file->frame_count(), 100);
  for (const int frame : {99, 0, 7, 8, 50}) {
    EXPECT_EQ(file->describe(frame).title, "frame " + std::to_string(frame));
    EXPECT_EQ(numbers(file->read(frame, {"x"}), "x"), Numbers(static_cast<std::size_t>(frame), frame));
  }
}

TEST_F(DataXyz, FramesMayBeginAnywhereInABlockOfTheFile) {
  constexpr std::size_t kBlock = 16384;  // of TextCursor
  for (std::size_t length = kBlock - 40; length < kBlock + 10; ++length) {
    const auto file = open("1\n" + std::string(length, 'x') + "\nHe 1 0 0\n2\nsecond\nHe 2 0 0\nHe 2 0 0\n");
    ASSERT_EQ(file->frame_count(), 2);
    ASSERT_EQ(file->describe(1).title, "second");
  }
}

TEST_F(DataXyz, ErrorsHaveLines) {
  EXPECT_TRUE(test::mentions(errors("1\n\nH 1 2 3\n-1\n\n"), {"4", "number", "-1"}));
  EXPECT_TRUE(test::mentions(errors("2\n\nH 1 2 3\n"), {"4", "ends", "1", "2", "rows"}));
  EXPECT_TRUE(test::mentions(errors("1\n\nH 1 2 3\nH 1 2 3\n"), {"4", "number", "H 1 2 3"}));
  EXPECT_TRUE(test::mentions(errors("1\n\nH 1 2 b\n"), {"3", "column", "4", "b", "number"}));
  EXPECT_EQ(errors("2\n\nH 1 2 3\nH 1 2\n"), "4: the row has 3 values, not 4\n");
  EXPECT_TRUE(test::mentions(errors("1\nProperties=species:S:1:pos:R:3\nH 1 2 3 4\n"), {"3", "4"}));
  EXPECT_TRUE(test::mentions(errors("1\nProperties=species:S:1\nH\n"), {"2", "positions"}));
  EXPECT_TRUE(test::mentions(errors("1\nProperties=pos:R:2\n1 2\n"), {"2", "3"}));
  EXPECT_TRUE(test::mentions(errors("1\nProperties=pos:R:3:a:R:9999999\n1 2 3\n"),
                             {"2", "9999999", "number", "columns", "4096"}));
  for (const char* title : {"Si crystal, lattice=5.43", "Si lattice relaxed", "pbc = xyz, lattice = 5"})
    EXPECT_EQ(errors(std::string("1\n") + title + "\nH 1 2 3\n"), "") << "a sentence";
  EXPECT_TRUE(test::mentions(errors("1\nLattice=\"1 2 3\"\nH 1 2 3\n"), {"2", "`Lattice`", "9", "numbers"}));
  EXPECT_TRUE(test::mentions(errors("1\nLattice=\"1 0 0 0 1 0 0 0 1\" pbc=\"T X F\"\nH 1 2 3\n"), {"2", "X"}));
}

TEST_F(DataXyz, DiametersAreHalved) {
  const auto roles = [&](const std::string& properties, const std::string& row) {
    return open("1\nProperties=" + properties + "\n" + row + "\n")->describe(0).roles;
  };
  EXPECT_EQ(roles("pos:R:3:diameter:R:1", "1 2 3 4").radius, "diameter");
  EXPECT_EQ(roles("pos:R:3:diameter:R:1", "1 2 3 4").radius_scale, 0.5);
  EXPECT_EQ(roles("pos:R:3:diameter:R:1:radius:R:1", "1 2 3 4 5").radius, "radius");
  EXPECT_EQ(roles("pos:R:3:diameter:R:1:radius:R:1", "1 2 3 4 5").radius_scale, 1);
  EXPECT_EQ(roles("pos:R:3:diameter:S:1", "1 2 3 x").radius, "");
}

TEST_F(DataXyz, ColorsByName) {
  const Roles roles = open("1\nProperties=pos:R:3:red:I:1:green:I:1:blue:I:1\n1 2 3 255 0 128\n")->describe(0).roles;
  EXPECT_EQ(roles.rgb[2], "blue");
  EXPECT_EQ(roles.rgb_maximum, 255);
}

TEST_F(DataXyz, RowsAfterTheFrameAreNotIgnored) {
  const auto file = open("1\n\nH 1 2 3\nH 1 2 3\n");
  try {
    file->read(0, {"x"});
    FAIL();
  } catch (const base::Error& error) {
    EXPECT_EQ(error.diagnostics().at(0).line, 4);
    EXPECT_EQ(error.diagnostics().at(0).text, "more rows than line 1 declares");
  }
}

TEST_F(DataXyz, ReadsFilesOfOtherPrograms) {
  const auto folder = support::shared_data() / "xyz";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder;
  for (const char* const name : {"extended.xyz", "methane.xyz", "spaces.xyz", "trajectory.xyz"})
    EXPECT_EQ(data_errors(folder / name), "");
  const auto file = data::open(folder / "extended.xyz");
  EXPECT_EQ(numbers(file->read(0, {"CS[2]"}), "CS[2]")[0], 31.34);
}

TEST_F(DataXyz, MalformedFilesOfOtherProgramsAreRefused) {
  const auto folder = support::shared_data() / "xyz" / "bad";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) EXPECT_NE(data_errors(entry.path()), "");
}

}  // namespace
}  // namespace orrery::data
