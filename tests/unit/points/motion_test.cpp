// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/error.h"
#include "points/copies.h"
#include "points_file.h"
#include "support/mentions.h"

namespace orrery::points {
namespace {

using math::Vec3d;
using test::mentions;

/// A frame of a LAMMPS dump in a periodic box of 10 x 20 x 30.
std::string frame(const std::vector<std::string>& rows, const std::string& columns = "id x y z") {
  std::string out = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n" + std::to_string(rows.size()) +
                    "\nITEM: BOX BOUNDS pp pp pp\n0 10\n0 20\n0 30\nITEM: ATOMS " + columns + "\n";
  for (const std::string& row : rows) out += row + "\n";
  return out;
}

/// Spheres that move to the next frame, or by velocities.
class PointsMotion : public PointsFile {
 protected:
  PointsMotion() {
    points.radius.value = 1;
    request.moves_from = 0;
  }
  void expect_near(const scene::PointArray& found, const std::vector<Vec3d>& expected) const {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
      EXPECT_LT(math::length(found[i] - expected[i]), 1e-6) << i << ": " << found[i].x << ' ' << found[i].y;
  }
  std::string load_next(const std::string& text) {
    points.motion.next_frame = true;
    return load("a.dump", text);
  }
};

TEST_F(PointsMotion, ParticlesMoveToTheNearestImageOfTheirPlaceInTheNextFrame) {
  EXPECT_EQ(load_next(frame({"1 9.5 1 2", "2 3 4 5"}) + frame({"2 3 4.5 5", "1 0.25 1 2"})), "");
  expect_near(points.to_next, {{0.75, 0, 0}, {0, 0.5, 0}});
  EXPECT_TRUE(points.to_previous.empty());
}

TEST_F(PointsMotion, TheLastFrameGoesOnAsBefore) {
  const std::string text = frame({"1 1 1 1"}) + frame({"1 2 1 1"}) + frame({"1 2 4 1"});
  request.frame = 3;
  request.has_previous = true;
  EXPECT_EQ(load_next(text), "");
  expect_near(points.to_next, {{0, 3, 0}});
  EXPECT_TRUE(points.to_previous.empty());
  request.frame = 2;
  EXPECT_EQ(load(), "");
  expect_near(points.to_next, {{0, 3, 0}});
  expect_near(points.to_previous, {{-1, 0, 0}});
  EXPECT_EQ(points.displacement(0, -1).x, -1);
  EXPECT_EQ(points.displacement(0, 0.5).y, 1.5);
}

TEST_F(PointsMotion, WhatIsNotWantedIsNotRead) {
  request.moves_from = {};
  EXPECT_EQ(load_next(frame({"1 1 1 1"})), "");
  EXPECT_TRUE(points.to_next.empty());
}

TEST_F(PointsMotion, ParticlesThatAreNotInTheNextFrameRest) {
  const std::string said = load_next(frame({"1 1 1 1", "2 2 2 2", "5 3 3 3"}) + frame({"5 3.5 3 3", "1 1 1 2"}));
  EXPECT_TRUE(mentions(said, {"warning", "next_frame", "1 of 3"})) << said;
  expect_near(points.to_next, {{0, 0, 1}, {0, 0, 0}, {0.5, 0, 0}});
}

TEST_F(PointsMotion, WithoutIdsAnotherCountIsAnError) {
  const std::string said = load_next(frame({"1 1 1", "2 2 2"}, "x y z") + frame({"1 1 1"}, "x y z"));
  EXPECT_TRUE(mentions(said, {"error points[0].motion.next_frame", "2 particles", "frame_time"})) << said;
  EXPECT_EQ(load_next(frame({"1 1 1", "2 2 2"}, "x y z") + frame({"1 1 2", "2 2 2"}, "x y z")), "");
  expect_near(points.to_next, {{0, 0, 1}, {0, 0, 0}});
}

TEST_F(PointsMotion, AnUncertainImageIsReported) {
  const std::string said = load_next(frame({"1 1 1 1", "2 2 2 2"}) + frame({"1 5 1 1", "2 2 2 3"}));
  EXPECT_TRUE(mentions(said, {"warning", "1 of 2", "quarter"})) << said;
}

TEST_F(PointsMotion, ASingleFrameHasNoNext) {
  EXPECT_TRUE(
      mentions(load_next(frame({"1 1 1 1"})), {"error points[0].motion.next_frame", "one frame", "frame_time"}));
}

TEST_F(PointsMotion, SequencesOfFilesGoOnInTheNextFile) {
  write("a.02.dump", frame({"1 1 2 1"}));
  write("a.01.dump", frame({"1 1 1 1"}));
  points.sequence = "a.##.dump";
  points.motion.next_frame = true;
  EXPECT_EQ(load(), "");
  expect_near(points.to_next, {{0, 1, 0}});
}

TEST_F(PointsMotion, VelocitiesAreMultipliedByTheTimeOfAFrame) {
  const std::string text = "x,y,z,vx,vy,vz,ux,uy,uz\n1,2,3,2,0,-4,1,1,1\n";
  points.motion.frame_time = 0.5;
  EXPECT_EQ(load("a.csv", text), "");
  expect_near(points.to_next, {{1, 0, -2}});
  EXPECT_LT(points.displacement(0, -1).x, 0) << "uniform motion";
  points.motion.columns = {"ux", "uy", "uz"};
  EXPECT_EQ(load("a.csv", text), "");
  expect_near(points.to_next, {{0.5, 0.5, 0.5}});
}

TEST_F(PointsMotion, KeysThatExcludeOrNeedEachOtherAreErrors) {
  points.motion.columns = {"vx", "vy", "vz"};
  EXPECT_TRUE(mentions(load("a.csv", "x,y,z,vx,vy,vz\n1,2,3,2,0,-4\n"), {"error points[0].motion:", "frame_time"}));
  points.motion.frame_time = 1;
  EXPECT_TRUE(mentions(load("a.csv", "x,y,z,vx,vy\n1,2,3,2,0\n"), {"error points[0].motion.columns", "`vz`"}));
  points.motion.columns = {"vx", "vy"};
  EXPECT_TRUE(mentions(load(), {"error points[0].motion.columns", "2 columns"}));
  points.motion.columns = {};
  EXPECT_TRUE(mentions(load(), {"error points[0].motion:", "no velocities", "next_frame"}));
  points.motion.next_frame = true;
  EXPECT_TRUE(mentions(load(), {"error points[0].motion:", "excludes"}));
}

TEST_F(PointsMotion, MotionThatIsNotFiniteIsAnErrorOrLeftOut) {
  const std::string text = "x,y,z,vx,vy,vz\n1,2,3,nan,0,0\n4,5,6,1,0,0\n7,8,9,1e200,0,0\n";
  points.motion.frame_time = 1;
  EXPECT_TRUE(mentions(load("a.csv", text), {"error points[0].motion", "row 1 of a.csv", "2 of 3", "skip_bad"}));
  EXPECT_TRUE(points.to_next.empty() && points.centers.empty());
  points.skip_bad = true;
  EXPECT_TRUE(mentions(load(), {"warning", "2 of 3"}));
  expect_near(points.to_next, {{0, 0, 0}, {1, 0, 0}, {0, 0, 0}});
}

TEST_F(PointsMotion, CopiesMoveAsTheirParticles) {
  points.replicate = {2, 1, 1};
  points.transform.scale = 2;
  points.transform.rotate = {0, 0, 90};
  points.clip[1] = scene::Interval{0, 100};
  EXPECT_EQ(load_next(frame({"1 1 1 1", "2 3 4 5"}) + frame({"1 1.5 1 1", "2 3 5 5"})), "");
  expect_near(points.to_next, {{0, 1, 0}, {-2, 0, 0}, {0, 1, 0}, {-2, 0, 0}});
  points.clip[1] = scene::Interval{10, 100};
  EXPECT_EQ(load(), "");
  expect_near(points.to_next, {{0, 1, 0}, {-2, 0, 0}});
}

TEST_F(PointsMotion, ArrowsAndStubsMoveWithTheirSpheres) {
  points.vectors.columns = {"vx", "vy", "vz"};
  points.motion.frame_time = 1;
  points.bonds.are_drawn = true;
  points.bonds.length = 2;
  points.bonds.radius = 0.1;
  request.moves_from = 0.5;
  EXPECT_EQ(load("a.dump", frame({"1 0.5 1 1 0 1 0", "2 9.5 1 1 0 3 0"}, "id x y z vx vy vz")), "");
  ASSERT_EQ(points.to_next.size(), points.centers.size());
  ASSERT_EQ(points.centers.size(), 2 + 2 * kHeadSpheres);
  EXPECT_EQ(points.to_next[2].y, 1);
  EXPECT_EQ(points.to_next[2 + kHeadSpheres].y, 3);
  EXPECT_EQ(points.centers[0].y, 1.5) << "when the shutter opens";
  ASSERT_EQ(points.bond_stubs.size(), 2u);
  EXPECT_EQ(points.bond_stubs[0].end.y, 2) << "between the two";
}

TEST_F(PointsMotion, MemoryOfDisplacementsIsChecked) {
  std::string rows = "x,y,z,vx,vy,vz\n";
  for (int i = 0; i < 1000; ++i) rows += std::to_string(i) + ".1,2,3,1,1,1\n";
  request.memory_limit = 60'000;
  EXPECT_EQ(load("a.csv", rows), "");
  points.motion.frame_time = 1;
  EXPECT_THROW(load(), base::Error);
}

}  // namespace
}  // namespace orrery::points
