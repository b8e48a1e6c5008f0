// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "points/copies.h"
#include "points_file.h"
#include "scene/scene.h"
#include "support/mentions.h"

namespace orrery::points {
namespace {

using math::Vec3d;

class PointsArrows : public PointsFile {
 protected:
  PointsArrows() {
    points.radius.value = 0.5;
    points.vectors = {{"u", "v", "w"}, 1, 0.1};
  }
  /// Loads a CSV file with positions and vectors.
  std::string load_rows(const std::string& rows) { return load("a.csv", "x,y,z,u,v,w,type\n" + rows); }
  /// The point of an arrow: the end of the last sphere of its head, in a direction.
  Vec3d tip(std::size_t arrow, Vec3d direction) const {
    const std::size_t last = points.particle_count() + (arrow + 1) * kHeadSpheres - 1;
    return points.centers[last] + direction * points.radii[last];
  }
};

void expect_near(Vec3d a, Vec3d b) { EXPECT_LT(math::length(a - b), 1e-12) << a.x << " " << a.y << " " << a.z; }

TEST_F(PointsArrows, ReachFromTheSphereToTheEndOfItsVector) {
  EXPECT_EQ(load_rows("1,2,3,0,2,0,1\n5,5,5,0,0,-4,1\n"), "");
  ASSERT_EQ(points.arrow_count, 2u);
  EXPECT_EQ(points.particle_count(), 2u);
  ASSERT_EQ(points.centers.size(), 2 + 2 * kHeadSpheres);
  EXPECT_EQ(points.radii.size(), points.centers.size());
  expect_near(tip(0, {0, 1, 0}), {1, 4, 3});
  expect_near(tip(1, {0, 0, -1}), {5, 5, 1});
  EXPECT_EQ(points.bond_pairs, (std::vector<scene::SphereBond>{{0, 2}, {1, 2 + kHeadSpheres}}));
  EXPECT_EQ(points.bond_radius, 0.1);
  EXPECT_FALSE(points.spheres_are_rows);
  EXPECT_DOUBLE_EQ(points.rms_vector, std::sqrt((4 + 16) / 2.0));
}

/// All spheres of a head touch one cone, from a base that is wider than the shaft to the point.
TEST_F(PointsArrows, HeadsAreCones) {
  EXPECT_EQ(load_rows("0,0,0,3,0,0,1\n"), "");
  double slope = 0;
  for (std::size_t i = 1; i < 1 + kHeadSpheres; ++i) {
    const double along = points.centers[i].x, radius = points.radii[i];
    if (i == 1) {
      EXPECT_GT(radius, 2 * points.bond_radius);
      continue;
    }
    const double fall = (points.radii[i - 1] - radius) / (along - points.centers[i - 1].x);
    if (i > 2) {
      EXPECT_NEAR(fall, slope, 1e-12);
    }
    slope = fall;
    EXPECT_LT(along - points.centers[i - 1].x, points.radii[i - 1]) << "spheres overlap";
  }
}

TEST_F(PointsArrows, ShortOnesHaveSmallerHeadsAndTheShortestNone) {
  EXPECT_EQ(load_rows("0,0,0,0.4,0,0,1\n1,0,0,0.2,0,0,1\n2,0,0,0,0,0,1\n"), "");
  EXPECT_EQ(points.arrow_count, 1u);
  EXPECT_GT(points.centers[3].x, 0);
  EXPECT_LT(points.radii[3], 0.2);
  expect_near(tip(0, {1, 0, 0}), {0.4, 0, 0});
}

TEST_F(PointsArrows, NonFiniteVectorsAreReported) {
  EXPECT_TRUE(test::mentions(load_rows("0,0,0,nan,0,0,1\n1,0,0,2,0,0,1\n2,0,0,0,inf,0,1\n"),
                             {"points[0].vectors.columns", "2", "3"}));
  EXPECT_EQ(points.arrow_count, 1u);
  EXPECT_EQ(points.bond_pairs.at(0).a, 1u);
}

TEST_F(PointsArrows, HaveTheColorOfTheirSphereButNotItsOpacity) {
  points.color.types = {{"1", {1, 0, 0}}, {"2", {0, 1, 0}}};
  points.opacity.types = {{"2", 0.25}};
  EXPECT_EQ(load_rows("0,0,0,2,0,0,1\n1,0,0,2,0,0,2\n"), "");
  for (std::size_t i = 0; i < kHeadSpheres; ++i) {
    EXPECT_EQ(color(2 + i), color(0));
    EXPECT_EQ(color(2 + kHeadSpheres + i), color(1));
    EXPECT_EQ(points.opacities.at(2 + kHeadSpheres + i), -1) << "that of the material";
  }
  EXPECT_EQ(points.opacities.at(1), 0.25F);
}

TEST_F(PointsArrows, FollowScaleAndTransform) {
  points.vectors.scale = 3;
  points.transform.scale = 2;
  points.transform.rotate = {0, 0, 90};
  points.transform.translate = {10, 0, 0};
  EXPECT_EQ(load_rows("1,0,0,1,0,0,1\n"), "");
  EXPECT_EQ(points.bond_radius, 0.2);
  expect_near(points.centers[0], {10, 2, 0});
  expect_near(tip(0, {0, 1, 0}), {10, 2 + 6, 0});
}

/// An arrow belongs to its sphere: clipping keeps or removes both.
TEST_F(PointsArrows, AreClippedWithTheirSphere) {
  points.clip[0] = scene::Interval{-1, 1};
  EXPECT_EQ(load_rows("0,0,0,5,0,0,1\n3,0,0,-3,0,0,1\n"), "");
  EXPECT_EQ(points.particle_count(), 1u);
  EXPECT_EQ(points.arrow_count, 1u);
  expect_near(tip(0, {1, 0, 0}), {5, 0, 0});
}

TEST_F(PointsArrows, AreRepeatedInPeriodicImages) {
  points.replicate = {2, 1, 1};
  points.vectors.columns = {"vx", "vy", "vz"};
  EXPECT_EQ(load("a.dump",
                 "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n0 4\n0 4\n0 4\n"
                 "ITEM: ATOMS id type x y z vx vy vz\n1 1 1 1 1 0 0 2\n"),
            "");
  ASSERT_EQ(points.arrow_count, 2u);
  expect_near(tip(0, {0, 0, 1}), {1, 1, 3});
  expect_near(tip(1, {0, 0, 1}), {5, 1, 3});
}

TEST_F(PointsArrows, ShareTheRadiusOfBonds) {
  points.bonds = {true, "", {}, 1.5, 0.07, {}};
  EXPECT_NE(load_rows("0,0,0,0,2,0,1\n1,0,0,0,2,0,1\n").find("error points[0].vectors.radius: shafts have the radius"),
            std::string::npos);
  points.vectors.radius.reset();
  EXPECT_EQ(load_rows("0,0,0,0,2,0,1\n1,0,0,0,2,0,1\n"), "");
  EXPECT_EQ(points.bond_radius, 0.07);
  EXPECT_EQ(points.bond_pairs,
            (std::vector<scene::SphereBond>{{0, 1}, {0, 2}, {1, static_cast<std::uint32_t>(2 + kHeadSpheres)}}));
}

TEST_F(PointsArrows, BelongToTheRowOfTheirSphere) {
  SourceRows source;
  request.source = &source;
  points.select = "type == 2";
  EXPECT_EQ(load_rows("0,0,0,2,0,0,1\n1,0,0,2,0,0,2\n"), "");
  EXPECT_EQ(source.rows, std::vector<std::uint32_t>(1 + kHeadSpheres, 1));
}

TEST_F(PointsArrows, NeedThreeColumnsOfNumbers) {
  points.vectors.columns = {"u", "v"};
  EXPECT_TRUE(test::mentions(load_rows("0,0,0,1,0,0,a\n"), {"points[0].vectors.columns", "2", "columns"}));
  points.vectors.columns = {"u", "v", "q"};
  EXPECT_NE(load_rows("0,0,0,1,0,0,a\n").find("error points[0].vectors.columns: "), std::string::npos);
  points.vectors.columns = {"u", "v", "type"};
  EXPECT_NE(load_rows("0,0,0,1,0,0,a\n").find("error points[0].vectors.columns: "), std::string::npos);
}

}  // namespace
}  // namespace orrery::points
