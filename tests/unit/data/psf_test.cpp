// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "data/data_file.h"
#include "support/data_tables.h"
#include "support/mentions.h"
#include "support/temp_dir.h"

namespace orrery::data {
namespace {

using support::numbers;
using support::texts;
using Texts = std::vector<std::string>;

constexpr const char* kPsfWater =
    "PSF EXT XPLOR\n\n         2 !NTITLE\n* water\n* and an ion\n\n         4 !NATOM\n"
    "         1 WT1      1        TIP3     OH2      OT      -0.834000       15.9994           0   0.00000     -0.3\n"
    "         2 WT1      1        TIP3     H1       HT       0.417000       1.00800           0\n"
    "         3 WT1      1        TIP3     H2       HT       0.417000       1.00800           0\n"
    "         4 IONS     7        SOD      SOD      SOD      1.00000       22.9898           0\n"
    "\n         3 !NBOND: bonds\n         1         2         3         1\n         2         3\n\n         0 "
    "!NTHETA\n";

class DataPsf : public testing::Test {
 protected:
  std::unique_ptr<DataFile> open(const std::string& psf, int atoms = 4) {
    std::string csv = "x,y,z\n";
    for (int i = 0; i < atoms; ++i) csv += std::to_string(i) + ",0,0\n";
    support::write_bytes(folder_ / "a.csv", csv);
    support::write_bytes(folder_ / "a.psf", psf);
    OpenOptions options;
    options.topology = folder_ / "a.psf";
    return data::open(folder_ / "a.csv", options);
  }

  /// The error of reading a PSF file and its bonds.
  std::string error_of(const std::string& psf, int atoms = 4) {
    try {
      std::vector<std::string> warnings;
      const auto file = open(psf, atoms);
      support::read_table(*file);
      file->bonds(0, warnings);
    } catch (const base::Error& error) {
      EXPECT_EQ(error.kind(), base::ErrorKind::kBadData);
      return base::formatted(error.diagnostics().at(0));
    }
    return {};
  }

  support::TempDir folder_;
};

TEST_F(DataPsf, NamesAtomsAndBonds) {
  const auto file = open(kPsfWater);
  const FrameInfo info = file->describe(0);
  EXPECT_EQ(support::columns_text(info),
            "x:float64 y:float64 z:float64 id:int64 segment:text residue_number:int64 residue:text name:text type:text "
            "charge:float64 mass:float64 element:text");
  EXPECT_EQ(info.roles.element, "element");
  EXPECT_EQ(info.roles.chain, "segment");
  EXPECT_TRUE(info.has_bonds);
  const Table table = support::read_table(*file);
  EXPECT_EQ(texts(table, "element"), (Texts{"O", "H", "H", "Na"}));
  EXPECT_EQ(texts(table, "segment"), (Texts{"WT1", "WT1", "WT1", "IONS"}));
  EXPECT_EQ(texts(table, "type"), (Texts{"OT", "HT", "HT", "SOD"}));
  EXPECT_EQ(numbers(table, "mass"), (std::vector<double>{15.9994, 1.008, 1.008, 22.9898}));
  std::vector<std::string> warnings;
  EXPECT_EQ(file->bonds(0, warnings), (std::vector<Bond>{{0, 1}, {0, 2}, {1, 2}}));
}

TEST_F(DataPsf, HasNoPositions) {
  support::write_bytes(folder_ / "a.psf", kPsfWater);
  EXPECT_TRUE(test::mentions(support::read_faults(folder_ / "a.psf"), {"no positions", "--topology a.psf"}));
}

TEST_F(DataPsf, DamagedFilesAreRefused) {
  const std::string good = kPsfWater;
  ASSERT_EQ(error_of(good), "");
  const auto with = [&](const char* from, const char* to) { return base::replaced(good, from, to); };
  EXPECT_TRUE(test::mentions(error_of(good, 5), {"5 atoms", "4"}));
  EXPECT_TRUE(test::mentions(error_of(with("4 !NATOM", "9 !NATOM")), {"a.psf"}));
  EXPECT_TRUE(test::mentions(error_of(with("4 !NATOM", "4000000000 !NATOM")), {"truncated"}));
  EXPECT_TRUE(test::mentions(error_of(with("4 !NATOM", "-4 !NATOM")), {"!NATOM", "truncated"}));
  EXPECT_TRUE(test::mentions(error_of(with("!NBOND", "!NBANDS")), {"!NBOND", "truncated"}));
  EXPECT_TRUE(test::mentions(error_of(with("22.9898", "heavy")), {"a.psf:11", "heavy"}));
  EXPECT_TRUE(
      test::mentions(error_of(with("3 !NBOND", "4 !NBOND")), {"a.psf:17", "expected pairs of atoms from 1 to 4"}));
  EXPECT_TRUE(
      test::mentions(error_of(with("         2         3\n\n         0 !NTHETA\n", "")), {"truncated", "2 of 3"}));
  for (const char* const pair : {"0         1\n", "3         3\n", "3         5\n", "3\n", "3         x\n"})
    EXPECT_TRUE(test::mentions(error_of(with("3         1\n", pair)), {"a.psf:14", "expected pairs"})) << pair;
}

}  // namespace
}  // namespace orrery::data
