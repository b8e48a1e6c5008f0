// SPDX-License-Identifier: Apache-2.0
#include "data/trajectory.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "data/data_file.h"
#include "support/data_tables.h"
#include "support/mentions.h"
#include "support/temp_dir.h"

namespace orrery::data {

namespace {

using support::numbers;
using support::texts;

std::filesystem::path seed(const std::string& name) {
  return std::filesystem::path(ORRERY_ROOT) / "tests/fuzz/corpus/data" / name;
}

std::unique_ptr<DataFile> open_with(const std::filesystem::path& file, const std::filesystem::path& topology) {
  OpenOptions options;
  options.topology = topology;
  return data::open(file, options);
}

base::Diagnostic error_of(const std::filesystem::path& file, const std::filesystem::path& topology) {
  try {
    open_with(file, topology)->describe(0);
  } catch (const base::Error& error) {
    return error.diagnostics().at(0);
  }
  return {};
}

TEST(DataTrajectory, ATopologyNamesTheParticles) {
  const auto file = open_with(seed("xtc/water.xtc"), seed("gro/water.gro"));
  EXPECT_STREQ(file->format, "XTC");
  ASSERT_EQ(file->frame_count(), 3);
  const FrameInfo info = file->describe(1);
  EXPECT_EQ(info.step, 100) << "of the trajectory";
  EXPECT_EQ(info.roles.element, "element");
  EXPECT_EQ(find_named(info.columns, "velocity[1]"), nullptr) << "that of another time";
  const Table table = support::read_table(*file, 1), bare = data::open(seed("xtc/water.xtc"))->read(1, {"x"});
  EXPECT_EQ(texts(table, "residue").at(29), "SOL");
  EXPECT_EQ(texts(table, "element").at(1), "H");
  EXPECT_EQ(numbers(table, "x"), numbers(bare, "x"));
  EXPECT_EQ(file->read(2, {"element", "z"}).columns[1].name, "z");
  EXPECT_TRUE(info.warnings.empty());
  const std::vector<std::string> warnings = data::open(seed("xtc/water.xtc"))->describe(0).warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("--topology FILE"), std::string::npos);
}

TEST(DataTrajectory, BondsAreThoseOfTheTopology) {
  support::TempDir folder;
  std::string pdb = "CRYST1   20.000   20.000   20.000  90.00  90.00  90.00 P 1\n";
  for (int i = 1; i <= 5; ++i)
    pdb += "HETATM    " + std::to_string(i) + "  C   LIG A   1       0.000   0.000   0.000  1.00  0.00           C\n";
  support::write_bytes(folder / "top.pdb", pdb + "CONECT    1    2\nEND\n");
  const auto file = open_with(seed("xtc/few.xtc"), folder / "top.pdb");
  EXPECT_TRUE(file->describe(0).has_bonds);
  EXPECT_FALSE(file->describe(0).z_up);
  EXPECT_EQ(support::bonds_text(*file), "0-1");
}

TEST(DataTrajectory, ATopologyThatDoesNotFitIsAnError) {
  const base::Diagnostic other = error_of(seed("xtc/few.xtc"), seed("gro/water.gro"));
  EXPECT_NE(other.text.find("5 atoms"), std::string::npos) << other.text;
  EXPECT_NE(other.text.find("water.gro has 30"), std::string::npos) << other.text;
  EXPECT_NE(other.remedy, "");
  EXPECT_NE(error_of(seed("gro/water.gro"), seed("gro/water.gro")).text.find("needs no topology"), std::string::npos);
}

}  // namespace

}  // namespace orrery::data
