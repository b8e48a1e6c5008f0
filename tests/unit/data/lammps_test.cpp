// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/stop_point.h"
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

const std::string kFrameHead = "ITEM: TIMESTEP\n7\nITEM: NUMBER OF ATOMS\n2\n";
const std::string kBox = "ITEM: BOX BOUNDS pp ff mm\n-1 3\n0 10\n2 4\n";

class DataLammpsDump : public support::DataFileTest {
 protected:
  DataLammpsDump() : DataFileTest("a.dump") {}
  std::string errors(const std::string& text) { return data_errors(write(text)); }
};

/// As with `dump_modify types labels`.
TEST_F(DataLammpsDump, TypesMayBeLabels) {
  const std::string head = kFrameHead + kBox + "ITEM: ATOMS id type x y z\n";
  const auto file = open(head + "1 C 0 0 0\n2 O 1 1 1\n" + head + "1 1 0 0 0\n2 2 1 1 1\n");
  EXPECT_EQ(file->describe(0).columns[1].type, ColumnType::kText);
  EXPECT_EQ(file->describe(0).roles.type, "type");
  EXPECT_EQ(texts(file->read(0, {"type"}), "type"), (std::vector<std::string>{"C", "O"}));
  EXPECT_EQ(file->describe(1).columns[1].type, ColumnType::kInt64) << "each frame has its own";
  EXPECT_NE(errors(head + "1 1 0 0 0\n2 O 1 1 1\n"), "");
}

TEST_F(DataLammpsDump, ReadsColumnsWithTheirTypesAndRoles) {
  const auto file = open("ITEM: UNITS\nlj\nITEM: TIME\n0.5\n" + kFrameHead + kBox +
                         "ITEM: ATOMS id type element x y z radius c_stress[1] ix iy iz \n"
                         "2 1 Na 0.5 1 3 0.25 -1e-3 0 -1 1 \n1 2 Cl 1 2 4 0.5 nan 0 0 0 \n");
  EXPECT_STREQ(file->format, "LAMMPS dump");
  EXPECT_EQ(file->frame_count(), 1);
  const FrameInfo info = file->describe(0);
  EXPECT_EQ(info.rows, 2u);
  EXPECT_EQ(info.step, 7);
  EXPECT_TRUE(info.z_up);
  EXPECT_EQ(column_names(info), (std::vector<std::string>{"id", "type", "element", "x", "y", "z", "radius",
                                                          "c_stress[1]", "ix", "iy", "iz"}));
  EXPECT_EQ(info.columns[0].type, ColumnType::kInt64);
  EXPECT_EQ(info.columns[2].type, ColumnType::kText);
  EXPECT_EQ(info.columns[3].type, ColumnType::kFloat64);
  EXPECT_EQ(info.roles.position[2], "z");
  EXPECT_EQ(info.roles.radius, "radius");
  EXPECT_EQ(info.roles.radius_scale, 1);
  EXPECT_EQ(info.roles.element, "element");
  EXPECT_EQ(info.roles.type, "type");
  EXPECT_EQ(info.roles.id, "id");
  EXPECT_EQ(info.roles.image[1], "iy");
  const Table table = file->read(0, column_names(info));
  EXPECT_EQ(numbers(table, "id"), (Numbers{2, 1}));
  EXPECT_EQ(texts(table, "element"), (std::vector<std::string>{"Na", "Cl"}));
  EXPECT_EQ(numbers(table, "y"), (Numbers{1, 2}));
  EXPECT_EQ(numbers(table, "c_stress[1]")[0], -1e-3);
  EXPECT_TRUE(std::isnan(numbers(table, "c_stress[1]")[1]));
  EXPECT_EQ(numbers(table, "iy"), (Numbers{-1, 0}));
  EXPECT_EQ(file->read(0, {"z"}).columns.size(), 1u);
}

