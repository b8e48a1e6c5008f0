// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "points_file.h"

namespace orrery::points {
namespace {

using math::Vec3d;

/// A cell of 4 angstrom with an atom at the origin and one in the middle.
std::string cell(const std::string& atoms) {
  return "data_a\n_cell_length_a 4\n_cell_length_b 4\n_cell_length_c 4\n_space_group_IT_number 1\nloop_\n"
         "_atom_site_label\n_atom_site_fract_x\n_atom_site_fract_y\n_atom_site_fract_z\n" +
         atoms;
}

class PointsCellFaces : public PointsFile {
 protected:
  PointsCellFaces() {
    points.radius.element = "ball";
    points.bonds.are_drawn = true;
  }
  std::size_t bonds_of(std::uint32_t sphere) const {
    std::size_t out = 0;
    for (const scene::SphereBond& bond : points.bond_pairs) out += bond.a == sphere || bond.b == sphere;
    return out;
  }
};

TEST_F(PointsCellFaces, AtomsOnCornersAreDrawnAtAllOfThem) {
  EXPECT_EQ(load("a.cif", cell("Cs1 0 0 0\nCl1 .5 .5 .5\n")), "");
  ASSERT_EQ(points.centers.size(), 9u);
  EXPECT_EQ(points.radii.size(), 9u);
  EXPECT_EQ(bonds_of(1), 8u) << "of the atom in the middle";
  EXPECT_EQ(points.bond_pairs.size(), 8u) << "none along the edges, between metals";
  EXPECT_TRUE(points.bond_stubs.empty());
  std::size_t far = 0;
  for (std::size_t i = 0; i < 9; ++i) far += Vec3d(points.centers[i]) == Vec3d{4, 4, 4};
  EXPECT_EQ(far, 1u);
}

TEST_F(PointsCellFaces, AtomsOnAFaceAreDrawnTwice) {
  EXPECT_EQ(load("a.cif", cell("C1 0 .3 .4\nC2 .999 .7 .8\n")), "");
  ASSERT_EQ(points.centers.size(), 4u);
  EXPECT_EQ(points.centers[2], (Vec3d{4, 1.2, 1.6}));
  EXPECT_NEAR(points.centers[3].x, -0.004, 1e-12);
}

TEST_F(PointsCellFaces, BondsOfInnerAtomsThatLeaveTheCellEndInTheMiddle) {
  EXPECT_EQ(load("a.cif", cell("C1 .1 .5 .5\nC2 .8 .5 .5\n")), "");
  EXPECT_EQ(points.centers.size(), 2u);
  EXPECT_EQ(points.bond_stubs.size(), 2u);
}

TEST_F(PointsCellFaces, ReplicasHaveOuterFacesOnly) {
  points.replicate = {2, 1, 1};
  points.transform.scale = 2;
  points.transform.rotate.z = 90;
  EXPECT_EQ(load("a.cif", cell("Cs1 0 0 0\nCl1 .5 .5 .5\n")), "");
  EXPECT_EQ(points.centers.size(), 12u + 2u);
  EXPECT_EQ(points.bond_pairs.size(), 16u);
}

TEST_F(PointsCellFaces, WithoutBondsEachAtomIsDrawnOnce) {
  points.bonds.are_drawn = false;
  EXPECT_EQ(load("a.cif", cell("Cs1 0 0 0\nCl1 .5 .5 .5\n")), "");
  EXPECT_EQ(points.centers.size(), 2u);
}

}  // namespace
}  // namespace orrery::points
