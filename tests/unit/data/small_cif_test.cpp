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
using Texts = std::vector<std::string>;

const std::string kCell =
    "_cell_length_a 5.64(1)\n_cell_length_b 5.64\n_cell_length_c 5.64\n_cell_angle_alpha 90\n_cell_angle_beta 90\n"
    "_cell_angle_gamma 90.0(2)\n";
const std::string kSites =
    "loop_\n_atom_site_label\n_atom_site_type_symbol\n_atom_site_fract_x\n_atom_site_fract_y\n_atom_site_fract_z\n"
    "_atom_site_occupancy\n_atom_site_disorder_assembly\n_atom_site_disorder_group\n";
const std::string kSalt = kSites + "Na1 Na1+ 0 0 0 1 . .\nCl1 Cl1- 0.5 0.5 0.5 . . .\n";
const std::string kGroup = "_space_group_name_H-M_alt 'F m -3 m'\n";

class DataSmallCif : public support::DataFileTest {
 protected:
  DataSmallCif() : DataFileTest("a.cif") {}

  std::uint64_t rows(const std::string& text) { return open("data_a\n" + text)->describe(0).rows; }
  Texts warnings(const std::string& text) { return open("data_a\n" + text)->describe(0).warnings; }
};

TEST_F(DataSmallCif, TheAsymmetricUnitIsExpanded) {
  const auto file = open("data_salt\n" + kCell + kGroup + kSalt + "_chemical_name_mineral Halite\n");
  EXPECT_STREQ(file->format, "CIF");
  const FrameInfo info = file->describe(0);
  EXPECT_EQ(info.title, "Halite");
  EXPECT_TRUE(info.is_unit_cell);
  ASSERT_TRUE(info.box);
  EXPECT_NEAR(info.box->edges[0].x, 5.64, 1e-12);
  const Table table = support::read_table(*file);
  EXPECT_EQ(texts(table, "element"), (Texts{"Na", "Na", "Na", "Na", "Cl", "Cl", "Cl", "Cl"}));
  EXPECT_EQ(texts(table, "name")[4], "Cl1");
  EXPECT_EQ(numbers(table, "site"), (std::vector<double>{1, 1, 1, 1, 2, 2, 2, 2}));
  EXPECT_EQ(numbers(table, "occupancy")[7], 1);
  EXPECT_NEAR(numbers(table, "x")[4], 2.82, 1e-12);
  EXPECT_EQ(numbers(table, "fract_x")[4], 0.5);
}

TEST_F(DataSmallCif, SymmetryIsReadFromOperatorsSymbolsAndNumbers) {
  const std::string atoms = kCell + kSalt;
  EXPECT_EQ(rows(kGroup + atoms), 8u);
  EXPECT_EQ(rows("_symmetry_space_group_name_H-M Fm-3m\n" + atoms), 8u);
  EXPECT_EQ(rows("_symmetry_space_group_name_Hall '-F 4 2 3'\n" + atoms), 8u);
  EXPECT_EQ(rows("_symmetry_Int_Tables_number 225\n" + atoms), 8u);
  const std::string listed = "loop_\n_symmetry_equiv_pos_as_xyz\nx,y,z\nx+1/2,y+1/2,z\n";
  EXPECT_EQ(rows(listed + kGroup + atoms), 4u) << "a list is in the setting of the file";
  EXPECT_EQ(rows("loop_\n_space_group_symop_operation_xyz\n'x, y, z'\n" + atoms), 2u);
  EXPECT_EQ(warnings(kGroup + atoms), Texts{});
  EXPECT_NE(warnings(atoms).at(0).find("no symmetry"), std::string::npos);
  EXPECT_EQ(rows(atoms), 2u);
}

TEST_F(DataSmallCif, BlocksWithAtomsAreFrames) {
  const auto file = open("data_global\n_journal_year 2001\ndata_a\n" + kCell + kGroup + kSalt + "data_b\n" + kCell +
                         "_space_group_IT_number 221\n" + kSites + "Cs1 Cs 0 0 0 1 . .\n");
  ASSERT_EQ(file->frame_count(), 2);
  EXPECT_EQ(file->describe(0).rows, 8u);
  EXPECT_EQ(file->describe(1).rows, 1u);
  EXPECT_EQ(file->describe(0).rows, 8u);
}

