// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "base/error.h"
#include "data/data_file.h"
#include "support/data_file_test.h"
#include "support/data_tables.h"
#include "support/mentions.h"
#include "support/temp_dir.h"

namespace orrery::data {

namespace {

using support::numbers;
using support::texts;
using Strings = std::vector<std::string>;

/// The columns of the PDB's files that matter.
const std::string kLoop =
    "loop_\n_atom_site.group_PDB\n_atom_site.id\n_atom_site.type_symbol\n_atom_site.label_atom_id\n"
    "_atom_site.label_alt_id\n_atom_site.label_comp_id\n_atom_site.label_asym_id\n_atom_site.Cartn_x\n"
    "_atom_site.Cartn_y\n_atom_site.Cartn_z\n_atom_site.occupancy\n_atom_site.B_iso_or_equiv\n"
    "_atom_site.auth_seq_id\n_atom_site.auth_asym_id\n_atom_site.pdbx_PDB_model_num\n";

const std::string kOperators =
    "loop_\n_pdbx_struct_oper_list.id\n_pdbx_struct_oper_list.type\n"
    "_pdbx_struct_oper_list.matrix[1][1]\n_pdbx_struct_oper_list.matrix[1][2]\n_pdbx_struct_oper_list.matrix[1][3]\n"
    "_pdbx_struct_oper_list.vector[1]\n_pdbx_struct_oper_list.matrix[2][1]\n_pdbx_struct_oper_list.matrix[2][2]\n"
    "_pdbx_struct_oper_list.matrix[2][3]\n_pdbx_struct_oper_list.vector[2]\n_pdbx_struct_oper_list.matrix[3][1]\n"
    "_pdbx_struct_oper_list.matrix[3][2]\n_pdbx_struct_oper_list.matrix[3][3]\n_pdbx_struct_oper_list.vector[3]\n"
    "1 'identity operation' 1 0 0 0 0 1 0 0 0 0 1 0\n"
    "2 turn 0 -1 0 10 1 0 0 20 0 0 1 30\n"
    "3 shift 1 0 0 0 0 1 0 0 0 0 1 5\n"
    "P point 1 0 0 1 0 1 0 2 0 0 1 3\n";

std::string assembly(const std::string& rows) {
  return "loop_\n_pdbx_struct_assembly_gen.assembly_id\n_pdbx_struct_assembly_gen.oper_expression\n"
         "_pdbx_struct_assembly_gen.asym_id_list\n" +
         rows;
}

const std::string kCarbon = "ATOM 1 C CA . ALA A 1.5 -2 1e3 1.00 20.5 7 X 1\n";

class DataMmcif : public support::DataFileTest {
 protected:
  DataMmcif() : DataFileTest("a.cif") {}
};

TEST_F(DataMmcif, ReadsTheColumnsOfAtoms) {
  const auto file = open("# comment\ndata_1ABC\n_struct.title 'A virus''s coat'\n" + kLoop + kCarbon +
                         "HETATM 2 ZN \"ZN'\" ? ZN B 0 0.25 -1 0.50 ? . Y 1\n#\n_other.item 1\n");
  EXPECT_STREQ(file->format, "mmCIF");
  EXPECT_EQ(file->frame_count(), 1);
  const FrameInfo info = file->describe(0);
  EXPECT_EQ(info.rows, 2U);
  EXPECT_EQ(info.title, "A virus''s coat");
  EXPECT_EQ(info.roles.chain, "subchain");
  EXPECT_EQ(info.step, 1);
  EXPECT_FALSE(info.z_up);
  const std::vector<std::string> names = support::column_names(info);
  const Table table = file->read(0, names);
  ASSERT_EQ(table.columns.size(), names.size());
  for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(table.columns[i].type(), info.columns[i].type) << names[i];
  EXPECT_EQ(numbers(table, "x"), (std::vector<double>{1.5, 0}));
  EXPECT_EQ(numbers(table, "z"), (std::vector<double>{1000, -1}));
  EXPECT_EQ(texts(table, "element"), (Strings{"C", "Zn"}));
  EXPECT_EQ(texts(table, "chain"), (Strings{"X", "Y"}));
  EXPECT_EQ(texts(table, "subchain"), (Strings{"A", "B"}));
  EXPECT_EQ(texts(table, "name"), (Strings{"CA", "ZN'"}));
  EXPECT_EQ(texts(table, "record"), (Strings{"ATOM", "HETATM"}));
  EXPECT_EQ(texts(table, "altloc"), (Strings{"", ""}));
  EXPECT_EQ(std::get<std::vector<std::int32_t>>(table.find("residue_number")->values),
            (std::vector<std::int32_t>{7, 0}));
  EXPECT_EQ(std::get<std::vector<float>>(table.find("b_factor")->values)[0], 20.5F);
  EXPECT_TRUE(std::isnan(std::get<std::vector<float>>(table.find("b_factor")->values)[1]));
}

TEST_F(DataMmcif, ModelsAreFramesAndAlternateLocationsAreResolved) {
  const auto file = open("data_a\n" + kLoop + "ATOM 1 C CB A SER A 1 0 0 0.4 0 7 A 1\n" +
                         "ATOM 2 C CB B SER A 2 0 0 0.6 0 7 A 1\nATOM 3 C CB A SER A 3 0 0 0.5 0 7 A 12\n" +
                         "ATOM 4 C CA . SER A 4 0 0 1 0 7 A 1\n");
  ASSERT_EQ(file->frame_count(), 2);
  EXPECT_EQ(numbers(file->read(0, {"x"}), "x"), (std::vector<double>{2, 4}));
  EXPECT_EQ(numbers(file->read(1, {"x"}), "x"), (std::vector<double>{3}));
  EXPECT_EQ(file->describe(1).step, 12);
}

TEST_F(DataMmcif, SingleItemsAreATableOfOneRow) {
  std::string text = "data_a\n";
  std::string tags = kLoop.substr(6), values = kCarbon;
  for (std::size_t at = 0; at < tags.size();) {
    const std::size_t tag_end = tags.find('\n', at), value_end = values.find_first_of(" \n");
    text += tags.substr(at, tag_end - at) + " " + values.substr(0, value_end) + "\n";
    values.erase(0, value_end + 1);
    at = tag_end + 1;
  }
  const Table table = open(text)->read(0, {"x", "chain"});
  EXPECT_EQ(numbers(table, "x"), (std::vector<double>{1.5}));
  EXPECT_EQ(texts(table, "chain"), (Strings{"X"}));
}

TEST_F(DataMmcif, AssembliesComposeTheirOperators) {
  const auto file =
      open("data_a\n" + assembly("1 '(1-3)' A,B\n1 2 C\nPAU '(P)(2,3)' 'A, B'\n") + kOperators + kLoop + kCarbon);
  const auto assemblies = file->describe(0).assemblies;
  ASSERT_EQ(assemblies.size(), 2U);
  EXPECT_EQ(assemblies[0].name, "1");
  ASSERT_EQ(assemblies[0].parts.size(), 2U);
  EXPECT_EQ(assemblies[0].parts[0].chains, (Strings{"A", "B"}));
  ASSERT_EQ(assemblies[0].parts[0].transforms.size(), 3U);
  EXPECT_EQ(assemblies[0].parts[0].transforms[1].rows[0], (Vec3d{0, -1, 0}));
  EXPECT_EQ(assemblies[0].parts[0].transforms[1].translation, (Vec3d{10, 20, 30}));
  EXPECT_EQ(assemblies[0].parts[1].chains, (Strings{"C"}));
  EXPECT_EQ(assemblies[1].name, "PAU");
  const auto& products = assemblies[1].parts.at(0).transforms;
  ASSERT_EQ(products.size(), 2U);
  // P shifts what the other operator has turned.
  EXPECT_EQ(products[0].rows[0], (Vec3d{0, -1, 0}));
  EXPECT_EQ(products[0].rows[1], (Vec3d{1, 0, 0}));
  EXPECT_EQ(products[0].translation, (Vec3d{11, 22, 33}));
  EXPECT_EQ(products[1].translation, (Vec3d{1, 2, 8}));
}

TEST_F(DataMmcif, TheRightmostOperatorIsAppliedFirst) {
  const auto parts =
      open("data_a\n" + assembly("1 (2)(P) A\n") + kOperators + kLoop + kCarbon)->describe(0).assemblies.at(0).parts;
  EXPECT_EQ(parts.at(0).transforms.at(0).translation, (Vec3d{10 - 2, 20 + 1, 30 + 3}));
}

TEST_F(DataMmcif, OperatorsBesideParenthesesAreKept) {
  const auto transforms = [this](const std::string& expression) {
    std::string out;
    const auto file = open("data_a\n" + assembly("1 '" + expression + "' A\n") + kOperators + kLoop + kCarbon);
    for (const Transform& t : file->describe(0).assemblies.at(0).parts.at(0).transforms)
      out += std::to_string(static_cast<int>(t.translation.z)) + " ";
    return out;
  };
  EXPECT_EQ(transforms("1,(2)"), "0 30 ");
  EXPECT_EQ(transforms("(2,3),1, (P)(2)"), "30 5 0 33 ");
  EXPECT_EQ(transforms("P(1-3)"), "3 33 8 ");
}

TEST_F(DataMmcif, MalformedAssembliesAreRefused) {
  const auto error = [this](const std::string& expression) {
    return error_of("data_a\n" + kOperators + assembly("1 '" + expression + "' A\n") + kLoop + kCarbon);
  };
  EXPECT_EQ(error("1-3,P").text, "");
  EXPECT_NE(error("9").text.find("`9` is not defined"), std::string::npos);
  EXPECT_EQ(error("9").line, 25);
  EXPECT_NE(error("1-2000000000").text.find("`4` is not defined"), std::string::npos);
  for (const char* const unbalanced : {"(1-3", "1-3)", "((1))"})
    EXPECT_NE(error(unbalanced).text.find("parentheses"), std::string::npos) << unbalanced;
  EXPECT_NE(error("()").text.find("no operators"), std::string::npos);
  std::string bomb;
  for (int i = 0; i < 30; ++i) bomb += "(1-3)";
  EXPECT_NE(error(bomb).text.find("more than 1000000 transforms"), std::string::npos);
}

TEST_F(DataMmcif, DamagedFilesAreRefusedWithTheirLine) {
  const auto binary = error_of("data_a\n" + kLoop + kCarbon + "# \x01\n" + kCarbon);
  EXPECT_TRUE(test::mentions(binary.text, {"binary", "value 1"}));
  EXPECT_GT(binary.line, 10) << "also in a comment";
  const auto number = error_of("data_a\n" + kLoop + kCarbon + "ATOM 2 C CA . ALA A 1.5 oops 0 1 0 7 X 1\n");
  EXPECT_NE(number.text.find("`oops` is not a number"), std::string::npos);
  EXPECT_EQ(number.line, 19);
  const auto incomplete = error_of("data_a\n" + kLoop + kCarbon + "ATOM 2 C CA . ALA A 1.5\n");
  EXPECT_NE(incomplete.text.find("incomplete"), std::string::npos);
  const auto quote = error_of("data_a\n_struct.title 'open\n" + kLoop + kCarbon);
  EXPECT_NE(quote.text.find("unterminated"), std::string::npos);
  EXPECT_EQ(quote.line, 2);
  EXPECT_NE(error_of("data_a\n_cell.length_a 1\n").text.find("_atom_site is missing"), std::string::npos);
}

TEST_F(DataMmcif, MemoryIsCheckedBeforeTheFileIsParsed) {
  std::string text = "data_a\n" + kLoop;
  for (int i = 0; i < 100; ++i) text += kCarbon;
  open(text);
  OpenOptions options;
  options.limit_memory(text.size() * 9 / 4 + 1);
  EXPECT_EQ(data::open(folder_ / "a.cif", options)->describe(0).rows, 100u);
  options.limit_memory(text.size() * 9 / 4 - 1);
  try {
    data::open(folder_ / "a.cif", options);
    FAIL() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kNoMemory);
  }
}

TEST_F(DataMmcif, UnknownCoordinatesAreNotNumbers) {
  const auto file = open("data_a\n" + kLoop + "ATOM 1 C CA . ALA A ? 0 . 1 0 7 X 1\n");
  const Table table = file->read(0, {"x", "z"});
  EXPECT_TRUE(std::isnan(numbers(table, "x")[0]));
  EXPECT_TRUE(std::isnan(numbers(table, "z")[0]));
}

/// A table of _struct_conn; the residue numbers are those of authors.
std::string connections(const std::string& rows) {
  return "loop_\n_struct_conn.conn_type_id\n_struct_conn.ptnr1_auth_asym_id\n_struct_conn.ptnr1_auth_seq_id\n"
         "_struct_conn.pdbx_ptnr1_PDB_ins_code\n_struct_conn.ptnr1_label_comp_id\n_struct_conn.ptnr1_label_atom_id\n"
         "_struct_conn.ptnr1_symmetry\n_struct_conn.ptnr2_auth_asym_id\n_struct_conn.ptnr2_auth_seq_id\n"
         "_struct_conn.pdbx_ptnr2_PDB_ins_code\n_struct_conn.ptnr2_label_comp_id\n_struct_conn.ptnr2_label_atom_id\n"
         "_struct_conn.ptnr2_symmetry\n" +
         rows;
}

/// Atoms: name, component, author's number, insertion code.
std::string atoms_of(const std::vector<std::array<const char*, 4>>& atoms) {
  std::string out =
      "loop_\n_atom_site.type_symbol\n_atom_site.label_atom_id\n_atom_site.label_comp_id\n_atom_site.auth_asym_id\n"
      "_atom_site.auth_seq_id\n_atom_site.pdbx_PDB_ins_code\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n"
      "_atom_site.Cartn_z\n";
  for (const auto& [name, component, number, insertion] : atoms)
    out += std::string("C ") + name + ' ' + component + " A " + number + ' ' + insertion + " 0 0 0\n";
  return out;
}

const std::string kComponents =
    "loop_\n_chem_comp_bond.comp_id\n_chem_comp_bond.atom_id_1\n_chem_comp_bond.atom_id_2\n"
    "HOH O H1\nHOH O H2\nCYS CB SG\nCYS SG CB\nXXX A B\n";

TEST_F(DataMmcif, CovalentConnectionsAreBonds) {
  const std::string atoms =
      atoms_of({{"SG", "CYS", "1", "."}, {"SG", "CYS", "1", "A"}, {"SG", "CYS", "2", "?"}, {"ZN", "ZN", "3", "?"}});
  const std::string rows =
      "disulf A 1 . CYS SG 1_555 A 1 A CYS SG 1_555\ncovale A 2 . CYS SG 1_555 A 1 A CYS SG 1_555\n"
      "covale A 2 . CYS SG 1_555 A 1 . CYS SG 2_665\nmetalc A 2 . CYS SG 1_555 A 3 . ZN ZN 1_555\n";
  const auto file = open("data_a\n" + connections(rows) + atoms);
  EXPECT_EQ(file->describe(0).bonds, 2u);
  EXPECT_FALSE(file->describe(0).lists_all_bonds);
  EXPECT_EQ(support::bonds_text(*file), "0-1 1-2");
  EXPECT_EQ(open("data_a\n" + atoms)->describe(0).bonds, 0u);
}

TEST_F(DataMmcif, ComponentsHaveTheirBondsInEachResidue) {
  // The residues of water have no numbers.
  const auto file = open("data_a\n" + kComponents +
                         atoms_of({{"SG", "CYS", "1", "."},
                                   {"CB", "CYS", "1", "."},
                                   {"SG", "CYS", "2", "."},
                                   {"CB", "CYS", "3", "."},
                                   {"O", "HOH", ".", "."},
                                   {"H1", "HOH", ".", "."},
                                   {"H2", "HOH", ".", "."},
                                   {"O", "HOH", ".", "."},
                                   {"H2", "HOH", ".", "."},
                                   {"CB", "SER", "9", "."},
                                   {"SG", "SER", "9", "."}}));
  EXPECT_EQ(support::bonds_text(*file), "0-1 4-5 4-6 7-8");
}

TEST_F(DataMmcif, BadConnectionsAreLeftOutWithAWarning) {
  const auto faults = [&](const std::string& row) {
    return support::bond_faults(
        *open("data_a\n" + connections("covale " + row + "\n") +
              atoms_of({{"SG", "CYS", "1", "."}, {"O", "HOH", "2", "."}, {"O", "HOH", "2", "."}})));
  };
  const std::string left_out = "warning: bonds of the file were left out: line 16: a bond of atom ";
  EXPECT_EQ(faults("A 1 . CYS SG . A 7 . CYS SG ."), left_out + "SG of CYS 7 in chain A, which does not exist\n");
  EXPECT_EQ(faults("A 1 . CYS SG . A 1 . CYS SG ."), left_out + "SG of CYS 1 in chain A with itself\n");
  EXPECT_EQ(faults("A 1 . CYS SG . A 2 . HOH O ."),
            left_out + "O of HOH 2 in chain A, but several atoms are named so\n");
}

TEST_F(DataMmcif, LaterDataBlocksAreLeftOutWithAWarning) {
  const std::string atoms = kLoop + kCarbon;
  const auto file = open("data_comp_list\n_a.b 1\ndata_a\n_struct.title one\n" + atoms + "data_b\n_struct.title two\n" +
                         atoms + "ATOM 2 N N . ALA A 1 2 3 1.00 20.5 7 X 2\n");
  EXPECT_EQ(file->frame_count(), 1);
  const FrameInfo info = file->describe(0);
  EXPECT_EQ(info.rows, 1u);
  EXPECT_EQ(info.title, "one");
  ASSERT_EQ(info.warnings.size(), 1u);
  EXPECT_NE(info.warnings[0].find("2 atoms of later data blocks"), std::string::npos) << info.warnings[0];
  EXPECT_TRUE(open("data_a\n" + atoms + "data_b\n_a.b 1\n")->describe(0).warnings.empty());
}

TEST_F(DataMmcif, WatersWithoutNumbersKeepOneOfTheirAlternateLocations) {
  const auto water = [](const char* altloc, double x, const char* occupancy) {
    return "HETATM 1 O O " + std::string(altloc) + " HOH W " + std::to_string(x) + " 0 0 " + occupancy + " 20 . W 1\n";
  };
  const auto x_of = [this](const std::string& rows) {
    return numbers(open("data_a\n" + kLoop + rows)->read(0, {"x"}), "x");
  };
  EXPECT_EQ(x_of(water(".", 0, "1") + water("A", 5, "0.4") + water("B", 6, "0.6") + water("A", 20, "0.5")),
            (std::vector<double>{0, 6, 20}));
  EXPECT_EQ(x_of(water("A", 5, "0.4") + water("B", 10, "0.6")), (std::vector<double>{5, 10})) << "two molecules";
  EXPECT_EQ(x_of(water("A", 5, "0.4") + water("A", 5.5, "0.6")), (std::vector<double>{5, 5.5}));
}

}  // namespace
}  // namespace orrery::data