TEST_F(DataLammpsDump, BoxIsOrthogonal) {
  const auto box = open(kFrameHead + kBox + "ITEM: ATOMS x y z\n0 0 0\n0 0 0\n")->describe(0).box;
  ASSERT_TRUE(box);
  EXPECT_EQ(box->origin.x, -1);
  EXPECT_EQ(box->edges[0].x, 4);
  EXPECT_EQ(box->edges[1].x, 0);
  EXPECT_EQ(box->edges[1].y, 10);
  EXPECT_EQ(box->edges[2].z, 2);
  EXPECT_EQ(box->periodic, (std::array<bool, 3>{true, false, false}));
}

TEST_F(DataLammpsDump, DiameterIsTwiceTheRadius) {
  const Roles roles = open(kFrameHead + kBox + "ITEM: ATOMS x y z diameter\n0 0 0 1\n0 0 0 1\n")->describe(0).roles;
  EXPECT_EQ(roles.radius, "diameter");
  EXPECT_EQ(roles.radius_scale, 0.5);
}

TEST_F(DataLammpsDump, ScaledPositionsBecomePositions) {
  const auto file = open(kFrameHead + kBox + "ITEM: ATOMS xs ys zs\n0 0 0\n0.5 0.25 1\n");
  const FrameInfo info = file->describe(0);
  EXPECT_EQ(info.roles.position[0], "x");
  EXPECT_EQ(column_names(info), (std::vector<std::string>{"xs", "ys", "zs", "x", "y", "z"}));
  const Table table = file->read(0, column_names(info));
  EXPECT_EQ(numbers(table, "x"), (Numbers{-1, 1}));
  EXPECT_EQ(numbers(table, "y"), (Numbers{0, 2.5}));
  EXPECT_EQ(numbers(table, "z"), (Numbers{2, 4}));
  EXPECT_EQ(numbers(table, "xs"), (Numbers{0, 0.5}));
  EXPECT_EQ(file->read(0, {"y"}).columns.size(), 1u);
}

TEST_F(DataLammpsDump, ScaledUnwrappedPositionsBecomePositions) {
  const auto file = open(kFrameHead + kBox + "ITEM: ATOMS xsu ysu zsu\n0 0 0\n1.5 -0.25 1\n");
  EXPECT_EQ(numbers(file->read(0, {"x", "y"}), "y"), (Numbers{0, -2.5}));
}

TEST_F(DataLammpsDump, UnwrappedPositionsStayAsTheyAre) {
  const auto file = open(kFrameHead + kBox + "ITEM: ATOMS xu yu zu xs ys zs\n1 2 3 0 0 0\n4 5 6 0 0 0\n");
  EXPECT_EQ(file->describe(0).roles.position, (std::array<std::string, 3>{"xu", "yu", "zu"}));
  EXPECT_EQ(numbers(file->read(0, {"yu"}), "yu"), (Numbers{2, 5}));
}

/// A cell with a = (4, 0, 0), b = (xy, 5, 0), c = (xz, yz, 6) at (-1, 2, 3), as LAMMPS writes it: xlo_bound is
/// xlo + min(0, xy, xz, xy + xz).
TEST_F(DataLammpsDump, ImageCountsApplyToWrappedPositionsOnly) {
  const auto image = [&](const std::string& columns) {
    return open(kFrameHead + kBox + "ITEM: ATOMS " + columns + " ix iy iz\n1 2 3 0 0 0\n1 2 3 0 0 0\n")
        ->describe(0)
        .roles.image[0];
  };
  EXPECT_EQ(image("x y z"), "ix");
  EXPECT_EQ(image("xs ys zs"), "ix");
  EXPECT_EQ(image("xu yu zu"), "");
  EXPECT_EQ(image("xsu ysu zsu"), "");
}

TEST_F(DataLammpsDump, ColumnsOfOneNameAreNumbered) {
  const auto file = open(kFrameHead + kBox + "ITEM: ATOMS x y z v v v\n1 2 3 4 5 6\n1 2 3 7 8 9\n");
  EXPECT_EQ(column_names(file->describe(0)), (std::vector<std::string>{"x", "y", "z", "v", "v_2", "v_3"}));
  EXPECT_EQ(numbers(file->read(0, {"v_3"}), "v_3"), (Numbers{6, 9}));
  std::string many = "ITEM: ATOMS x y z";
  for (int i = 0; i < 4094; ++i) many += " v";
  EXPECT_TRUE(test::mentions(errors(kFrameHead + kBox + many + "\n"), {"9", "4096", "columns"}));
}