TEST_F(DataSmallCif, ElementsComeFromTypesAndLabels) {
  const std::string labels =
      "loop_\n_atom_site_label\n_atom_site_fract_x\n_atom_site_fract_y\n_atom_site_fract_z\n"
      "O1W .1 0 0\nCA .2 0 0\nH2A .3 0 0\nD1 .4 0 0\nQ .5 0 0\nFe2+ .6 0 0\n";
  const auto file = open("data_a\n" + kCell + labels);
  EXPECT_EQ(texts(file->read(0, {"element"}), "element"), (Texts{"O", "Ca", "H", "H", "X", "Fe"}));
}

TEST_F(DataSmallCif, OfOverlappingAtomsTheMostFrequentAreKept) {
  const auto file = open("data_a\n" + kCell + "_space_group_IT_number 1\n" + kSites +
                         "Al 'Al' 0 0 0 .3 . .\nSi Si 1 0 0 .7 . .\nO1 O .5 0 0 .4 A 1\nO2 O .6 0 0 .6 A 2\n"
                         "O3 O .1 .5 0 .6 B 1\nO4 O .2 .5 0 .4 B 2\nN N .2 .2 .2 .5 . .\n");
  EXPECT_EQ(texts(file->read(0, {"name"}), "name"), (Texts{"Si", "O2", "O3", "N"}));
  EXPECT_NE(file->describe(0).warnings.at(0).find("3 sites"), std::string::npos);
}

TEST_F(DataSmallCif, DummiesAreLeftOut) {
  const std::string sites =
      "loop_\n_atom_site_label\n_atom_site_fract_x\n_atom_site_fract_y\n_atom_site_fract_z\n_atom_site_calc_flag\n"
      "C1 .1 .2 .3 d\nCg1 .5 .5 .5 dum\nH1 ? ? ? .\n";
  EXPECT_EQ(rows(kCell + sites), 1u);
  EXPECT_NE(warnings(kCell + sites + "_space_group_IT_number 1\n").at(0).find("2 sites left out: dummy"),
            std::string::npos);
}

TEST_F(DataSmallCif, FaultsAreNamedWithTheirLine) {
  const auto error = [&](const std::string& text) { return error_of("data_a\n" + text); };
  const auto contains = [](const base::Diagnostic& d, const char* text) {
    return d.text.find(text) != std::string::npos ? "" : d.text;
  };
  const base::Diagnostic unknown = error("_symmetry_space_group_name_H-M 'P 99'\n" + kCell + kSalt);
  EXPECT_EQ(contains(unknown, "`P 99` is unknown"), "");
  EXPECT_EQ(unknown.line, 2u);
  EXPECT_NE(unknown.remedy.find("symop"), std::string::npos);
  EXPECT_EQ(contains(error(kGroup + kSalt), "no volume"), "") << "without a cell";
  const base::Diagnostic zero = error("_cell_length_a 0\n_cell_length_b 1\n_cell_length_c 1\n" + kSalt);
  EXPECT_EQ(contains(zero, "no volume"), "");
  EXPECT_EQ(zero.line, 4u);
  EXPECT_EQ(contains(error("loop_\n_symmetry_equiv_pos_as_xyz\nx,y,q\n" + kCell + kSalt), "`x,y,q`"), "");
  EXPECT_EQ(contains(error(kCell + kSites + "C C a 0 0 1 . .\n"), "`a` is not a fractional coordinate"), "");
  EXPECT_EQ(contains(error(kCell + kSites + "C C 0 0\n"), "incomplete"), "");
  std::string many = "loop_\n_symmetry_equiv_pos_as_xyz\n";
  for (int i = 0; i < 193; ++i) many += "x,y,z\n";
  EXPECT_EQ(contains(error(many + kCell + kSalt), "more than 192"), "");
}

}  // namespace

}  // namespace orrery::data
