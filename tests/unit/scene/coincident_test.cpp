// SPDX-License-Identifier: Apache-2.0
#include "scene/coincident.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace orrery::scene {
namespace {

Sphere sphere(Vec3d center, double radius) { return {center, radius, 0, ""}; }

TEST(SceneCoincident, ReportsBothSpheres) {
  Scene scene;
  scene.spheres = {sphere({0, 0, 0}, 1), sphere({1, 0, 0}, 1), sphere({0, 0, 0}, 1)};
  const auto found = coincident_spheres(scene, 10);
  ASSERT_EQ(found.count, 1u);
  EXPECT_EQ(found.reported[0].key, "sphere[2]");
  EXPECT_EQ(found.reported[0].first, "sphere[0]");
}

TEST(SceneCoincident, IgnoresTheSignsOfRadiusAndZero) {
  Scene scene;
  scene.spheres = {sphere({0.0, 0, 0}, 1), sphere({-0.0, 0, 0}, -1)};
  EXPECT_EQ(coincident_spheres(scene, 10).count, 1u);
}

TEST(SceneCoincident, OneBitApartIsNotCoincident) {
  Scene scene;
  const double next = std::nextafter(1.0, 2.0);
  scene.spheres = {sphere({1, 2, 3}, 1), sphere({next, 2, 3}, 1), sphere({1, 2, 3}, next), sphere({2, 1, 3}, 1)};
  EXPECT_EQ(coincident_spheres(scene, 10).count, 0u);
}

TEST(SceneCoincident, FastPrecisionComparesInSinglePrecision) {
  Scene scene;
  scene.spheres = {sphere({1, 2, 3}, 1), sphere({1 + 1e-9, 2, 3}, -1 - 1e-9)};
  EXPECT_EQ(coincident_spheres(scene, 10).count, 0u);
  scene.render.precision = Precision::kFast;
  EXPECT_EQ(coincident_spheres(scene, 10).count, 1u);
}

TEST(SceneCoincident, SpheresThatMoveApartDoNotCoincide) {
  Scene opening;
  opening.spheres = {sphere({0, 0, 0}, 1), sphere({0, 0, 0}, 1), sphere({0, 0, 0}, -1)};
  Scene closing = opening;
  closing.spheres[1].center.x = 1;
  EXPECT_EQ(coincident_spheres(opening, 10).count, 2u);
  const auto found = coincident_spheres(opening, 10, &closing);
  ASSERT_EQ(found.count, 1u);
  EXPECT_EQ(found.reported[0].key, "sphere[2]");
}

TEST(SceneCoincident, ComparesAcrossTablesAndPointsFiles) {
  Scene scene;
  scene.spheres = {sphere({1, 0, 0}, 2)};
  scene.points.resize(3);
  scene.points[0].centers = {{5, 0, 0}};
  scene.points[0].radii = {2};
  scene.points[2].centers = {{1, 0, 0}, {6, 0, 0}, {5, 0, 0}};
  scene.points[2].radii = {2, 2, 2};
  const auto found = coincident_spheres(scene, 10);
  ASSERT_EQ(found.reported.size(), 2u);
  EXPECT_EQ(found.reported[0].key, "points[2].file");
  EXPECT_EQ(found.reported[0].name, "row 1 of points[2]");
  EXPECT_EQ(found.reported[0].first, "sphere[0]");
  EXPECT_EQ(found.reported[1].name, "row 3 of points[2]");
  EXPECT_EQ(found.reported[1].first, "row 1 of points[0]");
  scene.points[0].file = "a.csv";
  scene.points[2].file = "b.csv";
  scene.points[2].spheres_are_rows = false;
  const Coincident named = coincident_spheres(scene, 10).reported[1];
  EXPECT_EQ(named.name, "sphere 3 of b.csv");
  EXPECT_EQ(named.first, "row 1 of a.csv");
}

TEST(SceneCoincident, CountsAllAndListsTheFirst) {
  Scene scene;
  scene.points.resize(1);
  scene.points[0].centers = std::vector<Vec3d>(200000, Vec3d{1, 2, 3});
  scene.points[0].radii.assign(200000, 1);
  const auto found = coincident_spheres(scene, 3);
  EXPECT_EQ(found.count, 199999u);
  EXPECT_EQ(found.reported.size(), 3u);
}

TEST(SceneCoincident, ThreeCoincidentSpheresAreTwoReports) {
  Scene scene;
  scene.spheres = {sphere({}, 1), sphere({}, 1), sphere({}, 1)};
  EXPECT_EQ(coincident_spheres(scene, 10).count, 2u);
}

TEST(SceneCoincident, NaNCoincidesWithNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Scene scene;
  scene.spheres = {sphere({nan, 0, 0}, 1), sphere({nan, 0, 0}, 1)};
  EXPECT_EQ(coincident_spheres(scene, 10).count, 0u);
}

}  // namespace
}  // namespace orrery::scene
