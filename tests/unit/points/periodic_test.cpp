// SPDX-License-Identifier: Apache-2.0
#include "points/periodic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace orrery::points {
namespace {

using data::Column;

/// A triclinic box away from the origin.
data::Box triclinic() {
  data::Box box;
  box.origin = {-1, 2, 3};
  box.edges = {Vec3d{10, 0, 0}, Vec3d{2, 8, 0}, Vec3d{-1, 3, 6}};
  return box;
}

Vec3d at_fractions(const data::Box& box, Vec3d f) {
  return box.origin + f.x * box.edges[0] + f.y * box.edges[1] + f.z * box.edges[2];
}

TEST(PointsPeriodic, UnwrapMovesByImages) {
  std::vector<Vec3d> centers = {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
  const Column ix{"ix", std::vector<std::int64_t>{0, 2, -1}}, iy{"iy", std::vector<std::int32_t>{0, 1, 0}},
      iz{"iz", std::vector<double>{0, -1, 1}};
  unwrap(centers, triclinic(), {&ix, &iy, &iz});
  EXPECT_EQ(centers[0], (Vec3d{1, 2, 3}));
  EXPECT_EQ(centers[1], (Vec3d{1 + 20 + 2 + 1, 2 + 8 - 3, 3 - 6}));
  EXPECT_EQ(centers[2], (Vec3d{1 - 10 - 1, 2 + 3, 3 + 6}));
}

TEST(PointsPeriodic, UnwrapSkipsMissingColumnsAndKeepsNan) {
  std::vector<Vec3d> centers = {{1, 2, 3}, {1, 2, 3}};
  const Column iy{"iy", std::vector<double>{1, std::numeric_limits<double>::quiet_NaN()}};
  unwrap(centers, triclinic(), {nullptr, &iy, nullptr});
  EXPECT_EQ(centers[0], (Vec3d{3, 10, 3}));
  EXPECT_TRUE(std::isnan(centers[1].x));
}

TEST(PointsPeriodic, CountsPointsOutside) {
  data::Box box = triclinic();
  std::vector<Vec3d> centers;
  for (const Vec3d f : {Vec3d{0, 0, 0}, Vec3d{1, 1, 1}, Vec3d{0.5, 0.5, 0.5}, Vec3d{1 + 1e-12, -1e-12, 0.3}})
    centers.push_back(at_fractions(box, f));
  EXPECT_EQ(count_outside(centers, box), 0u);
  for (const Vec3d f : {Vec3d{-0.01, 0.5, 0.5}, Vec3d{0.5, 1.01, 0.5}, Vec3d{0.5, 0.5, -7}, Vec3d{2, 2, 2}})
    centers.push_back(at_fractions(box, f));
  EXPECT_EQ(count_outside(centers, box), 4u);
  box.periodic = {true, false, true};
  EXPECT_EQ(count_outside(centers, box), 3u);
  EXPECT_EQ(count_outside({}, box), 0u);
}

TEST(PointsPeriodic, ReplicasFillALattice) {
  const std::vector<Vec3d> all = replica_translations(triclinic(), {2, 1, 3});
  ASSERT_EQ(all.size(), 6u);
  EXPECT_EQ(all[0], (Vec3d{0, 0, 0}));
  EXPECT_EQ(all[1], (Vec3d{10, 0, 0}));
  EXPECT_EQ(all[2], (Vec3d{-1, 3, 6}));
  EXPECT_EQ(all[5], (Vec3d{8, 6, 12}));
  EXPECT_EQ(replica_translations(triclinic(), {1, 1, 1}).size(), 1u);
}

TEST(PointsPeriodic, TransformsRotateThenTranslate) {
  // A quarter turn about z: x becomes y.
  data::Transform transform;
  transform.rows = {Vec3d{0, -1, 0}, Vec3d{1, 0, 0}, Vec3d{0, 0, 1}};
  transform.translation = {10, 20, 30};
  EXPECT_EQ(transformed(transform, {1, 0, 0}), (Vec3d{10, 21, 30}));
  EXPECT_EQ(transformed(transform, {1, 2, 3}), (Vec3d{8, 21, 33}));
  EXPECT_EQ(transformed({}, {1, 2, 3}), (Vec3d{1, 2, 3}));
}

TEST(PointsPeriodic, PartsOfAnAssemblySelectChains) {
  const Column chain{"chain", data::Words{{"A", "B", "AA"}, {0, 1, 2, 0, 1}}};
  data::AssemblyPart part;
  part.chains = {"AA", "A", "missing"};
  EXPECT_EQ(rows_of_part(part, &chain, 5), (std::vector<std::uint8_t>{1, 0, 1, 1, 0}));
  part.chains = {};
  EXPECT_EQ(rows_of_part(part, &chain, 5), (std::vector<std::uint8_t>(5, 1)));
  EXPECT_EQ(rows_of_part(part, nullptr, 2), (std::vector<std::uint8_t>(2, 1)));
}

}  // namespace
}  // namespace orrery::points
