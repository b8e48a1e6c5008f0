// SPDX-License-Identifier: Apache-2.0
#include "data/crystal.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace orrery::data {

namespace {

constexpr std::array<double, 6> kCube = {4, 4, 4, 90, 90, 90}, kHexagonal = {4, 4, 6, 90, 90, 120};

TEST(DataCrystal, CellsHaveAAlongXAndBInThePlaneOfXAndY) {
  const auto box = cell_box({3, 4, 5, 80, 95, 110});
  ASSERT_TRUE(box);
  const Vec3d a = box->edges[0], b = box->edges[1], c = box->edges[2];
  EXPECT_EQ(a, (Vec3d{3, 0, 0}));
  EXPECT_EQ(b.z, 0);
  const auto angle = [](Vec3d p, Vec3d q) {
    return std::acos(math::dot(p, q) / (math::length(p) * math::length(q))) * 180 / M_PI;
  };
  EXPECT_NEAR(math::length(b), 4, 1e-12);
  EXPECT_NEAR(math::length(c), 5, 1e-12);
  EXPECT_NEAR(angle(b, c), 80, 1e-9);
  EXPECT_NEAR(angle(a, c), 95, 1e-9);
  EXPECT_NEAR(angle(a, b), 110, 1e-9);
}

TEST(DataCrystal, CellsWithoutVolumeAreNone) {
  EXPECT_TRUE(cell_box(kCube));
  EXPECT_FALSE(cell_box({0, 0, 0, 0, 0, 0}));
  EXPECT_FALSE(cell_box({4, 4, 0, 90, 90, 90}));
  EXPECT_FALSE(cell_box({4, 4, 4, 90, 90, 180})) << "flat";
  EXPECT_FALSE(cell_box({4, 4, 4, 30, 30, 120})) << "there is no such cell";
  EXPECT_FALSE(cell_box({4, 4, 4, 90, 90, std::nan("")}));
}

/// An operator applied to a point that no other operator maps to the same place.
std::string applied(const char* text) {
  const auto op = operator_of(text);
  if (!op) return "none";
  const Vec3d p{0.1, 0.01, 0.001};
  std::string out;
  for (const double x : {math::dot(op->rows[0], p) + op->translation.x, math::dot(op->rows[1], p) + op->translation.y,
                         math::dot(op->rows[2], p) + op->translation.z})
    out += std::to_string(std::lround(x * 1000)) + ' ';
  return out;
}

TEST(DataCrystal, OperatorsAreReadInAllNotations) {
  EXPECT_EQ(applied("x,y,z"), "100 10 1 ");
  EXPECT_EQ(applied("-x, -Y+1/2, z - 1/4"), "-100 490 -249 ");
  EXPECT_EQ(applied("1/2+x,1/2 -y,-z"), "600 490 -1 ");
  EXPECT_EQ(applied("-y,x-y,z+0.25"), "-10 90 251 ");
  EXPECT_EQ(applied("+x,2*y,z/2"), "100 20 1 ");
  EXPECT_EQ(applied("x+y+z,y,z"), "111 10 1 ");
  for (const char* const bad : {"", "x,y", "x,y,z,1", "x,y,w", "x,y,", "x,y,z+", "x,y,1/0", "x,y,xy", "x,,z", "a b c"})
    EXPECT_EQ(applied(bad), "none") << bad;
}

std::size_t operator_count(const std::optional<Operators>& operators) { return operators ? operators->size() : 0; }

TEST(DataCrystal, GroupsAreFoundBySymbolAndNumber) {
  EXPECT_EQ(operator_count(operators_of_group("F m -3 m", kCube)), 192u);
  EXPECT_EQ(operator_count(operators_of_group("Fm-3m", kCube)), 192u);
  EXPECT_EQ(operator_count(operators_of_group("P 21/c", kCube)), 4u);
  EXPECT_EQ(operator_count(operators_of_group("227", kCube)), 192u);
  EXPECT_EQ(operator_count(operators_of_group("R -3 m", kHexagonal)), 36u);
  EXPECT_EQ(operator_count(operators_of_group("R -3 m", {4, 4, 4, 70, 70, 70})), 12u) << "rhombohedral axes";
  EXPECT_EQ(operator_count(operators_of_group("166", {4, 4, 4, 70, 70, 70})), 12u);
  EXPECT_EQ(operator_count(operators_of_group("P nonsense", kCube)), 0u);
  EXPECT_EQ(operator_count(operators_of_group("231", kCube)), 0u);
  EXPECT_EQ(operator_count(operators_of_hall("-P 4 2 3")), 48u);
  EXPECT_EQ(operator_count(operators_of_hall("-P  4 2  3")), 48u);
  EXPECT_EQ(operator_count(operators_of_hall("P nonsense")), 0u);
}

TEST(DataCrystal, ImagesOnSpecialPositionsAreOne) {
  const auto group = operators_of_group("F m -3 m", kCube);
  const Box box = *cell_box(kCube);
  EXPECT_EQ(images_in_cell({0, 0, 0}, *group, box).size(), 4u);
  EXPECT_EQ(images_in_cell({0.25, 0.25, 0.25}, *group, box).size(), 8u);
  EXPECT_EQ(images_in_cell({0.06, 0.17, 0.29}, *group, *cell_box({12, 12, 12, 90, 90, 90})).size(), 192u);
  // Rounded coordinates on a threefold axis.
  const auto trigonal = operators_of_group("P 3", kHexagonal);
  EXPECT_EQ(images_in_cell({0.3333, 0.6667, 0}, *trigonal, *cell_box(kHexagonal)).size(), 1u);
  for (const Vec3d p : images_in_cell({-0.1, 1.2, -1e-20}, *trigonal, *cell_box(kHexagonal)))
    for (const double x : {p.x, p.y, p.z}) EXPECT_TRUE(x >= 0 && x < 1) << x;
}

}  // namespace

}  // namespace orrery::data
