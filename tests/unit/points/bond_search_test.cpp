// SPDX-License-Identifier: Apache-2.0
#include "points/bonds.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <tuple>
#include <vector>

namespace orrery::points {
namespace {

using data::Box;
using math::Vec3d;

/// A bond to an image, as found from both ends or from one.
using Found = std::set<std::tuple<std::uint32_t, std::uint32_t, Shift>>;

Found found(const BondSet& bonds) {
  Found out;
  for (const scene::SphereBond& bond : bonds.pairs) EXPECT_TRUE(out.insert({bond.a, bond.b, Shift{0, 0, 0}}).second);
  for (const CrossingBond& bond : bonds.crossing) {
    EXPECT_NE(bond.shift, (Shift{0, 0, 0}));
    EXPECT_TRUE(out.insert({bond.a, bond.b, bond.shift}).second);
  }
  return out;
}

/// All pairs and all images up to `images` boxes away.
Found brute_force(const std::vector<Vec3d>& points, const Reach& reach, const std::optional<Box>& box, int images) {
  Found out;
  const auto steps = [&](int axis) { return box && box->periodic[static_cast<std::size_t>(axis)] ? images : 0; };
  const auto label = [&](std::uint32_t i) { return reach.labels.empty() ? 0 : reach.labels[i]; };
  for (std::uint32_t a = 0; a < points.size(); ++a)
    for (std::uint32_t b = a; b < points.size(); ++b)
      for (int x = -steps(0); x <= steps(0); ++x)
        for (int y = -steps(1); y <= steps(1); ++y)
          for (int z = -steps(2); z <= steps(2); ++z) {
            const Shift shift = {x, y, z};
            if (a == b && !(shift > Shift{0, 0, 0})) continue;
            Vec3d d = points[b] - points[a];
            if (box) d = d + box->edges[0] * x + box->edges[1] * y + box->edges[2] * z;
            const double longest = reach.of_label[label(a)] + reach.of_label[label(b)];
            if (math::length(d) < longest && math::length(d) >= longest * reach.smallest) out.insert({a, b, shift});
          }
  return out;
}

std::vector<Vec3d> random_points(std::size_t count, Vec3d low, Vec3d high, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Vec3d> out;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = unit(random), y = unit(random), z = unit(random);
    out.push_back({low.x + x * (high.x - low.x), low.y + y * (high.y - low.y), low.z + z * (high.z - low.z)});
  }
  return out;
}

Reach uniform(double length) { return {{length / 2}, {}, 0}; }

TEST(PointsBondSearch, WithoutABoxAllClosePairsAreFound) {
  std::mt19937 random(1);
  for (const double size : {0.5, 3.0, 10.0, 300.0}) {
    const std::vector<Vec3d> points = random_points(300, {-size, 5, -2 * size}, {size, 6 + size, 0}, random);
    Reach reach{{0.2, 0.35, 0.5}, {}, 1.0 / 3};
    for (std::size_t i = 0; i < points.size(); ++i) reach.labels.push_back(static_cast<std::uint32_t>(random() % 3));
    if (size < 1) reach.of_label = {0.02, 0.03, 0.05};
    const auto bonds = find_bonds(points, reach, Lattice({}));
    ASSERT_TRUE(bonds) << size;
    EXPECT_EQ(found(*bonds), brute_force(points, reach, {}, 0)) << size;
  }
}

TEST(PointsBondSearch, PeriodicAndTriclinicBoxesAgreeWithBruteForce) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> tilt(-0.9, 0.9), edge(0.8, 6);
  std::size_t crossing = 0, of_itself = 0;
  for (int round = 0; round < 60; ++round) {
    Box box;
    box.origin = {-3, 1, 100};
    box.edges = {Vec3d{edge(random), tilt(random) * (round % 3), 0}, Vec3d{tilt(random), edge(random), tilt(random)},
                 Vec3d{tilt(random) * 2, tilt(random), edge(random)}};
    box.periodic = {true, round % 5 != 0, round % 4 != 0};
    const Lattice lattice(box);
    ASSERT_TRUE(lattice.is_periodic(0));
    std::vector<Vec3d> points;
    for (const Vec3d& f : random_points(20, {-1.5, -0.2, 0}, {1.5, 1.2, 1}, random))
      points.push_back(box.origin + box.edges[0] * f.x + box.edges[1] * f.y + box.edges[2] * f.z);
    const auto bonds = find_bonds(points, uniform(1.1), lattice);
    ASSERT_TRUE(bonds) << round;
    const Found all = found(*bonds);
    // The points are up to three boxes apart, and small boxes have several images in reach.
    EXPECT_EQ(all, brute_force(points, uniform(1.1), box, 8)) << round;
    crossing += bonds->crossing.size();
    for (const CrossingBond& bond : bonds->crossing) of_itself += bond.a == bond.b ? 1 : 0;
  }
  EXPECT_GT(crossing, 1000u);
  EXPECT_GT(of_itself, 20u);
}

