// SPDX-License-Identifier: Apache-2.0
#include "points/load_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "base/error.h"
#include "data/data_file.h"
#include "points/color_map.h"
#include "points/sources.h"
#include "points_file.h"
#include "scene/scene.h"
#include "scene/validate.h"
#include "support/mentions.h"

namespace orrery::points {
namespace {

using math::Vec3d;
using Numbers = std::vector<double>;

/// A frame of a LAMMPS dump in a box of 10 x 20 x 30.
std::string frame(const std::string& columns, const std::vector<std::string>& rows) {
  std::string out = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n" + std::to_string(rows.size()) +
                    "\nITEM: BOX BOUNDS pp pp pp\n0 10\n0 20\n0 30\nITEM: ATOMS " + columns + "\n";
  for (const std::string& row : rows) out += row + "\n";
  return out;
}

/// Three particles as CSV.
const std::string kCsv = "x,y,z,radius,type,name\n1,0,0,0.5,1,a\n2,0,0,0.25,2,b\n3,0,0,1,2,a\n";

using PointsLoadPoints = PointsFile;

/// A file that claims to have a number of rows.
class ClaimsRows final : public data::DataFile {
 public:
  ClaimsRows(std::unique_ptr<data::DataFile> file, std::uint64_t rows) : file_(std::move(file)), rows_(rows) {}

  int frame_count() override { return file_->frame_count(); }
  data::FrameInfo describe(int frame) override {
    data::FrameInfo info = file_->describe(frame);
    info.rows = rows_;
    return info;
  }
  data::Table read(int, const std::vector<std::string>&) override {
    ADD_FAILURE() << "the file was read";
    return {};
  }

