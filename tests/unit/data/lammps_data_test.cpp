// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "data/data_file.h"
#include "support/data_file_test.h"
#include "support/data_tables.h"
#include "support/shared_data.h"
#include "support/temp_dir.h"

namespace orrery::data {

namespace {

using support::column_names;
using support::data_errors;
using support::numbers;
using support::texts;
using Numbers = std::vector<double>;

const std::string kHead =
    "a title\n\n2 atoms # comment\n1 bonds\n2 atom types\n-1 3 xlo xhi\n0 5 ylo yhi\n1 7 zlo zhi\n\nMasses\n\n1 12\n2 "
    "1\n\n";

class DataLammpsData : public support::DataFileTest {
 protected:
  DataLammpsData() : DataFileTest("a.lmp") {}
  std::string errors(const std::string& text) { return data_errors(write(text)); }
};

TEST_F(DataLammpsData, ColumnsFollowFromTheStyle) {
  struct Case {
    const char* style;
    const char* row;
    Numbers xyz;
  };
  const Case cases[] = {
      {"atomic", "4 2 0.5 1 2", {0.5, 1, 2}},
      {"charge", "4 2 -1.5 0.5 1 2", {0.5, 1, 2}},
      {"molecular", "4 9 2 0.5 1 2", {0.5, 1, 2}},
      {"bond", "4 9 2 0.5 1 2", {0.5, 1, 2}},
      {"angle", "4 9 2 0.5 1 2", {0.5, 1, 2}},
      {"full", "4 9 2 -1.5 0.5 1 2", {0.5, 1, 2}},
      {"sphere", "4 2 1.25 7 0.5 1 2", {0.5, 1, 2}},
      {"bpm/sphere", "4 9 2 1.25 7 0.5 1 2", {0.5, 1, 2}},
      {"dipole", "4 2 -1.5 0.5 1 2 9 9 9", {0.5, 1, 2}},
  };
  for (const Case& c : cases)
    for (const bool has_images : {false, true}) {
      const std::string row = std::string(c.row) + (has_images ? " 0 -1 1\n" : "\n");
      const auto file = open(kHead + "Atoms  #  " + c.style + "\n\n" + row + row + "\nVelocities\n\n1 0 0 0\n");
      EXPECT_STREQ(file->format, "LAMMPS data");
      const FrameInfo info = file->describe(0);
      EXPECT_EQ(info.roles.image[0], has_images ? "ix" : "");
      const Table table = file->read(0, column_names(info));
      ASSERT_EQ(table.rows, 2u) << c.style;
      EXPECT_EQ(numbers(table, "id"), (Numbers{4, 4}));
      EXPECT_EQ(numbers(table, "type"), (Numbers{2, 2}));
      const char* const axes[] = {"x", "y", "z"};
      for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(numbers(table, axes[i])[1], c.xyz[i]) << c.style;
      if (has_images)
        EXPECT_EQ(numbers(table, "iy"), (Numbers{-1, -1}));
      else
        EXPECT_EQ(table.find("iy"), nullptr);
      if (!info.roles.radius.empty()) {
        EXPECT_EQ(numbers(table, info.roles.radius)[0] * info.roles.radius_scale, 0.625);
      }
      EXPECT_EQ(info.roles.radius.empty(), std::string(c.style).find("sphere") == std::string::npos);
    }
}

TEST_F(DataLammpsData, BoxAndTitleAreRead) {
  const FrameInfo info = open(kHead + "0.5 -1 2 xy xz yz\nAtoms # atomic\n\n1 1 0 0 0\n2 1 0 0 0\n")->describe(0);
  EXPECT_EQ(info.title, "a title");
  const Box box = info.box.value();
  EXPECT_EQ(box.origin.z, 1);
  EXPECT_EQ(box.edges[0].x, 4);
  EXPECT_EQ(box.edges[1].x, 0.5);
  EXPECT_EQ(box.edges[2].x, -1);
  EXPECT_EQ(box.edges[2].y, 2);
  EXPECT_EQ(box.edges[2].z, 6);
}

TEST_F(DataLammpsData, TypesMayBeLabels) {
  const auto file = open("\n2 atoms\n\nAtom Type Labels\n\n1 C\n2 H\n\nAtoms # atomic\n\n1 C 0 0 0\n2 H 0 0 0 # x\n");
  EXPECT_EQ(texts(file->read(0, {"type"}), "type"), (std::vector<std::string>{"C", "H"}));
}

TEST_F(DataLammpsData, StyleIsNotGuessed) {
  EXPECT_EQ(errors(kHead + "Atoms\n\n1 1 0 0 0 0 0\n2 1 0 0 0 0 0\n"),
            "15: the section \"Atoms\" does not name its style, which determines the meaning of its columns\n");
  EXPECT_EQ(errors(kHead + "Atoms # body\n\n1 1 0 0 0 0 0\n"), "15: atom style \"body\" is not supported\n");
}

TEST_F(DataLammpsData, ErrorsHaveLines) {
  const std::string atoms = "Atoms # atomic\n\n";
  EXPECT_EQ(errors(kHead + atoms + "1 1 0 0 0\n2 1 0 0\n"), "18: has 4 values, not 5\n");
  EXPECT_EQ(errors(kHead + atoms + "1 1 0 0 0\n"), "18: the file ends after 1 of 2 rows\n");
  EXPECT_EQ(errors(kHead + atoms + "1 1 0 0 0\n2 1 0 0 0\n3 1 0 0 0\n"), "19: more rows than 2 atoms\n");
  EXPECT_EQ(errors(kHead), "0: no section \"Atoms\"\n");
  EXPECT_EQ(errors("\n2 atoms\n0 x xlo xhi\n"), "3: 'x' is not a number\n");
  EXPECT_EQ(errors("\n2 atoms\n1 0 xlo xhi\n"), "3: a lower bound of the box exceeds the upper bound\n");
}

TEST_F(DataLammpsData, ReadsFilesOfOtherPrograms) {
  const auto folder = support::shared_data() / "lammps-data";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) EXPECT_EQ(data_errors(entry.path()), "");
  const auto file = data::open(folder / "molid.lmp");
  EXPECT_EQ(numbers(file->read(0, {"mol", "x"}), "x")[2], 8.506);
  EXPECT_EQ(data::open(folder / "triclinic-2.lmp")->describe(0).box->edges[2].x, -8);
  EXPECT_EQ(data::open(folder / "triclinic-1.lmp")->read(0, {"x"}).rows, 0u);
}

const std::string kBonded =
    "t\n3 atoms\n3 bonds\n\nAtoms # bond\n\n7 1 1 0 0 0\n5 1 1 1 0 0\n6 1 1 2 0 0\n\nVelocities\n\n7 0 0 0\n5 0 0 "
    "0\n6 0 0 0\n\nBonds # stiff\n\n";

TEST_F(DataLammpsData, BondsArePairsOfRows) {
  const auto file = open(kBonded + "1 1 6 7 # a comment\n2 label 5 7\n3 1 7 5\n\nAngles\n\n1 1 5 6 7\n");
  EXPECT_EQ(file->describe(0).bonds, 3u);
  EXPECT_TRUE(file->describe(0).lists_all_bonds);
  EXPECT_EQ(support::bonds_text(*file), "0-1 0-2");
  const auto without = open("t\n1 atoms\n\nAtoms # atomic\n\n1 1 0 0 0\n");
  EXPECT_EQ(without->describe(0).bonds, 0u);
  EXPECT_EQ(support::bonds_text(*without), "");
}

TEST_F(DataLammpsData, BadBondsAreRefusedWithTheirLine) {
  const auto faults = [&](const std::string& rows) { return support::bond_faults(*open(kBonded + rows)); };
  EXPECT_EQ(
      faults("1 1 6 7\n2 1 8 7\n3 1 5 5\n"),
      "20: a bond of atom 8, which does not exist\n21: a bond of atom 5 with itself\n0: the bonds of this file are "
      "damaged\n");
  EXPECT_NE(faults("1 1 6 7\n").find("the file ends after 1 of 3 rows"), std::string::npos);
  EXPECT_NE(faults("1 1 6 7\n1 1 6 7\n1 1 6 7\n1 1 6 7\n").find("22: more rows than 3 bonds"), std::string::npos);
  EXPECT_EQ(support::bond_faults(*open("t\n2 atoms\n9 bonds\n\nAtoms # atomic\n\n1 1 0 0 0\n2 1 0 0 0\n")),
            "0: no section \"Bonds\", but a line \"9 bonds\"\n");
  EXPECT_EQ(
      support::bond_faults(*open("t\n2 atoms\n1 bonds\n\nAtoms # atomic\n\n1 1 0 0 0\n1 1 0 0 0\nBonds\n\n1 1 1 2\n")),
      "11: a bond of atom 1, but several atoms have this number\n11: a bond of atom 2, which does not exist\n0: the "
      "bonds of this file are damaged\n");
  EXPECT_NE(errors("t\n1 atoms\n-1 bonds\n\nAtoms # atomic\n\n1 1 0 0 0\n").find("3: '-1' is not a number of bonds"),
            std::string::npos);
}

TEST_F(DataLammpsData, TheBondsOfOneAtomAreLimited) {
  const auto star = [&](int arms) {
    std::string atoms, bonds;
    for (int i = 0; i <= arms; ++i) atoms += std::to_string(i) + " 1 0 0 0\n";
    for (int i = 1; i <= arms; ++i) bonds += "1 1 " + std::to_string(i) + " 0\n";
    const std::string count = std::to_string(arms + 1);
    return open("t\n" + count + " atoms\n" + std::to_string(arms) + " bonds\n\nAtoms # atomic\n\n" + atoms +
                "\nBonds\n\n" + bonds);
  };
  std::vector<std::string> warnings;
  EXPECT_EQ(star(1000)->bonds(0, warnings).size(), 1000u);
  EXPECT_EQ(support::bond_faults(*star(1001)), "0: row 1 has more than 1000 bonds\n");
}

}  // namespace
}  // namespace orrery::data