TEST(PointsBondSearch, FarPointsDoNotMakeTheOthersOneCell) {
  std::mt19937 random(3);
  std::vector<Vec3d> points = random_points(20000, {0, 0, 0}, {60, 60, 60}, random);
  for (const double far : {1e9, -3e12, 1e17, -1e18}) points.push_back({far, -far, far});
  points.push_back({1e9 + 0.5, -1e9, 1e9});
  const auto bonds = find_bonds(points, uniform(1), Lattice({}));
  ASSERT_TRUE(bonds);
  const std::vector<Vec3d> near(points.begin(), points.begin() + 20000);
  const auto without = find_bonds(near, uniform(1), Lattice({}));
  EXPECT_EQ(bonds->pairs.size(), without->pairs.size() + 1);
  EXPECT_EQ(bonds->pairs.back(), (scene::SphereBond{20000, 20004}));
}

TEST(PointsBondSearch, TheResultDoesNotDependOnThreads) {
  std::mt19937 random(4);
  const std::vector<Vec3d> points = random_points(50000, {0, 0, 0}, {50, 50, 50}, random);
  Box box;
  box.edges = {Vec3d{50, 0, 0}, Vec3d{0, 50, 0}, Vec3d{0, 0, 50}};
  std::optional<BondSet> first;
  for (const std::size_t threads : {std::size_t{1}, std::size_t{2}, std::size_t{7}}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const auto bonds = find_bonds(points, uniform(1.2), Lattice(box));
    ASSERT_TRUE(bonds);
    EXPECT_TRUE(std::is_sorted(bonds->pairs.begin(), bonds->pairs.end()));
    if (!first) first = bonds;
    EXPECT_TRUE(bonds->pairs == first->pairs && bonds->crossing == first->crossing);
  }
  EXPECT_GT(first->crossing.size(), 100u);
}

TEST(PointsBondSearch, TooManyNeighborsAreRefused) {
  std::vector<Vec3d> points;
  for (std::size_t i = 0; i <= kMaxNeighbors; ++i) points.push_back({static_cast<double>(i), 0, 0});
  EXPECT_TRUE(find_bonds(points, uniform(64.5), Lattice({})));
  points.push_back({-1, 0, 0});
  EXPECT_FALSE(find_bonds(points, uniform(64.5), Lattice({})));
  // One particle, whose images alone are too many.
  Box box;
  EXPECT_FALSE(find_bonds(std::vector<Vec3d>{{0, 0, 0}}, uniform(1e6), Lattice(box)));
}

TEST(PointsBondSearch, AFlatBoxHasNoImages) {
  Box box;
  box.edges[2] = {1, 1, 0};
  EXPECT_FALSE(Lattice(box).is_periodic());
  box.edges[2] = {0, 0, 0};
  box.periodic[2] = false;
  EXPECT_TRUE(Lattice(box).is_periodic(0)) << "two dimensions";
  EXPECT_FALSE(Lattice({}).is_periodic());
}

TEST(PointsBondSearch, TheNearestImageIsFoundInTiltedBoxes) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> tilt(-1, 1);
  for (int round = 0; round < 200; ++round) {
    Box box;
    box.edges = {Vec3d{4, 0, 0}, Vec3d{2 * tilt(random), 4, 0}, Vec3d{2 * tilt(random), 2 * tilt(random), 4}};
    box.periodic[2] = round % 3 != 0;
    const Lattice lattice(box);
    const std::vector<Vec3d> points = random_points(2, {-9, -9, -9}, {9, 9, 9}, random);
    const Vec3d d = points[1] - points[0];
    double nearest = math::length(d);
    const int steps = box.periodic[2] ? 8 : 0;
    for (int x = -16; x <= 16; ++x)
      for (int y = -12; y <= 12; ++y)
        for (int z = -steps; z <= steps; ++z)
          nearest = std::min(nearest, math::length(d + lattice.translation({x, y, z})));
    const Shift shift = lattice.shift_to_nearest(points[0], points[1]);
    EXPECT_NEAR(math::length(d + lattice.translation(shift)), nearest, 1e-12);
  }
}

}  // namespace
}  // namespace orrery::points
