// SPDX-License-Identifier: Apache-2.0
#include "points/bonds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/error.h"
#include "points_file.h"
#include "scene/scene.h"
#include "support/mentions.h"

namespace orrery::points {
namespace {

using math::Vec3d;

/// Bonds of a points table: "0-1 1-2", then stubs: "0>5(1, 2, 3)".
std::string bonds_text(const scene::Points& points) {
  std::string out;
  for (const auto& [a, b] : points.bond_pairs)
    out += (out.empty() ? "" : " ") + std::to_string(a) + "-" + std::to_string(b);
  for (const auto& [sphere, partner, end] : points.bond_stubs) {
    char place[96];
    std::snprintf(place, sizeof place, "(%g, %g, %g)", end.x, end.y, end.z);
    out += (out.empty() ? "" : " ") + std::to_string(sphere) + ">" + std::to_string(partner) + place;
  }
  return out;
}

class PointsBonds : public PointsFile {
 protected:
  PointsBonds() { points.bonds.are_drawn = true; }
  std::string bonds() const { return bonds_text(points); }
};

/// Methanol without its hydrogens at oxygen, with a far atom.
const std::string kXyz = "4\n\nC 0 0 0\nO 1.4 0 0\nH -0.5 0.9 0\nC 9 0 0\n";

/// LAMMPS data in a box of 10: rows 1-4, with ids in another order.
std::string lammps(const std::string& bonds, int count, const std::string& box = "") {
  return "t\n4 atoms\n" + std::to_string(count) + " bonds\n0 10 xlo xhi\n0 10 ylo yhi\n0 10 zlo zhi\n" + box +
         "\nAtoms # bond\n\n4 1 1 9.5 5 5\n1 1 1 0.5 5 5\n2 1 2 1.5 5 5\n3 1 2 2.5 5 5\n\nBonds\n\n" + bonds;
}

TEST_F(PointsBonds, ByDistanceTheFactorMultipliesCovalentRadii) {
  points.radius.element = "ball";
  EXPECT_EQ(load("a.xyz", kXyz), "");
  EXPECT_EQ(bonds(), "0-1 0-2");
  EXPECT_EQ(points.bond_radius, 0.15);
  points.bonds.factor = 0.9;  // 1.28 and 0.96
  EXPECT_EQ(load("a.xyz", kXyz), "");
  EXPECT_EQ(bonds(), "");
  points.bonds = {true, "", {}, 1.41, 0.2, {}};
  EXPECT_EQ(load("a.xyz", kXyz), "");
  EXPECT_EQ(bonds(), "0-1 0-2");
  EXPECT_EQ(points.bond_radius, 0.2);
}

TEST_F(PointsBonds, AlternativePositionsOfAnAtomAreNotBonded) {
  points.radius.element = "ball";
  EXPECT_EQ(load("a.xyz", "3\n\nC 0 0 0\nC 0.3 0 0\nC 1.5 0 0\n"), "");
  EXPECT_EQ(bonds(), "0-2 1-2");
}

TEST_F(PointsBonds, AreThoseOfTheFileInTheOrderOfIds) {
  points.radius.value = 0.5;
  points.transform.scale = 2;
  EXPECT_EQ(load("a.data", lammps("1 1 3 2\n2 1 1 2\n3 1 4 1\n", 3)), "");
  EXPECT_EQ(bonds(), "0-1 1-2 0>3(0, 10, 10) 3>0(20, 10, 10)") << "each stub ends in the middle of its bond";
  EXPECT_EQ(points.bond_radius, 0.3) << "0.3 times the radius, with the scale";
}

TEST_F(PointsBonds, EndAtParticlesThatAreDrawn) {
  points.radius.value = 0.5;
  points.select = "id != 2";
  EXPECT_EQ(load("a.data", lammps("1 1 3 2\n2 1 1 2\n3 1 4 1\n", 3)), "");
  EXPECT_EQ(bonds(), "0>2(0, 5, 5) 2>0(10, 5, 5)");
  points.select = "";
  points.clip[0] = {0, 5};
  EXPECT_EQ(load(), "");
  EXPECT_EQ(bonds(), "0-1 1-2") << "the partner of the stub is not drawn";
}

TEST_F(PointsBonds, ReplicasAreBondedAcrossTheirBoundary) {
  points.radius.value = 0.5;
  points.replicate = {2, 1, 1};
  EXPECT_EQ(load("a.data", lammps("1 1 2 3\n2 1 4 1\n", 2)), "");
  // Spheres 0 to 3 are in the first box, 4 to 7 in the second. Atom 4 of the first is bonded to atom 1 of the second.
  EXPECT_EQ(bonds(), "1-2 5-6 3-4 0>7(0, 5, 5) 7>0(20, 5, 5)");
  points.bonds = {true, "distance", {}, 1.05, {}, {}};
  EXPECT_EQ(load(), "");
  EXPECT_EQ(bonds(), "0-1 1-2 4-5 5-6 3-4 0>7(0, 5, 5) 7>0(20, 5, 5)");
}

TEST_F(PointsBonds, UnwrappedMoleculesAreWhole) {
  const std::string dump =
      "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 10\n0 10\n0 10\nITEM: ATOMS id x y z "
      "ix iy iz\n1 9.5 5 5 0 0 0\n2 0.5 5 5 1 0 0\n";
  points.radius.value = 0.5;
  points.bonds.length = 1.5;
  EXPECT_EQ(load("a.dump", dump), "");
  EXPECT_EQ(bonds(), "0>1(10, 5, 5) 1>0(0, 5, 5)");
  points.unwrap = true;
  EXPECT_EQ(load(), "");
  EXPECT_EQ(bonds(), "0-1");
}

TEST_F(PointsBonds, WithoutFlagsMoleculesAreMadeWholeByTheirBonds) {
  points.radius.value = 0.5;
  points.unwrap = true;
  EXPECT_EQ(load("a.data", lammps("1 1 3 2\n2 1 1 2\n3 1 4 1\n", 3)), "");
  EXPECT_EQ(bonds(), "0-1 0-3 1-2");
  EXPECT_EQ(points.centers, (std::vector<math::Vec3d>{{0.5, 5, 5}, {1.5, 5, 5}, {2.5, 5, 5}, {-0.5, 5, 5}}));
  EXPECT_EQ(load("b.data", lammps("1 1 4 1\n", 1)), "");
  EXPECT_EQ(points.centers[3], (math::Vec3d{-0.5, 5, 5})) << "the middle of the molecule is in the box";
}

TEST_F(PointsBonds, ATiltedBoxHasItsOwnImages) {
  points.radius.value = 0.5;
  EXPECT_EQ(load("a.data",
                 "t\n2 atoms\n1 bonds\n0 10 xlo xhi\n0 10 ylo yhi\n0 10 zlo zhi\n4 0 0 xy xz yz\n\nAtoms # "
                 "atomic\n\n1 1 1 0.5 5\n2 1 5 9.5 5\n\nBonds\n\n1 1 1 2\n"),
            "");
  EXPECT_EQ(bonds(), "0>1(1, 0, 5) 1>0(5, 10, 5)");
}

TEST_F(PointsBonds, CopiesOfAnAssemblyHaveTheirBonds) {
  const std::string pdb =
      "REMARK 350 BIOMOLECULE: 1\nREMARK 350 APPLY THE FOLLOWING TO CHAINS: B\n"
      "REMARK 350   BIOMT1   1  1.000000  0.000000  0.000000        0.00000\n"
      "REMARK 350   BIOMT2   1  0.000000  1.000000  0.000000        0.00000\n"
      "REMARK 350   BIOMT3   1  0.000000  0.000000  1.000000        0.00000\n"
      "REMARK 350   BIOMT1   2  1.000000  0.000000  0.000000        9.00000\n"
      "REMARK 350   BIOMT2   2  0.000000  1.000000  0.000000        0.00000\n"
      "REMARK 350   BIOMT3   2  0.000000  0.000000  1.000000        0.00000\n"
      "ATOM      1  C1  LIG A   1       0.000   0.000   0.000  1.00  0.00           C\n"
      "ATOM      2  C1  LIG B   2       1.500   0.000   0.000  1.00  0.00           C\n"
      "ATOM      3  C2  LIG B   2       3.000   0.000   0.000  1.00  0.00           C\n"
      "ATOM      4  C3  LIG B   2       6.000   0.000   0.000  1.00  0.00           C\n"
      "CONECT    3    4\nEND\n";
  points.radius.element = "ball";
  EXPECT_EQ(load("a.pdb", pdb), "");
  EXPECT_EQ(bonds(), "0-1 1-2 2-3") << "those of the file, which leaves some out, and those by distance";
  points.bonds.from = "file";
  EXPECT_EQ(load(), "");
  EXPECT_EQ(bonds(), "2-3");
  points.bonds.from = "";
  points.assembly = "1";
  EXPECT_EQ(load(), "");
  EXPECT_EQ(bonds(), "0-1 1-2 3-4 4-5");
}

TEST_F(PointsBonds, TheSourceFollowsTheFileAndTheKeys) {
  data::FrameInfo info;
  info.roles.element = "element";
  const auto source = [&](const scene::PointsBonds& keys) {
    KeyFaults faults("points[0]");
    const BondSource out = bond_source(info, keys, faults);
    EXPECT_EQ(text_of(faults), "");
    return std::string(out.is_file ? "file " : "") + (out.is_distance ? "distance " : "") + out.element;
  };
  EXPECT_EQ(source({true, "", {}, {}, {}, {}}), "distance element");
  info.has_bonds = true;
  EXPECT_EQ(source({true, "", {}, {}, {}, {}}), "file ");
  EXPECT_EQ(source({true, "", 1.1, {}, {}, {}}), "distance element");
  EXPECT_EQ(source({true, "", {}, 1.1, {}, {}}), "distance ");
  EXPECT_EQ(source({true, "both", {}, 1.1, {}, {}}), "file distance ");
  info.lists_all_bonds = false;
  EXPECT_EQ(source({true, "", {}, {}, {}, {}}), "file distance element");
  EXPECT_EQ(source({true, "", 1.1, {}, {}, {}}), "file distance element");
  EXPECT_EQ(source({true, "file", {}, {}, {}, {}}), "file ");
  EXPECT_EQ(source({true, "distance", {}, {}, {}, {}}), "distance element");
}

TEST_F(PointsBonds, KeysThatDoNotFitAreReported) {
  points.radius.value = 0.5;
  EXPECT_TRUE(test::mentions(load("a.csv", "x,y,z\n0,0,0\n"),
                             {"error points[0].bonds", "no bonds", "elements", "`bonds.length`", "--bonds length=X"}));
  points.bonds.from = "file";
  EXPECT_TRUE(test::mentions(load(), {"points[0].bonds.from", "distance"}));
  points.bonds = {true, "distance", 1, 1, {}, {}};
  EXPECT_TRUE(test::mentions(load("a.xyz", kXyz), {"points[0].bonds", "`factor`", "`length`"}));
  points.bonds = {true, "file", {}, 1, {}, {}};
  EXPECT_TRUE(test::mentions(load("a.data", lammps("1 1 3 2\n", 1)), {"warning", "points[0].bonds.length"}));
}

TEST_F(PointsBonds, AnElementWithoutARadiusIsNamed) {
  points.radius.value = 0.5;
  write("a.pdb",
        "HETATM    1 XX   LIG A   1       0.000   0.000   0.000  1.00  0.00           X\n"
        "HETATM    2  C   LIG A   1       1.000   0.000   0.000  1.00  0.00           C\nEND\n");
  EXPECT_TRUE(
      test::mentions(load(), {"points[0].bonds", "`X`", "column", "`element`", "rows", "`select`", "`bonds.length`"}));
  points.select = "element != 'X'";
  EXPECT_EQ(load(), "");
}

TEST_F(PointsBonds, ALengthInAnotherUnitIsRefused) {
  std::string rows = "x,y,z\n";
  for (int i = 0; i < 100; ++i) rows += std::to_string(i) + ",0,0\n";
  points.radius.value = 0.5;
  points.bonds.length = 160;
  EXPECT_TRUE(test::mentions(load("a.csv", rows), {"error points[0].bonds.length", "160", "64", "smaller"}));
  EXPECT_TRUE(points.centers.empty() && points.bond_pairs.empty());
}

TEST_F(PointsBonds, CountAsMemory) {
  write("a.xyz", kXyz);
  points.radius.element = "ball";
  request.memory_limit = 500;
  points.bonds.are_drawn = false;
  EXPECT_EQ(load(), "");
  points.bonds.are_drawn = true;
  EXPECT_THROW(load(), base::Error);
}

}  // namespace
}  // namespace orrery::points
