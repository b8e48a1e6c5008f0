// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "points/load_points.h"
#include "points_file.h"
#include "support/mentions.h"

namespace orrery::points {
namespace {

class PointsLoadRods : public PointsFile {
 protected:
  std::string load_rods_of(const std::string& text) {
    write("rods.csv", text);
    rods_.file = "rods.csv";
    request.key = "rods[0]";
    return text_of(load_rods(request, rods_));
  }
  scene::RodFile rods_;
};

TEST_F(PointsLoadRods, RowsAreEndsAndARadius) {
  EXPECT_EQ(load_rods_of("x0,y0,z0,x1,y1,z1,radius\n1,2,3,4,5,6,0.5\n0,0,0,1,0,0,0.25\n"), "");
  ASSERT_EQ(rods_.from.size(), 2u);
  EXPECT_EQ(rods_.from[0], (math::Vec3d{1, 2, 3}));
  EXPECT_EQ(rods_.to[0], (math::Vec3d{4, 5, 6}));
  EXPECT_EQ(rods_.radii[1], 0.25);
}

TEST_F(PointsLoadRods, OneRadiusReplacesTheColumn) {
  rods_.radius = 0.125;
  EXPECT_EQ(load_rods_of("x0,y0,z0,x1,y1,z1\n1,2,3,4,5,6\n"), "");
  EXPECT_EQ(rods_.radii[0], 0.125);
}

TEST_F(PointsLoadRods, MissingColumnsAreNamed) {
  EXPECT_TRUE(test::mentions(load_rods_of("x0,y0,z0,x1,y1\n1,2,3,4,5\n"), {"rods[0].file", "`z1`", "`radius`"}));
}

TEST_F(PointsLoadRods, AFileWithoutRowsIsAWarning) {
  EXPECT_TRUE(test::mentions(load_rods_of("x0,y0,z0,x1,y1,z1,radius\n"), {"warning", "no rows"}));
}

TEST_F(PointsLoadRods, RodsMustFitIntoMemory) {
  request.memory_limit = 1;
  EXPECT_THROW(load_rods_of("x0,y0,z0,x1,y1,z1,radius\n1,2,3,4,5,6,0.5\n"), base::Error);
}

}  // namespace
}  // namespace orrery::points
