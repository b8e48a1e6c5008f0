// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "scene/validate.h"

namespace orrery::scene {
namespace {

Sphere sphere(Vec3d center, double radius) { return {center, radius, 0, ""}; }

/// Number of warnings.
std::size_t count(const Scene& scene) { return warn_of_coincident(scene, nullptr).size(); }

const std::string kRest = "; only the first is rendered";

TEST(SceneCoincident, ReportsBothSpheres) {
  Scene scene;
  scene.spheres = {sphere({0, 0, 0}, 1), sphere({1, 0, 0}, 1), sphere({0, 0, 0}, 1)};
  const auto found = warn_of_coincident(scene, nullptr);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].key, "sphere[2]");
  EXPECT_EQ(found[0].text, "has exactly the same centre and radius as sphere[0]" + kRest);
}

TEST(SceneCoincident, IgnoresTheSignsOfRadiusAndZero) {
  Scene scene;
  scene.spheres = {sphere({0.0, 0, 0}, 1), sphere({-0.0, 0, 0}, -1)};
  EXPECT_EQ(count(scene), 1u);
}

TEST(SceneCoincident, OneBitApartIsNotCoincident) {
  Scene scene;
  const double next = std::nextafter(1.0, 2.0);
  scene.spheres = {sphere({1, 2, 3}, 1), sphere({next, 2, 3}, 1), sphere({1, 2, 3}, next), sphere({2, 1, 3}, 1)};
  EXPECT_EQ(count(scene), 0u);
}

TEST(SceneCoincident, FastPrecisionComparesInSinglePrecision) {
  Scene scene;
  scene.spheres = {sphere({1, 2, 3}, 1), sphere({1 + 1e-9, 2, 3}, -1 - 1e-9)};
  EXPECT_EQ(count(scene), 0u);
  scene.render.precision = Precision::kFast;
  EXPECT_EQ(count(scene), 1u);
}

TEST(SceneCoincident, SpheresThatMoveApartDoNotCoincide) {
  Scene opening;
  opening.spheres = {sphere({0, 0, 0}, 1), sphere({0, 0, 0}, 1), sphere({0, 0, 0}, -1)};
  Scene closing = opening;
  closing.spheres[1].center.x = 1;
  EXPECT_EQ(count(opening), 2u);
  const auto found = warn_of_coincident(opening, &closing);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].key, "sphere[2]");
}

TEST(SceneCoincident, ComparesAcrossTablesAndPointsFiles) {
  Scene scene;
  scene.spheres = {sphere({1, 0, 0}, 2)};
  scene.points.resize(3);
  scene.points[0].centers = {{5, 0, 0}};
  scene.points[0].radii = {2};
  scene.points[2].centers = {{1, 0, 0}, {6, 0, 0}, {5, 0, 0}};
  scene.points[2].radii = {2, 2, 2};
  const std::string same = " has exactly the same centre and radius as ";
  const auto found = warn_of_coincident(scene, nullptr);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].key, "points[2].file");
  EXPECT_EQ(found[0].text, "row 1 of points[2]" + same + "sphere[0]" + kRest);
  EXPECT_EQ(found[1].text, "row 3 of points[2]" + same + "row 1 of points[0]" + kRest);
  scene.points[0].file = "a.csv";
  scene.points[2].file = "b.csv";
  scene.points[2].spheres_are_rows = false;
  EXPECT_EQ(warn_of_coincident(scene, nullptr)[1].text, "sphere 3 of b.csv" + same + "row 1 of a.csv" + kRest);
}

TEST(SceneCoincident, CountsAllAndListsTheFirst) {
  Scene scene;
  scene.points.resize(1);
  scene.points[0].centers = std::vector<Vec3d>(200000, Vec3d{1, 2, 3});
  scene.points[0].radii.assign(200000, 1);
  const auto found = warn_of_coincident(scene, nullptr);
  ASSERT_EQ(found.size(), kMaxReported + 1);
  EXPECT_EQ(found.back().text, "and 199996 more coincident spheres (199999 in all)");
}

TEST(SceneCoincident, ThreeCoincidentSpheresAreTwoReports) {
  Scene scene;
  scene.spheres = {sphere({}, 1), sphere({}, 1), sphere({}, 1)};
  EXPECT_EQ(count(scene), 2u);
}

TEST(SceneCoincident, NaNCoincidesWithNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Scene scene;
  scene.spheres = {sphere({nan, 0, 0}, 1), sphere({nan, 0, 0}, 1)};
  EXPECT_EQ(count(scene), 0u);
}

}  // namespace
}  // namespace orrery::scene