TEST_F(DataLammpsDump, TiltedBoxIsRecoveredFromItsBounds) {
  struct Tilt {
    double xy, xz, yz;
  };
  for (const Tilt& t : {Tilt{1, 2, 1}, Tilt{-1, -2, -1}, Tilt{1, -2, 0.5}, Tilt{-1, 2, -0.5}}) {
    const auto row = [](double low, double high, double tilt) {
      return std::to_string(low) + " " + std::to_string(high) + " " + std::to_string(tilt) + "\n";
    };
    const double least = std::min({0.0, t.xy, t.xz, t.xy + t.xz});
    const double most = std::max({0.0, t.xy, t.xz, t.xy + t.xz});
    const auto file = open(kFrameHead + "ITEM: BOX BOUNDS xy xz yz pp pp ff\n" + row(-1 + least, 3 + most, t.xy) +
                           row(2 + std::min(0.0, t.yz), 7 + std::max(0.0, t.yz), t.xz) + row(3, 9, t.yz) +
                           "ITEM: ATOMS xs ys zs\n0 0 0\n1 1 1\n");
    const Box box = file->describe(0).box.value();
    EXPECT_EQ(box.origin.x, -1);
    EXPECT_EQ(box.origin.y, 2);
    EXPECT_EQ(box.origin.z, 3);
    EXPECT_EQ(box.edges[0].x, 4);
    EXPECT_EQ(box.edges[1].x, t.xy);
    EXPECT_EQ(box.edges[1].y, 5);
    EXPECT_EQ(box.edges[2].x, t.xz);
    EXPECT_EQ(box.edges[2].y, t.yz);
    EXPECT_EQ(box.edges[2].z, 6);
    EXPECT_EQ(box.periodic, (std::array<bool, 3>{true, true, false}));
    const Table table = file->read(0, {"x", "y", "z"});
    EXPECT_EQ(numbers(table, "x"), (Numbers{-1, 3 + t.xy + t.xz}));
    EXPECT_EQ(numbers(table, "y"), (Numbers{2, 7 + t.yz}));
    EXPECT_EQ(numbers(table, "z"), (Numbers{3, 9}));
  }
}

TEST_F(DataLammpsDump, BoxMayBeGeneral) {
  const auto file = open(kFrameHead + "ITEM: BOX BOUNDS abc origin pp fs pp\n1 2 3 10\n-2 1 0 20\n0 0.5 4 30\n" +
                         "ITEM: ATOMS xs ys zs\n0 0 0\n1 1 0.5\n");
  const Box box = file->describe(0).box.value();
  EXPECT_EQ(box.origin.y, 20);
  EXPECT_EQ(box.edges[0].z, 3);
  EXPECT_EQ(box.edges[2].y, 0.5);
  EXPECT_EQ(box.periodic, (std::array<bool, 3>{true, false, true}));
  const Table table = file->read(0, {"x", "y", "z"});
  EXPECT_EQ(numbers(table, "x"), (Numbers{10, 9}));
  EXPECT_EQ(numbers(table, "y"), (Numbers{20, 23.25}));
  EXPECT_EQ(numbers(table, "z"), (Numbers{30, 35}));
}

/// Frames of different numbers of rows, the first one empty.
std::string trajectory(int frames, const std::string& line_end) {
  std::string text;
  for (int frame = 0; frame < frames; ++frame) {
    text += "ITEM: TIMESTEP" + line_end + std::to_string(10 * frame) + line_end + "ITEM: NUMBER OF ATOMS" + line_end +
            std::to_string(frame) + line_end + "ITEM: BOX BOUNDS pp pp pp" + line_end;
    for (int axis = 0; axis < 3; ++axis) text += "0 1" + line_end;
    text += "ITEM: ATOMS id x y z" + line_end;
    for (int row = 0; row < frame; ++row) text += std::to_string(row) + " 0 0 " + std::to_string(frame) + line_end;
  }
  return text;
}