 private:
  std::unique_ptr<data::DataFile> file_;
  std::uint64_t rows_;
};

TEST_F(PointsLoadPoints, MoreSpheresThanIdsAreRefusedBeforeTheyAreRead) {
  write("a.csv", "x,y,z,radius\n1,2,3,0.5\n");
  request.open = [](const std::filesystem::path& file, const data::OpenOptions& options) {
    return std::make_unique<ClaimsRows>(data::open(file, options), std::uint64_t{1} << 32);
  };
  EXPECT_TRUE(test::mentions(load(), {"points[0].file", "4294967296", "4294967295"}));
}

TEST_F(PointsLoadPoints, LoadedSpheresAreTakenByTheSameKeysAlone) {
  load("a.csv", kCsv);
  const scene::Points loaded = points;
  support::write_bytes(folder_ / "a.csv", "x,y,z,radius,type\n7,0,0,1,1\n");
  const auto taken = [&](const std::string& select, int frame) {
    request.loaded = std::make_shared<LoadedPoints>(LoadedPoints{frame, loaded, {}});
    points = {};
    points.file = "a.csv";
    points.select = select;
    load();
    EXPECT_TRUE(request.loaded->points.centers.empty()) << "they are taken or dropped";
    return x();
  };
  EXPECT_EQ(taken("", 1), (Numbers{1, 2, 3}));
  load();
  EXPECT_EQ(x(), Numbers{7}) << "they are gone";
  EXPECT_EQ(taken("type == 1", 1), Numbers{7});
  EXPECT_EQ(taken("", 2), Numbers{7});
}

TEST_F(PointsLoadPoints, DecompressedDataCountAsMemory) {
  write("a.csv", "x,y,z,radius\n1,2,3,0.5\n");
  std::uint64_t limit = 0;
  request.open = [&](const std::filesystem::path& file, const data::OpenOptions& options) {
    limit = options.decompressed_limit;
    return data::open(file, options);
  };
  load();
  EXPECT_EQ(limit, data::OpenOptions().decompressed_limit);
  request.memory_limit = 1 << 20;
  load();
  EXPECT_EQ(limit, request.memory_limit);
}

TEST_F(PointsLoadPoints, CentersAndRadii) {
  EXPECT_EQ(load("a.csv", "x,y,z,radius\n1,2,3,0.5\n-4,5e0,6,2\n"), "");
  EXPECT_EQ(points.centers, (std::vector<Vec3d>{{1, 2, 3}, {-4, 5, 6}}));
  EXPECT_EQ(points.radii, (Numbers{0.5, 2}));
  EXPECT_TRUE(points.colors.empty() && points.palette.empty() && points.materials.empty());
}

TEST_F(PointsLoadPoints, DiametersAreHalvedOnce) {
  EXPECT_EQ(load("a.dump", frame("id x y z diameter", {"1 0 0 0 3"})), "");
  EXPECT_EQ(points.radii, Numbers{1.5});
  EXPECT_EQ(load("b.csv", "x,y,z,diameter\n0,0,0,3\n"), "");
  EXPECT_EQ(points.radii, Numbers{1.5});
  EXPECT_EQ(load("c.csv", "x,y,z,diameter,radius\n0,0,0,3,7\n"), "");
  EXPECT_EQ(points.radii, Numbers{7}) << "a radius is used as it is, even beside a diameter";
}

/// Files list particles in any order; a particle keeps its place in all frames.
TEST_F(PointsLoadPoints, FramesAreInTheOrderOfTheIds) {
  const std::string dump = frame("id type x y z radius", {"3 2 30 0 0 0.3", "1 1 10 0 0 0.1", "2 2 20 0 0 0.2"}) +
                           frame("id type x y z radius", {"2 2 21 0 0 0.2", "3 2 31 0 0 0.3", "1 1 11 0 0 0.1"});
  points.color.types = {{"1", {1, 0, 0}}, {"2", {0, 0, 1}}};
  EXPECT_EQ(load("a.dump", dump), "");
  EXPECT_EQ(x(), (Numbers{10, 20, 30}));
  EXPECT_EQ(points.radii, (Numbers{0.1, 0.2, 0.3}));
  EXPECT_EQ(color(0), (Vec3d{1, 0, 0}));
  EXPECT_EQ(color(2), (Vec3d{0, 0, 1}));
  request.frame = 2;
  EXPECT_EQ(load(), "");
  EXPECT_EQ(x(), (Numbers{11, 21, 31}));
  EXPECT_EQ(points.radii, (Numbers{0.1, 0.2, 0.3}));
  EXPECT_EQ(color(0), (Vec3d{1, 0, 0}));
}

TEST_F(PointsLoadPoints, IdsNeedNotBeConsecutive) {
  points.radius.value = 1;
  EXPECT_EQ(load("a.dump", frame("id x y z", {"900 1 0 0", "-5 2 0 0", "70 3 0 0"})), "");
  EXPECT_EQ(x(), (Numbers{2, 3, 1}));
  EXPECT_TRUE(test::mentions(load("b.dump", frame("id x y z", {"2 1 0 0", "1 2 0 0", "2 3 0 0", "0 4 0 0"})),
                             {"points[0].file", "1", "`id`"}));
  EXPECT_EQ(x(), (Numbers{4, 2, 1, 3})) << "equal ids stay in the order of the file";
  EXPECT_EQ(load("n.dump", frame("id x y z", {"1152921504606846979 3 0 0", "1152921504606846977 1 0 0",
                                              "1152921504606846978 2 0 0"})),
            "");
  EXPECT_EQ(x(), (Numbers{1, 2, 3})) << "a double cannot tell these";
  EXPECT_EQ(load("m.csv", "x,y,z,id\n1,0,0,\n2,0,0,7\n3,0,0,4\n4,0,0,\n"), "");
  EXPECT_EQ(x(), (Numbers{3, 2, 1, 4})) << "missing ids are last";
  points.select = "x != 2";
  EXPECT_EQ(load("c.dump", frame("id x y z", {"3 1 0 0", "1 2 0 0", "2 3 0 0"})), "");
  EXPECT_EQ(x(), (Numbers{3, 1})) << "selected rows in the order of their ids";
}

TEST_F(PointsLoadPoints, FilesWithoutIdsKeepTheirOrder) {
  points.radius.value = 1;
  EXPECT_EQ(load("a.csv", "x,y,z\n3,0,0\n1,0,0\n2,0,0\n"), "");
  EXPECT_EQ(x(), (Numbers{3, 1, 2}));
}

TEST_F(PointsLoadPoints, Selection) {
  points.select = "type == 2 && name == 'a'";
  EXPECT_EQ(load("a.csv", kCsv), "");
  EXPECT_EQ(x(), Numbers{3});
  EXPECT_EQ(points.radii, Numbers{1});
  points.select = "x > 0";
  EXPECT_EQ(load(), "");
  EXPECT_EQ(x().size(), 3u);
  points.select = "1 > 2";
  load();
  EXPECT_TRUE(points.centers.empty()) << "a condition without columns is evaluated as well";
}

TEST_F(PointsLoadPoints, ASelectionThatMatchesNothingIsAWarning) {
  points.select = "type == 3";
  points.color.column = "type";
  EXPECT_TRUE(test::mentions(load("a.csv", kCsv), {"points[0].select", "3", "particles"}));
  EXPECT_TRUE(points.centers.empty());
}

TEST_F(PointsLoadPoints, AFrameWithoutParticlesIsAWarning) {
  EXPECT_TRUE(test::mentions(load("a.dump", frame("id x y z radius", {})), {"warning", "points[0].file", "particles"}));
  points.select = "x > 0";
  EXPECT_TRUE(test::mentions(load(), {"warning", "points[0].file", "particles"}));
}

TEST_F(PointsLoadPoints, FaultsOfASelectionAreLocated) {
  points.select = "type == 2 && siz > 1";
  EXPECT_TRUE(test::mentions(load("a.csv", kCsv), {"points[0].select", "character", "14"}));
  EXPECT_TRUE(points.centers.empty());
}

TEST_F(PointsLoadPoints, UnknownColumnsAreReportedTogether) {
  points.radius.column = "raduis";
  points.color.column = "charge";
  const std::string text = load("a.csv", kCsv);
  EXPECT_TRUE(test::mentions(
      text, {"error points[0].radius.column", "`raduis`", "`radius`", "columns are x, y, z, radius, type, name\n"}));
  EXPECT_TRUE(test::mentions(text, {"points[0].color.column", "`charge`"}));
}

TEST_F(PointsLoadPoints, AMissingRadiusIsAnError) {
  const std::string text = load("a.csv", "x,y,z\n1,2,3\n");
  EXPECT_TRUE(test::mentions(text.substr(0, 52), {"points[0].radius", "radius"}));
  EXPECT_TRUE(points.centers.empty());
}

TEST_F(PointsLoadPoints, UnusedColumnsAreListed) {
  points.select = "type > 0";
  load("a.csv", kCsv);
  EXPECT_EQ(points.unused, std::vector<std::string>{"name"});
}

TEST_F(PointsLoadPoints, SpheresThatAreRowsAreMarked) {
  const auto are_rows = [this] {
    EXPECT_TRUE(load_points(request, points).empty());
    return points.spheres_are_rows;
  };
  write("a.csv", "x,y,z,radius\n0,0,0,1\n1,0,0,1\n");
  EXPECT_TRUE(are_rows());
  points.select = "x > 0";
  EXPECT_FALSE(are_rows());
  points.select.clear();
  points.clip[0] = scene::Interval{-1, 0.5};
  EXPECT_FALSE(are_rows());
  points.clip[0].reset();
  write("a.csv", "x,y,z,radius,id\n0,0,0,1,2\n1,0,0,1,1\n");
  EXPECT_FALSE(are_rows());
}

TEST_F(PointsLoadPoints, ComponentsOfOtherFormatsAreAWarning) {
  points.component = 1;
  EXPECT_TRUE(test::mentions(load("a.csv", "x,y,z,radius\n1,0,0,1\n"), {"points[0].component", "HDF5", "components"}));
}

TEST_F(PointsLoadPoints, FrameOfTheFile) {
  const std::string dump = frame("x y z radius", {"1 0 0 1"}) + frame("x y z radius", {"2 0 0 1"});
  points.frame = 2;
  request.frame = 7;
  EXPECT_EQ(load("a.dump", dump), "");
  EXPECT_EQ(x(), Numbers{2}) << "the scene's choice, not the rendered frame";
  points.frame = 3;
  EXPECT_TRUE(test::mentions(load(), {"points[0].frame", "3", "a.dump", "2"}));
  points.frame.reset();
  request.frame = 3;
  EXPECT_TRUE(test::mentions(load(), {"points[0].file", "3", "a.dump", "2"}));
  request.frame = 0;
  EXPECT_TRUE(test::mentions(load(), {"points[0].file", "0", "a.dump", "2"}));
  EXPECT_TRUE(points.centers.empty());
}

TEST_F(PointsLoadPoints, AFileOfOneFrameIsTheSameInAllFrames) {
  request.frame = 48;
  EXPECT_EQ(load("a.csv", kCsv), "");
  EXPECT_EQ(points.centers.size(), 3u);
  points.frame = 2;
  EXPECT_TRUE(test::mentions(load(), {"points[0].frame", "2", "a.csv", "1"}));
}

TEST_F(PointsLoadPoints, ASequenceHasOneFramePerFile) {
  request.frame = 48;
  points.sequence = "a.####.dump";
  EXPECT_EQ(load("a.0048.dump", frame("x y z radius", {"1 0 0 1"}) + frame("x y z radius", {"2 0 0 1"})), "");
  EXPECT_EQ(x(), Numbers{1});
}

TEST_F(PointsLoadPoints, Unwrap) {
  points.unwrap = true;
  points.radius.value = 1;
  EXPECT_EQ(load("a.dump", frame("x y z ix iy iz", {"1 2 3 1 -1 2"})), "");
  EXPECT_EQ(points.centers, (std::vector<Vec3d>{{11, -18, 63}}));
  EXPECT_EQ(load("b.dump", frame("xs ys zs ix iy iz", {"0.5 0.5 0.5 1 0 0"})), "");
  EXPECT_EQ(points.centers, (std::vector<Vec3d>{{15, 10, 15}}));
  EXPECT_TRUE(test::mentions(load("c.csv", "x,y,z\n1,2,3\n"), {"points[0].unwrap", "no box"}));
  EXPECT_TRUE(test::mentions(load("c.dump", frame("x y z", {"1 2 3"})), {"points[0].bonds", "bonds.length"}))
      << "without flags, by bonds";
  points.bonds.length = 1;
  EXPECT_EQ(load("d.dump", frame("xu yu zu ix iy iz", {"1 2 3 1 0 0"})), "");
  EXPECT_EQ(points.centers, (std::vector<Vec3d>{{1, 2, 3}})) << "unwrapped coordinates are not moved by the flags";
}

TEST_F(PointsLoadPoints, Replicate) {
  points.replicate = {2, 1, 2};
  points.color.column = "radius";
  EXPECT_EQ(load("a.dump", frame("x y z radius", {"1 2 3 0.5", "4 5 6 1"})), "");
  EXPECT_EQ(points.centers,
            (std::vector<Vec3d>{
                {1, 2, 3}, {4, 5, 6}, {11, 2, 3}, {14, 5, 6}, {1, 2, 33}, {4, 5, 36}, {11, 2, 33}, {14, 5, 36}}));
  EXPECT_EQ(points.colors, (std::vector<std::uint16_t>{0, 255, 0, 255, 0, 255, 0, 255}));
  EXPECT_TRUE(test::mentions(load("b.csv", kCsv), {"points[0].replicate", "periodic"}));
  const std::string box_of_zeros = "1\nLattice=\"0 0 0 0 0 0 0 0 5\" Properties=pos:R:3:radius:R:1\n1 2 3 0.5\n";
  EXPECT_TRUE(test::mentions(load("c.xyz", box_of_zeros), {"points[0].replicate", "length"}));
  points.replicate = {1, 1, 2};
  EXPECT_EQ(load("c.xyz", box_of_zeros), "");
  EXPECT_EQ(points.centers.size(), 2u);
}

/// Two atoms in two chains. Assembly 1 is chain A twice, and chain B once.
std::string protein() {
  const auto matrix = [](int row, int serial, double shift) {
    char line[96];
    std::snprintf(line, sizeof line, "REMARK 350   BIOMT%d %3d %9.6f %9.6f %9.6f     %10.5f\n", row, serial,
                  row == 1 ? 1.0 : 0.0, row == 2 ? 1.0 : 0.0, row == 3 ? 1.0 : 0.0, row == 1 ? shift : 0);
    return std::string(line);
  };
  const auto transform = [&](int serial, double shift) {
    return matrix(1, serial, shift) + matrix(2, serial, shift) + matrix(3, serial, shift);
  };
  return "REMARK 350 BIOMOLECULE: 1\nREMARK 350 APPLY THE FOLLOWING TO CHAINS: A\n" + transform(1, 0) +
         transform(2, 100) + "REMARK 350 APPLY THE FOLLOWING TO CHAINS: B\n" + transform(1, 50) +
         "ATOM      1  CA  ALA A   1       1.000   2.000   3.000  1.00  0.00           C\n"
         "ATOM      2  N   ALA B   1       4.000   5.000   6.000  1.00  0.00           N\nEND\n";
}

TEST_F(PointsLoadPoints, AssembliesOfChains) {
  points.assembly = "1";
  points.radius.element = "covalent";
  points.color.element = "jmol";
  EXPECT_EQ(load("a.pdb", protein()), "");
  EXPECT_EQ(points.centers, (std::vector<Vec3d>{{1, 2, 3}, {101, 2, 3}, {54, 5, 6}}));
  EXPECT_EQ(points.radii, (Numbers{0.76, 0.76, 0.71}));
  EXPECT_EQ(points.colors[0], points.colors[1]);
  EXPECT_NE(points.colors[0], points.colors[2]);
  points.select = "chain == 'B'";
  EXPECT_EQ(load(), "");
  EXPECT_EQ(x(), Numbers{54});
  points.select.clear();
  points.assembly = "7";
  EXPECT_TRUE(test::mentions(load(), {"points[0].assembly", "7", "1"}));
}

TEST_F(PointsLoadPoints, TransformThenClip) {
  points.transform.scale = 2;
  points.transform.translate = {10, 0, 0};
  points.clip[0] = scene::Interval{13, 14};
  EXPECT_EQ(load("a.csv", kCsv), "");
  EXPECT_EQ(x(), Numbers{14});
  EXPECT_EQ(points.radii, Numbers{0.5});
}

TEST_F(PointsLoadPoints, ColorsByMap) {
  points.color.column = "radius";
  points.color.map = "fast";
  EXPECT_EQ(load("a.csv", kCsv), "");
  EXPECT_EQ(points.palette_rec709, 256u);
  ASSERT_TRUE(points.color_range);
  EXPECT_EQ(points.color_range->low, 0.25);
  EXPECT_EQ(points.color_range->high, 1);
  EXPECT_EQ(color(1), linear_from_srgb(find_color_map("fast")->knots.front().srgb));
  EXPECT_EQ(color(2), linear_from_srgb(find_color_map("fast")->knots.back().srgb));
}

TEST_F(PointsLoadPoints, ColorsOfStringsAreNamed) {
  points.color.column = "name";
  points.color.map = "tab10";
  EXPECT_EQ(load("a.csv", kCsv), "");
  EXPECT_EQ(points.color_names, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(points.colors, (std::vector<std::uint16_t>{0, 1, 0}));
}

TEST_F(PointsLoadPoints, ColorsOfAPly) {
  points.color.rgb = true;
  EXPECT_EQ(load("a.ply",
                 "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
                 "property float radius\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n"
                 "0 0 0 1 255 0 0\n1 0 0 1 188 188 188\n"),
            "");
  EXPECT_EQ(color(0), (Vec3d{1, 0, 0}));
  EXPECT_NEAR(color(1).x, 0.5, 0.003) << "sRGB 188 is half the light";
}

TEST_F(PointsLoadPoints, MaterialsOfAPly) {
  const auto ply = [](const std::string& type, const std::string& row) {
    return "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
           "property float radius\nproperty " +
           type + " material\nend_header\n0 0 0 1 " + row + "\n";
  };
  const std::vector<scene::Material> materials(2);
  request.materials = &materials;
  EXPECT_EQ(load("a.ply", ply("uchar", "1")), "");
  EXPECT_EQ(points.materials, std::vector<std::uint32_t>{1});
  const std::string expected = "error points[0].file: row 1 of a.ply has material ";
  EXPECT_EQ(load("a.ply", ply("uchar", "2")), expected + "2; the scene has 2, counted from 0\n");
  EXPECT_EQ(load("a.ply", ply("int", "-1")), expected + "-1; the scene has 2, counted from 0\n");
  EXPECT_EQ(load("a.ply", ply("float", "0.5")), expected + "0.5; the scene has 2, counted from 0\n");
  EXPECT_TRUE(points.centers.empty() && points.materials.empty());
}

TEST_F(PointsLoadPoints, AColumnOfMaterialsElsewhereIsOrdinary) {
  EXPECT_EQ(load("a.csv", "x,y,z,radius,material\n0,0,0,1,99\n"), "");
  EXPECT_TRUE(points.materials.empty());
}

/// Selected, copied and clipped spheres and stubs of bonds keep the object of their row.
TEST_F(PointsLoadPoints, ColumnsDivideAFileIntoObjects) {
  points.cryptomatte = {"name", "type"};
  points.radius.value = 0.5;
  EXPECT_EQ(load("a.csv", kCsv), "");
  EXPECT_EQ(points.objects, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(points.object_names, (std::vector<std::string>{".a.1", ".b.2", ".a.2"}));

  points.cryptomatte = {"type"};
  points.select = "x > 0.5";
  points.replicate = {2, 1, 1};
  points.clip[2] = scene::Interval{0, 10};
  points.bonds.are_drawn = true;
  points.bonds.length = 4.0;
  EXPECT_EQ(load("a.dump", frame("x y z type", {"0 0 0 7", "1 0 0 9", "5 0 20 6", "4 0 0 5", "9 0 0 8"})), "");
  EXPECT_EQ(x(), (Numbers{1, 4, 9, 11, 14, 19}));
  EXPECT_EQ(points.object_names, (std::vector<std::string>{".9", ".6", ".5", ".8"}));
  ASSERT_FALSE(points.bond_stubs.empty());
  std::vector<std::uint32_t> wanted = {0, 2, 3, 0, 2, 3};
  for (const scene::BondStub& stub : points.bond_stubs) wanted.push_back(wanted[stub.sphere]);
  EXPECT_EQ(points.objects, wanted);

  points.cryptomatte = {"kind"};
  EXPECT_NE(load().find("error points[0].cryptomatte"), std::string::npos);
}

TEST_F(PointsLoadPoints, SpeedIsDerivedFromTheVelocity) {
  points.radius.value = 1;
  points.color.column = "speed";
  points.select = "speed > 1";
  EXPECT_EQ(load("a.dump", frame("x y z vx vy vz", {"1 0 0 0 0 0.5", "2 0 0 2 3 6", "3 0 0 0 2 0"})), "");
  EXPECT_EQ(x(), (Numbers{2, 3}));
  ASSERT_TRUE(points.color_range);
  EXPECT_EQ(points.color_range->low, 2);
  EXPECT_EQ(points.color_range->high, 7);
}

class PointsLoadPointsMemory : public PointsFile {
 protected:
  /// The message of a lack of memory; empty if there is enough.
  std::string shortage() {
    try {
      EXPECT_EQ(load(), "");
    } catch (const base::Error& error) {
      EXPECT_EQ(error.kind(), base::ErrorKind::kNoMemory);
      EXPECT_TRUE(points.centers.empty() && points.radii.empty());
      return error.what();
    }
    return {};
  }
};

TEST_F(PointsLoadPointsMemory, LimitsRowsAndSpheres) {
  write("a.csv", kCsv);
  request.memory_limit = 100;
  EXPECT_NE(shortage().find("a.csv: 3 rows and 3 spheres need "), std::string::npos) << shortage();
  request.memory_limit = 10'000;
  EXPECT_EQ(shortage(), "");
  request.memory_limit = 0;
  EXPECT_EQ(shortage(), "") << "no limit";
}

/// A data file that takes a mebibyte of memory while it is open.
class HeavyFile final : public data::DataFile {
 public:
  explicit HeavyFile(std::unique_ptr<data::DataFile> file) : file_(std::move(file)) {}

  int frame_count() override { return file_->frame_count(); }
  data::FrameInfo describe(int frame) override { return file_->describe(frame); }
  data::Table read(int frame, const std::vector<std::string>& columns) override { return file_->read(frame, columns); }
  std::uint64_t memory() const override { return 1 << 20; }

 private:
  std::unique_ptr<data::DataFile> file_;
};

TEST_F(PointsLoadPointsMemory, TheOpenFileCounts) {
  write("a.csv", kCsv);
  request.open = [](const std::filesystem::path& file, const data::OpenOptions& options) {
    return std::make_unique<HeavyFile>(data::open(file, options));
  };
  request.memory_limit = 1 << 20;
  EXPECT_NE(shortage().find("3 rows and 3 spheres need "), std::string::npos) << shortage();
  request.memory_limit = (1 << 20) + 10'000;
  EXPECT_EQ(shortage(), "");
}

TEST_F(PointsLoadPointsMemory, CopiesAreCountedBeforeTheyAreMade) {
  write("a.dump", frame("x y z radius", {"1 0 0 1", "2 0 0 1"}));
  request.memory_limit = 1 << 20;
  points.replicate = {1000, 1000, 1000};
  EXPECT_NE(shortage().find(" 2000000000 spheres need "), std::string::npos) << shortage();
  points.replicate = {3, 1, 1};
  EXPECT_EQ(shortage(), "");
  EXPECT_EQ(points.centers.size(), 6u);
}

TEST_F(PointsLoadPointsMemory, ASelectionReducesTheNeed) {
  std::vector<std::string> rows(100, "1 0 0 1");
  rows[7] = "2 0 0 1";
  write("a.dump", frame("x y z radius", rows));
  points.replicate = {100, 1, 1};
  request.memory_limit = 100'000;
  EXPECT_NE(shortage(), "");
  points.select = "x == 2";
  EXPECT_EQ(shortage(), "");
  EXPECT_EQ(points.centers.size(), 100u);
  points.centers.clear();
  points.radii.clear();
  points.select = "x == 1";
  EXPECT_NE(shortage().find("100 rows and 9900 spheres need "), std::string::npos) << shortage();
}

TEST_F(PointsLoadPointsMemory, ChainsReduceTheNeed) {
  points.radius.value = 1;
  points.assembly = "1";
  write("a.pdb", protein());
  request.memory_limit = 2000;
  // Parsing the text takes more than that.
  request.open = [](const std::filesystem::path& file, const data::OpenOptions&) { return data::open(file); };
  EXPECT_EQ(shortage(), "");
  EXPECT_EQ(points.centers.size(), 3u);
}

/// Rounded copies are counted with half the bytes; whether they are is known once their coordinates are.
TEST_F(PointsLoadPointsMemory, CopiesFarFromTheOriginNeedMore) {
  points.radius.value = 1;
  points.assembly = "1";
  request.open = [](const std::filesystem::path& file, const data::OpenOptions&) { return data::open(file); };
  const auto needed = [&] {
    std::uint64_t too_little = 1, enough = 1 << 14;
    while (enough - too_little > 1) {
      request.memory_limit = (too_little + enough) / 2;
      points.centers.clear();
      points.radii.clear();
      (shortage().empty() ? enough : too_little) = request.memory_limit;
    }
    return enough;
  };
  const auto cell = [](double length) {
    char line[80];
    std::snprintf(line, sizeof line, "CRYST1%9.3f   10.000   10.000  90.00  90.00  90.00 P 1           1\n", length);
    return std::string(line);
  };
  write("a.pdb", protein());
  const std::uint64_t near = needed();
  points.transform.translate = {1000, 0, 0};
  EXPECT_EQ(needed(), near);
  points.transform.translate = {1e6, 0, 0};
  EXPECT_EQ(needed(), near + 3 * 12);
  points.transform.translate = {};
  points.replicate = {2, 1, 1};
  write("near.pdb", cell(9000) + protein());
  const std::uint64_t near_images = needed();
  write("far.pdb", cell(20'000) + protein());
  EXPECT_EQ(needed(), near_images + 6 * 12);
}

TEST_F(PointsLoadPoints, RowsOfTheSpheres) {
  const std::string dump =
      frame("id type x y z radius c", {"3 2 30 0 0 0.3 13", "1 1 10 0 0 0.1 11", "2 2 20 5 0 0.2 12"});
  SourceRows source;
  request.source = &source;
  EXPECT_EQ(load("a.dump", dump), "");
  EXPECT_EQ(source.rows, (std::vector<std::uint32_t>{1, 2, 0}));
  ASSERT_NE(source.table.find("c"), nullptr) << "all columns are read";
  EXPECT_EQ(source.table.find("c")->number(2), 12);
  EXPECT_EQ(source.info.roles.radius, "radius");
  EXPECT_EQ(source.info.rows, 3u);
  points.select = "type == 2";
  points.replicate = {1, 2, 1};
  points.clip[1] = scene::Interval{1, 20};
  EXPECT_EQ(load(), "");
  EXPECT_EQ(x(), (Numbers{20, 30}));
  EXPECT_EQ(source.rows, (std::vector<std::uint32_t>{2, 0}));
  request.source = nullptr;
  EXPECT_EQ(load(), "");
  EXPECT_EQ(points.unused, std::vector<std::string>{"c"});
}

TEST_F(PointsLoadPoints, FaultsOfTheFileAreThrown) {
  write("a.csv", kCsv);
  request.file = folder_ / "missing.csv";
  try {
    load();
    ADD_FAILURE();
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kMissingInput);
  }
  EXPECT_THROW(load("b.csv", "x,y,z,radius\n1,2,three,1\n"), base::Error);
}

/// A chain of four residues, of which number 3 is missing, and a ligand.
std::string chain_and_ligand() {
  std::string out;
  int serial = 0;
  const auto add = [&](const char* record, const char* name, const char* residue, int number, double x, double y,
                       const char* element) {
    char line[96];
    std::snprintf(line, sizeof line, "%-6s%5d %-4s %3s A%4d    %8.3f%8.3f%8.3f  1.00  0.00          %2s\n", record,
                  ++serial, name, residue, number, x, y, 0.0, element);
    out += line;
  };
  double x = 0;
  for (const int number : {1, 2, 4, 5}) {
    x += 3.8;
    add("ATOM", " N", "ALA", number, x - 1.4, 0, "N");
    add("ATOM", " CA", "ALA", number, x, 0, "C");
  }
  add("HETATM", " C1", "LIG", 9, 0, 20, "C");
  add("HETATM", " O1", "LIG", 9, 1.2, 20, "O");
  return out + "END\n";
}

TEST_F(PointsLoadPoints, TracesJoinResiduesThatFollowEachOther) {
  points.radius.element = "vdw";
  points.representation = {"trace", "residue LIG: sticks"};
  EXPECT_EQ(load("a.pdb", chain_and_ligand()), "");
  ASSERT_EQ(points.centers.size(), 6u) << "C-alpha atoms and the ligand";
  EXPECT_EQ(points.bond_pairs, (std::vector<scene::SphereBond>{{0, 1}, {2, 3}, {4, 5}}))
      << "not beyond the missing residue";
  EXPECT_DOUBLE_EQ(points.trace_radius, 0.6);
  EXPECT_EQ(points.bond_radius, 0.15);
  EXPECT_EQ(points.radii, (std::vector<double>{points.trace_radius, points.trace_radius, points.trace_radius,
                                               points.trace_radius, 0.15, 0.15}));
  EXPECT_EQ(points.bond_radius_of(0), points.trace_radius);
  EXPECT_EQ(points.bond_radius_of(5), points.bond_radius);
  points.transform.scale = 2;
  EXPECT_EQ(load(), "");
  EXPECT_DOUBLE_EQ(points.trace_radius, 1.2);
  EXPECT_DOUBLE_EQ(points.radii[0], 1.2);
}

TEST_F(PointsLoadPoints, RepresentationsOfSomeParticlesLeaveTheOthers) {
  points.radius.element = "vdw";
  points.representation = {"residue LIG: ball-and-stick", "name O1: points"};
  EXPECT_EQ(load("a.pdb", chain_and_ligand()), "");
  ASSERT_EQ(points.centers.size(), 10u);
  EXPECT_EQ(points.radii[0], 1.55);
  EXPECT_EQ(points.radii[8], 0.25 * 1.7);
  EXPECT_EQ(points.radii[9], 0.15);
  EXPECT_TRUE(points.bond_pairs.empty()) << "a point has no bonds, nor have spheres";
  points.representation = {"ball-and-stick", "residue_number in [1:2]: spheres"};
  EXPECT_EQ(load(), "");
  EXPECT_EQ(points.radii[1], 1.7);
  EXPECT_EQ(points.bond_pairs, (std::vector<scene::SphereBond>{{4, 5}, {6, 7}, {8, 9}}));
}

TEST_F(PointsLoadPoints, TracesNeedNamesAndResidues) {
  points.representation = {"trace"};
  points.radius.value = 1;
  EXPECT_TRUE(test::mentions(load("a.csv", kCsv), {"error points[0].representation", "residue_number"}));
}

}  // namespace
}  // namespace orrery::points
