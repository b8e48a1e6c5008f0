// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "points_file.h"
#include "scene/validate.h"
#include "support/mentions.h"

namespace orrery::points {
namespace {

using math::Vec3d;
using Numbers = std::vector<double>;
using PointsValidSpheres = PointsFile;

TEST_F(PointsValidSpheres, RowsOutsideTheDomainAreNamed) {
  const std::string text = "x,y,z,radius\n0,0,0,1\n1,0,0,1e-40\n2e18,0,0,1\n3,0,0,1\n";
  write("a.csv", text);
  points.select = "x > 0";
  const std::vector<scene::SceneDiagnostic> diagnostics = load_points(request, points);
  ASSERT_EQ(diagnostics.size(), 2u) << text_of(diagnostics);
  EXPECT_EQ(diagnostics[0].key, "points[0].file");
  EXPECT_TRUE(test::mentions(diagnostics[0].text, {"2", "a.csv", "1e-40", "1e-30..1e+18"}));
  EXPECT_TRUE(test::mentions(diagnostics[1].text, {"3", "a.csv", "[2e+18, 0, 0]", "1e+18"}));
  points.transform.scale = 1e15;
  points.transform.translate = {-1e18, 0, 0};
  EXPECT_EQ(load_points(request, points)[0].text.substr(0, 24), "row 3 of a.csv: center [");
  points.select.clear();
  points.transform.scale = 0.1;
  points.transform.translate = {0, 0, 0};
  write("a.csv", "x,y,z,radius\n2e18,0,0,2e18\n0,0,0,1\n");
  EXPECT_EQ(load_points(request, points).size(), 0u) << "in the domain after the transform";
  EXPECT_EQ(points.centers[0].x, 2e17);
}

/// Twelve rows without usable numbers, one good row in front.
std::string bad_rows() {
  std::string out = "x,y,z,radius\n0,0,0,1\n";
  for (int i = 0; i < 10; ++i) out += std::to_string(i) + ",nan,0,1\n";
  return out + "10,0,inf,1\n11,0,0,0\n12,0,0,nan\n";
}

TEST_F(PointsValidSpheres, BadRowsAreErrors) {
  write("a.csv", bad_rows());
  const std::vector<scene::SceneDiagnostic> diagnostics = load_points(request, points);
  ASSERT_EQ(diagnostics.size(), scene::kMaxReported + 1) << text_of(diagnostics);
  for (const auto& d : diagnostics) EXPECT_EQ(d.kind, base::ErrorKind::kBadData);
  EXPECT_TRUE(test::mentions(diagnostics[0].text, {"2", "a.csv", "[0, nan, 0]", "1"}));
  EXPECT_TRUE(test::mentions(diagnostics.back().text, {"13", "14", "0", "`skip_bad = true`"}));
  EXPECT_TRUE(points.centers.empty());
}

/// A sphere of radius -1 looks like one of radius 1, unless it is of glass.
TEST_F(PointsValidSpheres, NegativeRadiiAreBadExceptInPlyFiles) {
  EXPECT_NE(
      load("a.csv", "x,y,z,radius\n1,0,0,1\n2,0,0,-1\n").find("row 2 of a.csv has center [2, 0, 0] and radius -1"),
      std::string::npos);
  points.skip_bad = true;
  EXPECT_NE(load("a.csv", "x,y,z,radius\n1,0,0,1\n2,0,0,-1\n").find("1 of 2 rows were left out"), std::string::npos);
  EXPECT_EQ(points.radii, Numbers{1});
  points.skip_bad = false;
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
      "property float radius\nend_header\n2 0 0 -1\n";
  EXPECT_EQ(load("a.ply", ply), "");
  EXPECT_EQ(points.radii, Numbers{-1}) << "the inside of hollow glass";
  points.radius.value = -2;
  EXPECT_EQ(load("b.csv", "x,y,z\n1,0,0\n"), "");
  EXPECT_EQ(points.radii, Numbers{-2});
}

TEST_F(PointsValidSpheres, BadRowsCanBeSkipped) {
  points.skip_bad = true;
  points.color.column = "x";
  EXPECT_TRUE(test::mentions(load("a.csv", bad_rows()), {"points[0].skip_bad", "13", "14", "0"}));
  EXPECT_EQ(points.centers, (std::vector<Vec3d>{{0, 0, 0}}));
  EXPECT_EQ(points.radii, Numbers{1});
  EXPECT_EQ(points.colors.size(), 1u);
  EXPECT_TRUE(test::mentions(load("b.csv", "x,y,z,radius\n1,0,0,1\nnan,0,0,2\n3,0,0,3\n").substr(0, 40),
                             {"points[0].skip_bad", "1", "3"}));
  EXPECT_EQ(x(), (Numbers{1, 3}));
  EXPECT_EQ(points.radii, (Numbers{1, 3}));
  EXPECT_TRUE(test::mentions(load("c.csv", "x,y,z,radius\nnan,0,0,2\n"), {"points[0].skip_bad", "1", "1", "0"}))
      << "no selection is to blame";
}

TEST_F(PointsValidSpheres, BadRowsThatAreNotSelectedDoNotMatter) {
  points.select = "y == 0";
  EXPECT_EQ(load("a.csv", "x,y,z,radius\n1,0,0,1\n2,nan,0,1\n"), "");
  EXPECT_EQ(x(), Numbers{1});
}

}  // namespace
}  // namespace orrery::points