TEST_F(DataLammpsDump, FramesAreReadInAnyOrder) {
  for (const char* const line_end : {"\n", "\r\n"}) {
    const auto file = open(trajectory(200, line_end));
    EXPECT_EQ(file->describe(3).step, 30);
    EXPECT_EQ(file->frame_count(), 200);
    for (const int frame : {199, 5, 0, 1, 198}) {
      EXPECT_EQ(file->describe(frame).rows, static_cast<std::uint64_t>(frame));
      EXPECT_EQ(numbers(file->read(frame, {"z"}), "z"),
                Numbers(static_cast<std::size_t>(frame), static_cast<double>(frame)));
    }
  }
}

TEST_F(DataLammpsDump, FramesBeforeATruncatedOneAreUsable) {
  const std::string whole = trajectory(4, "\n");
  const auto file = open(whole.substr(0, whole.size() - 8));
  EXPECT_EQ(file->frame_count(), 4);
  EXPECT_EQ(file->read(2, {"z"}).rows, 2u);
  EXPECT_TRUE(test::mentions(errors(whole.substr(0, whole.size() - 8)), {"42", "ends", "2", "3", "rows"}));
}

TEST_F(DataLammpsDump, ACountFarBeyondTheFileIsATruncation) {
  std::string text = trajectory(2, "\n");
  text.replace(text.find("ATOMS\n0") + 6, 1, "4000000000");
  const auto file = open(text);
  EXPECT_THROW(file->describe(0), base::Error);
  EXPECT_NE(errors(text).find("truncated: 4000000000 rows are declared"), std::string::npos) << errors(text);
}

TEST_F(DataLammpsDump, TheTableOfFramesIsLimited) {
  const auto path = write(trajectory(200, "\n"));
  OpenOptions options;
  options.limit_memory(200 * 16 + 100);
  try {
    data::open(path, options)->frame_count();
    FAIL();
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kNoMemory) << error.what();
  }
}

TEST_F(DataLammpsDump, CountingStops) {
  const auto file = open(trajectory(200, "\n"));
  const std::atomic<bool> flag = true;
  const base::StopScope scope(&flag);
  try {
    file->frame_count();
    FAIL();
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kStopped);
  }
}

TEST_F(DataLammpsDump, ErrorsHaveLines) {
  const std::string atoms = "ITEM: ATOMS x y z\n";
  EXPECT_TRUE(
      test::mentions(errors(kFrameHead + kBox + atoms + "0 0 0\n0 0 a\n"), {"11", "column", "3", "a", "number"}));
  EXPECT_EQ(errors(kFrameHead + kBox + atoms + "0 0 0\n0 0 0\n0 0 0\n"),
            "12: expected a line \"ITEM: ...\", found '0 0 0'\n");
  EXPECT_TRUE(test::mentions(errors(kFrameHead + kBox + "ITEM: ATOMS id vx\n0 0\n0 0\n"), {"9", "columns"}));
  EXPECT_TRUE(test::mentions(errors(kFrameHead + "ITEM: ATOMS xs ys zs\n0 0 0\n0 0 0\n"), {"5", "frame"}));
  EXPECT_TRUE(test::mentions(errors(kFrameHead), {"5", "ends", "header", "frame"}));
  EXPECT_TRUE(test::mentions(
      errors(kFrameHead + "ITEM: BOX BOUNDS pp pp pp\n1 0\n0 1\n0 1\n" + atoms + "0 0 0\n0 0 0\n"), {"8", "box"}));
  EXPECT_TRUE(test::mentions(errors("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n-1\n"), {"4", "number", "-1"}));
  EXPECT_TRUE(
      test::mentions(errors("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ENTRIES\n1\n"), {"3", "ITEM: NUMBER OF ENTRIES"}));
  EXPECT_TRUE(test::mentions(errors("ITEM: TIMESTEP\n0\n" + kBox + atoms + "0 0 0\n"), {"7", "frame", "OF"}));
  EXPECT_TRUE(
      test::mentions(errors("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n9000000000000000000\n" + atoms + "0 0 0\n"),
                     {"4", "truncated", "9000000000000000000", "rows", "6", "bytes"}));
}

