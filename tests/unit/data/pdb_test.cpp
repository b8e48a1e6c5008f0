// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <set>

#include "base/error.h"
#include "data/data_file.h"
#include "support/data_file_test.h"
#include "support/data_tables.h"
#include "support/shared_data.h"
#include "support/temp_dir.h"

namespace orrery::data {

namespace {

using support::numbers;
using support::texts;
/// An ATOM record. `element` may be empty, as in many files.
std::string atom(const std::string& name, const std::string& residue, char chain, int number, Vec3d p,
                 const std::string& element, char altloc = ' ', double occupancy = 1) {
  char line[128];
  std::snprintf(line, sizeof line, "ATOM  %5d %-4s%c%3s %c%4d    %8.3f%8.3f%8.3f%6.2f%6.2f          %2s\n", 1,
                name.c_str(), altloc, residue.c_str(), chain, number, p.x, p.y, p.z, occupancy, 20.5, element.c_str());
  return line;
}

class DataPdb : public support::DataFileTest {
 protected:
  DataPdb() : DataFileTest("a.pdb") {}
};

using Strings = std::vector<std::string>;

TEST_F(DataPdb, ReadsTheColumnsOfAtoms) {
  const auto file = open("TITLE     A SMALL ONE\n" + atom(" CA", "ALA", 'B', -3, {1.5, -2.25, 1000.125}, " C") +
                         "TER\nHETATM99999 ZN    ZN C9999    -999.999 999.999   0.000  0.50 99.99          ZN\nEND\n");
  EXPECT_STREQ(file->format, "PDB");
  EXPECT_EQ(file->frame_count(), 1);
  const FrameInfo info = file->describe(0);
  EXPECT_EQ(info.rows, 2U);
  EXPECT_EQ(info.title, "A SMALL ONE");
  EXPECT_EQ(info.roles.element, "element");
  EXPECT_EQ(info.roles.chain, "chain");
  EXPECT_FALSE(info.z_up);
  const std::vector<std::string> names = support::column_names(info);
  const Table table = file->read(0, names);
  ASSERT_EQ(table.columns.size(), names.size());
  for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(table.columns[i].type(), info.columns[i].type) << names[i];
  EXPECT_EQ(numbers(table, "x"), (std::vector<double>{1.5, -999.999}));
  EXPECT_EQ(numbers(table, "z"), (std::vector<double>{1000.125, 0}));
  EXPECT_EQ(texts(table, "element"), (Strings{"C", "Zn"}));
  EXPECT_EQ(texts(table, "chain"), (Strings{"B", "C"}));
  EXPECT_EQ(texts(table, "name"), (Strings{"CA", "ZN"}));
  EXPECT_EQ(texts(table, "residue"), (Strings{"ALA", "ZN"}));
  EXPECT_EQ(texts(table, "record"), (Strings{"ATOM", "HETATM"}));
  EXPECT_EQ(std::get<std::vector<std::int32_t>>(table.find("residue_number")->values),
            (std::vector<std::int32_t>{-3, 9999}));
  EXPECT_EQ(std::get<std::vector<float>>(table.find("b_factor")->values), (std::vector<float>{20.5F, 99.99F}));
  EXPECT_EQ(std::get<std::vector<float>>(table.find("occupancy")->values), (std::vector<float>{1, 0.5F}));
}

TEST_F(DataPdb, ElementsAreDeducedFromAtomNames) {
  const auto file = open(atom(" CA", "ALA", 'A', 1, {}, "") + atom("CA", "CA", 'A', 2, {}, "") +
                         atom("HG21", "VAL", 'A', 3, {}, "") + atom("1HB ", "ALA", 'A', 4, {}, "") +
                         atom("FE", "HEM", 'A', 5, {}, "") + atom(" QQ", "UNK", 'A', 6, {}, ""));
  EXPECT_EQ(texts(file->read(0, {"element"}), "element"), (Strings{"C", "Ca", "H", "H", "Fe", "X"}));
  const auto warnings = file->describe(0).warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("FE of HEM is Fe"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[0].find("QQ of UNK"), std::string::npos) << warnings[0];
}

TEST_F(DataPdb, LeftAlignedNamesAreNotMetals) {
  const auto file =
      open(atom("N", "ALA", 'A', 1, {}, "") + atom("CA", "ALA", 'A', 1, {}, "") + atom("CD", "GLU", 'A', 2, {}, "") +
           atom("HG", "SER", 'A', 3, {}, "") + atom("CE", "LYS", 'A', 4, {}, "") + atom("CA", "LIG", 'A', 5, {}, "") +
           atom("CL1", "LIG", 'A', 5, {}, "") + atom("NA", "NA", 'A', 6, {}, ""));
  EXPECT_EQ(texts(file->read(0, {"element"}), "element"), (Strings{"N", "C", "C", "H", "C", "C", "Cl", "Na"}));
  ASSERT_EQ(file->describe(0).warnings.size(), 1u);
  EXPECT_NE(file->describe(0).warnings[0].find("those of 2 atoms were guessed"), std::string::npos);
  EXPECT_TRUE(open(atom("CA", "ALA", 'A', 1, {}, "") + atom("CA", "GLY", 'A', 2, {}, ""))->describe(0).warnings.empty())
      << "a trace of C-alpha atoms";
}

TEST_F(DataPdb, AListedElementIsNotDeduced) {
  const auto file = open(atom("CA", "LIG", 'A', 1, {}, "CA") + atom("CB", "LIG", 'A', 1, {}, "C") +
                         atom("H1", "LIG", 'A', 1, {}, "D") + atom("CE", "LIG", 'A', 1, {}, " X") +
                         atom("CG", "VAL", 'A', 1, {}, "QQ"));
  EXPECT_EQ(texts(file->read(0, {"element"}), "element"), (Strings{"Ca", "C", "D", "X", "C"}));
  EXPECT_TRUE(file->describe(0).warnings.empty());
}

/// An atom at a fixed position, its serial number and what precedes it replaced; the rest moves to the right if that is
/// longer.
std::string with_serial(const std::string& record) {
  return record + atom(" CB", "VAL", 'A', 12, {12.345, 23.456, 34.567}, " C").substr(11);
}

TEST_F(DataPdb, WideSerialNumbersAreRead) {
  for (const char* const record :
       {"ATOM  99999", "ATOM  100000", "ATOM  1000000", "ATOM 100000", "ATOM1000000", "HETATM100000"}) {
    SCOPED_TRACE(record);
    const Table table =
        open(with_serial(record))->read(0, {"x", "y", "z", "name", "residue", "residue_number", "element", "b_factor"});
    ASSERT_EQ(table.rows, 1u);
    EXPECT_EQ(numbers(table, "x")[0], 12.345);
    EXPECT_EQ(numbers(table, "y")[0], 23.456);
    EXPECT_EQ(numbers(table, "z")[0], 34.567);
    EXPECT_EQ(texts(table, "name")[0], "CB");
    EXPECT_EQ(texts(table, "residue")[0], "VAL");
    EXPECT_EQ(texts(table, "element")[0], "C");
    EXPECT_EQ(numbers(table, "residue_number")[0], 12);
    EXPECT_EQ(numbers(table, "b_factor")[0], 20.5F);
  }
  // Six digits that end before the name, as in Chimera; the name begins with a digit.
  std::string line = atom("1HB ", "VAL", 'A', 12, {1112.345, 2223.456, 3334.567}, "");
  line.replace(6, 6, "100000");
  const Table table = open(line)->read(0, {"y", "name", "element"});
  EXPECT_EQ(numbers(table, "y")[0], 2223.456);
  EXPECT_EQ(texts(table, "name")[0], "1HB");
}

TEST_F(DataPdb, WideResidueNumbersAreRead) {
  std::string within = atom(" O", "SOL", 'A', 1234, {1, 2, 3}, " O"), shifted = within, named = within;
  within[26] = '5';
  shifted.insert(26, "5");
  named[26] = 'B';
  std::string hexadecimal = within, hybrid = within;
  hexadecimal.replace(22, 5, "270f ");
  hybrid.replace(22, 5, "A000 ");
  const Table table =
      open(within + shifted + named + hexadecimal + hybrid)->read(0, {"x", "z", "residue_number", "element"});
  EXPECT_EQ(numbers(table, "residue_number"), (std::vector<double>{12345, 12345, 1234, 0x270f, 10000}));
  EXPECT_EQ(numbers(table, "x"), (std::vector<double>{1, 1, 1, 1, 1}));
  EXPECT_EQ(numbers(table, "z"), (std::vector<double>{3, 3, 3, 3, 3}));
}

TEST_F(DataPdb, OtherShiftedColumnsAreRefused) {
  std::string line = atom(" C", "ALA", 'A', 1, {12.345, 23.456, 34.567}, " C");
  line.insert(20, " ");
  EXPECT_NE(error_of(line).text.find("malformed coordinates"), std::string::npos);
  line = atom(" C", "ALA", 'A', 1, {12.345, 1123.456, 1134.567}, " C");
  line.insert(20, " ");
  EXPECT_NE(error_of(line).text.find("malformed coordinates"), std::string::npos) << "12.34, 51123.45, 61134.56";
  // Two decimal places in their columns.
  line.replace(20, 1, "");
  line.replace(30, 24, "  123.45  123.45 1234.56");
  EXPECT_EQ(error_of(line).text, "");
}

TEST_F(DataPdb, FourLettersAreAResidueUnlessStandardResiduesHaveSuchChains) {
  const auto named = [](const std::string& columns) {  // 18 to 22
    return atom(" C1", "XXX", 'A', 1, {}, " C").replace(17, 5, columns);
  };
  const auto texts_of = [&](const std::string& text) {
    const Table table = open(text)->read(0, {"residue", "chain"});
    Strings out;
    for (std::size_t i = 0; i < table.rows; ++i)
      out.push_back(texts(table, "residue")[i] + "/" + texts(table, "chain")[i]);
    return out;
  };
  EXPECT_EQ(texts_of(named("POPCA") + named("TIP3W") + named("TIP3 ") + named("ASPPB") + named("ALA A")),
            (Strings{"POPC/A", "TIP3/W", "TIP3/", "ASPP/B", "ALA/A"}));
  EXPECT_EQ(texts_of(named("ALAAB") + named("LIGAB") + named("LIGCD") + named(" DGAB")),
            (Strings{"ALA/AB", "LIG/AB", "LIGC/D", "DG/AB"}));
}

TEST_F(DataPdb, SegmentsAreAColumnIfThereAreAny) {
  std::string line = atom(" C", "ALA", 'A', 1, {}, " C");
  EXPECT_FALSE(support::columns_text(open(line)->describe(0)).find("segment") != std::string::npos);
  line.replace(72, 4, "PROA");
  EXPECT_EQ(texts(open(line)->read(0, {"segment"}), "segment"), (Strings{"PROA"}));
}

TEST_F(DataPdb, RowsAreInTheOrderOfTheFile) {
  // Residue numbers and chains of simulations repeat.
  std::string text;
  for (int i = 0; i < 6; ++i) text += atom(" O", "SOL", i % 4 < 2 ? 'A' : 'B', i % 2, {double(i), 0, 0}, " O");
  EXPECT_EQ(numbers(open(text)->read(0, {"x"}), "x"), (std::vector<double>{0, 1, 2, 3, 4, 5}));
}

TEST_F(DataPdb, MissingOccupancyIsOne) {
  const std::string line = atom(" C", "ALA", 'A', 1, {}, " C");
  std::string blank = line, stars = line;
  blank.replace(54, 12, 12, ' ');
  stars.replace(54, 12, "  1.00******");
  const Table table = open(line.substr(0, 54) + "\n" + blank + stars)->read(0, {"occupancy", "b_factor"});
  EXPECT_EQ(numbers(table, "occupancy"), (std::vector<double>{1, 1, 1}));
  EXPECT_EQ(numbers(table, "b_factor")[0], 0);
  EXPECT_TRUE(std::isnan(numbers(table, "b_factor")[2]));
}

TEST_F(DataPdb, OnlyTheMostOccupiedAlternateLocationIsKept) {
  const auto file = open(
      atom(" N", "SER", 'A', 1, {1, 0, 0}, " N") + atom(" CB", "SER", 'A', 1, {2, 0, 0}, " C", 'A', 0.3) +
      atom(" CB", "SER", 'A', 1, {3, 0, 0}, " C", 'B', 0.7) + atom(" OG", "SER", 'A', 1, {4, 0, 0}, " O", 'A', 0.5) +
      atom(" OG", "SER", 'A', 1, {5, 0, 0}, " O", 'B', 0.5) +
      // Another residue at the same place, as when a site is mutated in half of the molecules.
      atom(" CB", "PRO", 'A', 1, {6, 0, 0}, " C", 'C', 0.9) +
      // The same name in another chain and residue.
      atom(" CB", "SER", 'A', 2, {7, 0, 0}, " C", 'A', 0.1) + atom(" CB", "SER", 'B', 1, {8, 0, 0}, " C", 'B', 0.1));
  const Table table = file->read(0, {"x", "altloc", "residue"});
  EXPECT_EQ(numbers(table, "x"), (std::vector<double>{1, 6, 4, 7, 8}));
  EXPECT_EQ(texts(table, "altloc"), (Strings{"", "C", "A", "A", "B"}));
  EXPECT_EQ(std::get<Words>(table.find("altloc")->values).words, (Strings{"", "C", "A", "B"}));
  EXPECT_EQ(texts(table, "residue"), (Strings{"SER", "PRO", "SER", "SER", "SER"}));
}

TEST_F(DataPdb, AtomsOfOneNameWithoutAlternateLocationsAreAllKept) {
  // Residue numbers restart in large simulations.
  const std::string water = atom(" O", "SOL", 'A', 1, {}, " O");
  EXPECT_EQ(open(water + water + water)->describe(0).rows, 3U);
}

TEST_F(DataPdb, ModelsAreFrames) {
  const std::string one = atom(" C", "ALA", 'A', 1, {1, 0, 0}, " C"), two = atom(" C", "ALA", 'A', 1, {2, 0, 0}, " C");
  const auto models = open("MODEL        1\n" + one + "ENDMDL\nMODEL        7\n" + two + two + "ENDMDL\nEND\n");
  ASSERT_EQ(models->frame_count(), 2);
  EXPECT_EQ(models->describe(0).step, 1);
  EXPECT_EQ(models->describe(1).step, 7);
  EXPECT_EQ(numbers(models->read(1, {"x"}), "x"), (std::vector<double>{2, 2}));
  EXPECT_EQ(numbers(models->read(0, {"x"}), "x"), (std::vector<double>{1}));
  // Trajectories without MODEL.
  const auto frames = open(one + "END\n" + two + "END\n" + one + two + "END\nMASTER\n");
  ASSERT_EQ(frames->frame_count(), 3);
  EXPECT_FALSE(frames->describe(0).step);
  EXPECT_EQ(numbers(frames->read(2, {"x"}), "x"), (std::vector<double>{1, 2}));
}

TEST_F(DataPdb, CellWithoutSymmetryIsTheBox) {
  const std::string carbon = atom(" C", "ALA", 'A', 1, {}, " C");
  const auto md = open("CRYST1   10.000   20.000   30.000  90.00  90.00  60.00 P 1           1\n" + carbon +
                       "END\nCRYST1   11.000   20.000   30.000  90.00  90.00  90.00 P 1           1\n" + carbon);
  const auto box = md->describe(0).box;
  ASSERT_TRUE(box);
  EXPECT_EQ(box->edges[0], (Vec3d{10, 0, 0}));
  EXPECT_NEAR(box->edges[1].x, 10, 1e-12);
  EXPECT_NEAR(box->edges[1].y, 17.320508075688775, 1e-12);
  EXPECT_EQ(md->describe(1).box->edges[0].x, 11);
  const auto models = open("CRYST1   10.000   20.000   30.000  90.00  90.00  60.00 P 1           1\nMODEL        1\n" +
                           carbon + "ENDMDL\nMODEL        2\n" + carbon + "ENDMDL\n");
  ASSERT_TRUE(models->describe(1).box);
  EXPECT_EQ(models->describe(1).box->edges[0].x, 10);
  EXPECT_FALSE(
      open("CRYST1   10.000   20.000   30.000  90.00  90.00  90.00 P 21 21 21    4\n" + carbon)->describe(0).box);
  EXPECT_FALSE(
      open("CRYST1    1.000    1.000    1.000  90.00  90.00  90.00 P 1           1\n" + carbon)->describe(0).box);
  EXPECT_FALSE(
      open("CRYST1    0.000    0.000    0.000  90.00  90.00  90.00 P 1           1\n" + carbon)->describe(0).box)
      << "of VMD";
}

/// REMARK 350 with transforms whose serial numbers are consecutive from `first`; each moves along x by its number.
std::string biomt(int first, int count) {
  std::string text;
  for (int serial = first; serial < first + count; ++serial)
    for (int row = 1; row <= 3; ++row) {
      char line[128];
      std::snprintf(line, sizeof line, "REMARK 350   BIOMT%d %3d %9.6f %9.6f %9.6f     %10.5f\n", row, serial,
                    row == 1 ? 0.5 : 0.0, row == 2 ? 0.25 : 0.0, row == 3 ? 0.125 : 0.0,
                    row == 1 ? double(serial) : double(-row));
      text += line;
    }
  return text;
}

TEST_F(DataPdb, AssembliesAreReadFromRemark350) {
  const auto file =
      open("REMARK 350 BIOMOLECULE: 1\nREMARK 350 APPLY THE FOLLOWING TO CHAINS: A, B,\n" +
           std::string("REMARK 350                    AND CHAINS: C\n") + biomt(1, 2) +
           "REMARK 350 APPLY THE FOLLOWING TO CHAINS: D\n" + biomt(3, 1) + "REMARK 350 BIOMOLECULE: 2\n" +
           "REMARK 350 APPLY THE FOLLOWING TO CHAINS: AA\n" + biomt(998, 3) + atom(" C", "ALA", 'A', 1, {}, " C"));
  const auto assemblies = file->describe(0).assemblies;
  ASSERT_EQ(assemblies.size(), 2U);
  EXPECT_EQ(assemblies[0].name, "1");
  ASSERT_EQ(assemblies[0].parts.size(), 2U);
  EXPECT_EQ(assemblies[0].parts[0].chains, (Strings{"A", "B", "C"}));
  EXPECT_EQ(assemblies[0].parts[0].transforms.size(), 2U);
  EXPECT_EQ(assemblies[0].parts[1].chains, (Strings{"D"}));
  EXPECT_EQ(assemblies[0].parts[1].transforms.at(0).translation, (Vec3d{3, -2, -3}));
  EXPECT_EQ(assemblies[1].name, "2");
  const auto& transforms = assemblies[1].parts.at(0).transforms;
  ASSERT_EQ(transforms.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {  // serial numbers 998, 999 and 1000, the last shifts the columns
    EXPECT_EQ(transforms[i].rows[0], (Vec3d{0.5, 0, 0}));
    EXPECT_EQ(transforms[i].rows[1], (Vec3d{0, 0.25, 0}));
    EXPECT_EQ(transforms[i].rows[2], (Vec3d{0, 0, 0.125}));
    EXPECT_EQ(transforms[i].translation, (Vec3d{998.0 + static_cast<double>(i), -2, -3}));
  }
}

TEST_F(DataPdb, DamagedAssembliesAreRefused) {
  const std::string head = "REMARK 350 BIOMOLECULE: 1\n", good = biomt(1, 1);
  const std::string carbon = atom(" C", "ALA", 'A', 1, {}, " C");
  EXPECT_EQ(error_of(head + good + carbon).text, "");
  const auto missing_row = error_of(head + good.substr(0, good.find('\n') + 1) + biomt(2, 1) + carbon);
  EXPECT_NE(missing_row.text.find("out of order"), std::string::npos);
  EXPECT_EQ(missing_row.line, 3);
  std::string serial = good;
  serial.replace(serial.find("BIOMT2   1"), 10, "BIOMT2   2");
  EXPECT_NE(error_of(head + serial + carbon).text.find("out of order"), std::string::npos);
  EXPECT_NE(error_of(head + good.substr(0, good.find('\n') + 1) + carbon).text.find("incomplete"), std::string::npos);
  std::string word = good;
  word.replace(word.find("0.500000"), 8, "******* ");
  EXPECT_NE(error_of(head + word + carbon).text.find("malformed BIOMT"), std::string::npos);
}

TEST_F(DataPdb, MalformedAtomsAreRefusedWithTheirLine) {
  const std::string carbon = atom(" C", "ALA", 'A', 1, {}, " C");
  for (const char* field : {"********", "        ", " 1.0.000", "   1.0e "}) {
    std::string bad = carbon;
    bad.replace(38, 8, field);
    const auto error = error_of("REMARK   1\n" + carbon + bad + carbon);
    EXPECT_NE(error.text.find("malformed coordinates"), std::string::npos) << field;
    EXPECT_EQ(error.line, 3) << field;
  }
  EXPECT_NE(error_of(carbon + carbon.substr(0, 50)).text.find("truncated"), std::string::npos);
  // The line in a later model.
  try {
    open("MODEL        1\r\n" + carbon + "ENDMDL\r\nMODEL        2\r\n" + carbon + carbon.substr(0, 40) + "\n")
        ->describe(1);
    FAIL();
  } catch (const base::Error& error) {
    EXPECT_EQ(error.diagnostics().at(0).line, 6);
  }
}

/// Such bytes hide the name of the record, so that the atom would be lost.
TEST_F(DataPdb, BinaryDataAreRefusedWithTheirLine) {
  const std::string carbon = atom(" C", "ALA", 'A', 1, {}, " C");
  for (const char byte : {'\0', '\x01', '\x1f', '\x7f', '\x80', '\xff'}) {
    std::string within = carbon;
    within[20] = byte;
    for (const std::string& bad : {byte + carbon, std::string(3, byte) + "\n" + carbon, within}) {
      const auto error = error_of(carbon + bad + carbon);
      EXPECT_EQ(error.line, 2) << int{byte};
      EXPECT_NE(error.text, "") << int{byte};
    }
  }
  const std::string long_remark = "REMARK   2 " + std::string(200, ' ') + '\0' + "\n";
  EXPECT_EQ(error_of(carbon + long_remark).line, 2);
  EXPECT_EQ(error_of("AUTHOR    J. M\xc3\x9cLLER, J. M\xdcLLER\t\n" + carbon).text, "")
      << "text of remarks may be in any encoding";
}

TEST_F(DataPdb, CrLfAndUnusualSerialNumbersAreRead) {
  std::string text;
  for (const char* serial : {"99999", "A0000", "*****", "     "}) {
    std::string line = atom(" C", "ALA", 'A', 1, {1, 2, 3}, " C");
    line.replace(6, 5, serial);
    text += line.substr(0, line.size() - 1) + "\r\n";
  }
  const Table table = open(text)->read(0, {"z"});
  EXPECT_EQ(numbers(table, "z"), (std::vector<double>{3, 3, 3, 3}));
}

TEST_F(DataPdb, TwoLetterChainsAreRead) {
  std::string line = atom(" C", "ALA", 'B', 1, {}, " C");
  line[20] = 'A';
  EXPECT_EQ(texts(open(line)->read(0, {"chain"}), "chain"), (Strings{"AB"}));
}

TEST_F(DataPdb, LinesAcrossBlocksAreRead) {
  // More than one block of 1 MiB, and a line longer than a block.
  std::string text;
  constexpr int kAtoms = 40000;
  for (int i = 0; i < kAtoms; ++i) text += atom(" C", "ALA", 'A', i % 9999, {i / 8.0, 0, 0}, " C");
  text += "REMARK " + std::string(3 << 20, 'x') + "\n" + atom(" C", "ALA", 'A', 1, {-1, 0, 0}, " C");
  const Table table = open(text)->read(0, {"x"});
  ASSERT_EQ(table.rows, kAtoms + 1U);
  std::vector<double> x = numbers(table, "x");
  std::sort(x.begin(), x.end());
  for (int i = 0; i < kAtoms; ++i) ASSERT_EQ(x[static_cast<std::size_t>(i) + 1], i / 8.0);
}

TEST_F(DataPdb, HeaderWithoutAtomsIsAnEmptyFrame) {
  const auto file = open("HEADER    VIRUS\nTITLE     NOTHING\nEND\n");
  EXPECT_EQ(file->frame_count(), 1);
  EXPECT_EQ(file->read(0, {"x", "element"}).rows, 0U);
}

TEST_F(DataPdb, TruncatedFilesOfTheDataBankAreRefused) {
  const std::string header = "HEADER    VIRUS\n", one = atom(" C", "ALA", 'A', 1, {1, 2, 3}, " C");
  const std::string biomt =
      "REMARK 350 BIOMOLECULE: 1\nREMARK 350 APPLY THE FOLLOWING TO CHAINS: A\n"
      "REMARK 350   BIOMT1   1  1.000000  0.000000  0.000000        0.00000\n"
      "REMARK 350   BIOMT2   1  0.000000  1.000000  0.000000        0.00000\n"
      "REMARK 350   BIOMT3   1  0.000000  0.000000  1.000000        0.00000\n";
  const std::string truncated = "truncated: the file has HEADER, but not the record END";
  const auto master = [](const std::string& atoms) {
    return "MASTER" + std::string(49 - atoms.size(), ' ') + atoms + "\n";
  };
  EXPECT_EQ(error_of(header + one + "TER\n").text, truncated);
  EXPECT_EQ(error_of(header + biomt + "REMARK 350\n").text, truncated) << "cut between transforms, no atoms";
  EXPECT_EQ(error_of(header + "MODEL        1\n" + one + "ENDMDL\n").text, truncated);
  EXPECT_EQ(error_of(header + one + "END\n" + one).text, truncated) << "the first model ends, the second does not";
  EXPECT_EQ(error_of(header + one + master("2")).text, truncated);
  EXPECT_EQ(error_of(header + one + master("1")).text, "");
  EXPECT_EQ(error_of(header + one + "END").text, "");
  EXPECT_EQ(error_of(header + "MODEL        1\n" + one + "ENDMDL\nEND   \n").text, "");
  EXPECT_EQ(error_of("TITLE     FRAME 7\n" + one + "TER\n").text, "") << "simulation programs write no END";
}

TEST_F(DataPdb, MemoryIsCheckedBeforeAtomsAreParsed) {
  std::string text;
  for (int i = 0; i < 100; ++i) text += atom(" C", "ALA", 'A', i, {1, 2, 3}, " C");
  open(text);
  OpenOptions options;
  constexpr std::uint64_t kBytesPerAtom = 68;
  options.limit_memory(100 * kBytesPerAtom);
  EXPECT_EQ(data::open(folder_ / "a.pdb", options)->describe(0).rows, 100u);
  options.limit_memory(100 * kBytesPerAtom - 1);
  try {
    data::open(folder_ / "a.pdb", options)->describe(0);
    FAIL() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kNoMemory);
    EXPECT_NE(std::string(error.what()).find("the atoms need about "), std::string::npos) << error.what();
  }
}

TEST_F(DataPdb, VirusPbcv1HasAllItsTransforms) {
  const auto path = support::shared_data() / "1M4X.pdb";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is missing";
  const auto file = data::open(path);
  const FrameInfo info = file->describe(0);
  EXPECT_EQ(info.rows, 9693U);
  EXPECT_FALSE(info.box);
  ASSERT_EQ(info.assemblies.size(), 1U);
  ASSERT_EQ(info.assemblies[0].parts.size(), 1U);
  EXPECT_EQ(info.assemblies[0].parts[0].chains, (Strings{"A", "B", "C"}));
  const auto& transforms = info.assemblies[0].parts[0].transforms;
  EXPECT_EQ(transforms.size(), 1680U);
  std::set<std::vector<double>> distinct;
  for (const Transform& t : transforms) {
    for (const Vec3d& row : t.rows) EXPECT_NEAR(length(row), 1, 1e-5);  // six decimal places
    std::vector<double> all = {t.translation.x, t.translation.y, t.translation.z};
    for (const Vec3d& row : t.rows) all.insert(all.end(), {row.x, row.y, row.z});
    distinct.insert(all);
  }
  EXPECT_EQ(distinct.size(), 1680U);
}

TEST_F(DataPdb, PapillomaVirusHasSixtyTransforms) {
  const auto path = support::shared_data() / "3J6R.pdb";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is missing";
  const auto file = data::open(path);
  EXPECT_EQ(file->describe(0).rows, 17214U);
  EXPECT_EQ(file->describe(0).assemblies.at(0).parts.at(0).transforms.size(), 60U);
  const Table table = file->read(0, {"x", "element", "chain"});
  EXPECT_EQ(numbers(table, "x")[0], -19.645);
  EXPECT_EQ(std::get<Words>(table.find("element")->values).words, (Strings{"N", "C", "O", "H"}));
  EXPECT_EQ(std::get<Words>(table.find("chain")->values).words.size(), 6U);
}

/// An atom with a serial number, and a CONECT record.
std::string numbered(const std::string& serial, const std::string& name, char altloc = ' ') {
  return atom(name, "LIG", 'A', 1, {}, "C", altloc).replace(6, 5, serial);
}

TEST_F(DataPdb, ConnectionsAreBonds) {
  const auto file = open(numbered("    1", "C1") + numbered("99999", "C2") + numbered("A0000", "C3") +
                         "CONECT    199999A0000          \nCONECT99999    1    1A0000\nCONECTA0000    1\nEND\n");
  EXPECT_EQ(file->describe(0).bonds, 12u);
  EXPECT_FALSE(file->describe(0).lists_all_bonds);
  EXPECT_EQ(support::bonds_text(*file), "0-1 0-2 1-2");
  EXPECT_EQ(open(numbered("    1", "C1") + "END\n")->describe(0).bonds, 0u);
}

TEST_F(DataPdb, AlternateLocationsShareTheirBonds) {
  const auto file = open(numbered("    1", "C1") + numbered("    2", "C2", 'A') + numbered("    3", "C2", 'B') +
                         "CONECT    1    2    3\nCONECT    2    3\nEND\n");
  EXPECT_EQ(support::bonds_text(*file), "0-1");
}

TEST_F(DataPdb, ConnectionsBelongToTheirModelOrToAll) {
  const std::string atoms = numbered("    1", "C1") + numbered("    2", "C2") + numbered("    3", "C3");
  const auto file = open("MODEL        1\n" + atoms + "CONECT    1    2\nENDMDL\nMODEL        2\n" + atoms +
                         "ENDMDL\nCONECT    2    3\nEND\n");
  ASSERT_EQ(file->frame_count(), 2);
  EXPECT_EQ(support::bonds_text(*file, 1), "1-2");
  EXPECT_EQ(support::bonds_text(*file, 0), "0-1 1-2");
}

TEST_F(DataPdb, BadConnectionsAreLeftOutWithAWarning) {
  const std::string atoms = numbered("    1", "C1") + numbered("    2", "C2") + numbered("    2", "C3");
  const auto faults = [&](const std::string& records) {
    return support::bond_faults(*open(atoms + records + "END\n"));
  };
  const std::string left_out = "warning: bonds of the file were left out: ";
  EXPECT_EQ(faults("CONECT    1    7\nCONECT    1    1\nCONECT    1    2\nCONECT    1   x9\n"),
            left_out + "line 4: a bond of atom 7, which does not exist, and 3 more\n");
  EXPECT_EQ(faults("CONECT    1    2\n"), left_out + "line 4: a bond of atom 2, but several atoms have this number\n");
  const auto file = open(atoms + numbered("    4", "C4") + "CONECT    1    7    4\n");
  EXPECT_EQ(support::bonds_text(*file), "0-3") << "the others are kept";
}

TEST_F(DataPdb, HexadecimalSerialNumbersHaveBonds) {
  const auto file = open(numbered("99999", "C1") + numbered("186a0", "C2") + numbered("186a1", "C3") +
                         "CONECT99999186a0\nCONECT186a0186a1\nEND\n");
  EXPECT_EQ(support::bonds_text(*file), "0-1 1-2");
  EXPECT_EQ(support::bond_faults(*file), "");
}

TEST_F(DataPdb, ConnectionsOfSerialNumbersOfSixDigitsAreLeftOut) {
  std::string wide = numbered("    1", "C2");
  wide.replace(6, 6, "100001");
  const auto file = open(numbered("10000", "C1") + wide + "CONECT10000100001\nEND\n");
  EXPECT_NE(support::bond_faults(*file).find("warning: the bonds of the file"), std::string::npos);
  EXPECT_EQ(support::bonds_text(*file), "");
}

}  // namespace
}  // namespace orrery::data