TEST_F(DataLammpsDump, RowsAfterTheFrameAreNotIgnored) {
  const auto file = open(kFrameHead + kBox + "ITEM: ATOMS x y z\n0 0 0\n0 0 0\n0 0 0\n");
  try {
    file->read(0, {"x"});
    FAIL();
  } catch (const base::Error& error) {
    EXPECT_EQ(error.diagnostics().at(0).line, 12);
    EXPECT_EQ(error.diagnostics().at(0).text, "more rows than line 4 declares");
  }
}

TEST_F(DataLammpsDump, BinaryDumpsAreRefused) {
  const std::string text(
      "\xf6\xff\xff\xff\xff\xff\xff\xff"
      "DUMPCUSTOM\1\0\0\0",
      22);
  EXPECT_TRUE(test::mentions(errors(text), {"0", "binary", "LAMMPS"}));
}

TEST_F(DataLammpsDump, ReadsFilesOfOtherPrograms) {
  const auto folder = support::shared_data() / "lammps";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder;
  const auto salt = data::open(folder / "nacl.lammpstrj");
  const Table table = salt->read(0, {"x", "z", "vx"});
  EXPECT_EQ(table.rows, 512u);
  EXPECT_NEAR(numbers(table, "z")[1], -1.41005 + 0.1875 * (21.15075 + 1.41005), 1e-5);
  const auto properties = data::open(folder / "properties.lammpstrj");
  const Table stress = properties->read(properties->frame_count() - 1, {"c_stress[3]", "v_sq_pos", "i_flag"});
  EXPECT_EQ(stress.rows, 4000u);
  EXPECT_EQ(data_errors(folder / "properties.lammpstrj"), "");
}

TEST_F(DataLammpsDump, MalformedFilesOfOtherProgramsAreRefused) {
  const auto folder = support::shared_data() / "lammps" / "bad";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string errors = data_errors(entry.path());
    // Two rows with one id are no matter of this reader.
    EXPECT_EQ(errors.empty(), entry.path().stem() == "atom-duplicated-id") << entry.path() << "\n" << errors;
  }
}

/// The head of a data file.
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
  EXPECT_TRUE(test::mentions(errors(kHead + "Atoms\n\n1 1 0 0 0 0 0\n2 1 0 0 0 0 0\n"), {"15", "columns"}));
  EXPECT_TRUE(test::mentions(errors(kHead + "Atoms # body\n\n1 1 0 0 0 0 0\n"), {"15", "supported"}));
}

TEST_F(DataLammpsData, ErrorsHaveLines) {
  const std::string atoms = "Atoms # atomic\n\n";
  EXPECT_EQ(errors(kHead + atoms + "1 1 0 0 0\n2 1 0 0\n"), "18: the row has 4 values, not 5\n");
  EXPECT_TRUE(test::mentions(errors(kHead + atoms + "1 1 0 0 0\n"), {"18", "ends", "1", "2", "rows"}));
  EXPECT_TRUE(test::mentions(errors(kHead + atoms + "1 1 0 0 0\n2 1 0 0 0\n3 1 0 0 0\n"), {"19", "rows", "2"}));
  EXPECT_EQ(errors(kHead), "0: no section \"Atoms\"\n");
  EXPECT_EQ(errors("\n2 atoms\n0 x xlo xhi\n"), "3: 'x' is not a number\n");
  EXPECT_TRUE(test::mentions(errors("\n2 atoms\n1 0 xlo xhi\n"), {"3", "box"}));
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
  EXPECT_NE(errors("t\n1 atoms\n-1 bonds\n\nAtoms # atomic\n\n1 1 0 0 0\n").find("3: '-1' is not a number"),
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
