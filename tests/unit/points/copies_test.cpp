// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "points/copies.h"
#include "points_file.h"
#include "scene/number_array.h"
#include "scene/scene.h"
#include "support/mentions.h"

namespace orrery::points {
namespace {

using data::Transform;
using math::Vec3d;

data::Box box() {
  data::Box out;
  out.origin = {100, 100, 100};  // copies do not depend on it
  out.edges = {Vec3d{10, 0, 0}, Vec3d{1, 20, 0}, Vec3d{2, 3, 30}};
  return out;
}

Transform moved(Vec3d by) {
  Transform out;
  out.translation = by;
  return out;
}

/// Two spheres, with materials and colours.
scene::Points two() {
  scene::Points points;
  points.centers = {{1, 0, 0}, {0, 2, 0}};
  points.radii = {0.5, 0.25};
  points.materials = {7, 8};
  points.colors = {3, 4};
  return points;
}

void expect_close(Vec3d a, Vec3d b) { EXPECT_LT(math::length(a - b), 1e-12) << a.x << ' ' << a.y << ' ' << a.z; }

TEST(PointsCopies, UnwrapMovesByTheEdgesOfATriclinicBox) {
  data::FrameInfo info;
  info.box = box();
  info.roles.image = {"ix", "iy", "iz"};
  data::Table table;
  table.rows = 2;
  table.columns = {{"ix", std::vector<std::int64_t>{9, 1}},
                   {"iy", std::vector<std::int64_t>{9, -2}},
                   {"iz", std::vector<std::int64_t>{9, 3}}};
  scene::PointArray centers = {{0.5, 0, 0}};
  unwrap(table, Rows(std::vector<std::uint32_t>{1}), info, centers);
  EXPECT_EQ(centers[0], (Vec3d{0.5 + 10 - 2 + 6, -40 + 9, 90}));
}

TEST(PointsCopies, OneCopyWithoutAnAssembly) {
  KeyFaults faults("points[0]");
  const std::vector<Copy> copies = copies_of({}, {}, faults);
  ASSERT_EQ(copies.size(), 1u);
  EXPECT_EQ(copies[0].chains, nullptr);
  EXPECT_FALSE(faults.has_errors());
}

TEST(PointsCopies, ScaledRadiiStayCompact) {
  scene::Points points;
  for (int i = 0; i < 1000; ++i) {
    points.centers.push_back({1.0 * i, 0, 0});
    points.radii.push_back(0.1 + i % 12);
  }
  points.transform.scale = 3;
  make_copies({{}}, {}, points);
  EXPECT_EQ(points.radii[5], (0.1 + 5) * 3);
  EXPECT_EQ(points.radii.bytes(), 1000 + 12 * sizeof(double));
}

/// Copies of an assembly take 12 bytes each; other copies keep all digits.
TEST(PointsCopies, AssembliesAreInSinglePrecision) {
  const std::vector<Copy> copies = {{moved({0.1, 0, 0}), nullptr}, {moved({100, 0, 0}), nullptr}};
  for (const bool is_assembly : {false, true}) {
    scene::Points points;
    if (is_assembly) points.assembly = "1";
    for (int i = 0; i < 100; ++i) {
      points.centers.push_back({0.001 * i, 0.3, 0.7});
      points.radii.push_back(i % 3 == 0 ? 1.7 : 1.52);
    }
    make_copies(copies, {}, points);
    ASSERT_EQ(points.centers.size(), 200u);
    EXPECT_EQ(points.centers.numbers().bytes(), 600 * (is_assembly ? sizeof(float) : sizeof(double)));
    EXPECT_EQ(points.radii.bytes(), 200 + 2 * sizeof(double));
    const double exact = 0.001 * 99 + 100;
    EXPECT_EQ(points.centers[199].x, is_assembly ? static_cast<double>(static_cast<float>(exact)) : exact);
    EXPECT_EQ(points.radii[199], 1.7);
  }
}

/// Rounding after each of the two transforms would move some atoms farther.
TEST(PointsCopies, PlacedAssembliesAreRoundedOnce) {
  scene::Points points;
  points.assembly = "1";
  points.transform.scale = 0.37;
  points.transform.translate = {50, 0, 0};
  for (int i = 0; i < 100; ++i) {
    points.centers.push_back({0.001 * i, 0.3, 0.7});
    points.radii.push_back(1.7);
  }
  const scene::PointArray atoms = points.centers;
  make_copies({{moved({0.1, 0, 0}), nullptr}, {moved({100, 0, 0}), nullptr}}, {}, points);
  ASSERT_EQ(points.centers.size(), 200u);
  EXPECT_EQ(points.centers.numbers().bytes(), 600 * sizeof(float));
  const auto single = [](double x) { return static_cast<double>(static_cast<float>(x)); };
  int twice = 0;
  for (std::size_t i = 0; i < 100; ++i) {
    const double x = atoms[i].x + 100;
    EXPECT_EQ(points.centers[100 + i].x, single(x * 0.37 + 50)) << i;
    twice += single(single(x) * 0.37 + 50) != single(x * 0.37 + 50) ? 1 : 0;
  }
  EXPECT_GT(twice, 0) << "the test could not fail";
}

/// Far from the origin, single precision would move atoms visibly.
TEST(PointsCopies, RoundingMovesNoAtomByMoreThanAThousandthOfTheSmallestRadius) {
  const auto are_single = [](Vec3d translate, double scale, double radius, Vec3d copy = {}) {
    scene::Points points;
    points.assembly = "1";
    points.transform.translate = translate;
    points.transform.scale = scale;
    for (int i = 0; i < 100; ++i) {
      points.centers.push_back({0.001 * i, 0.3, 0.7});
      points.radii.push_back(i == 50 ? radius : 100 * radius);
    }
    make_copies({{moved({}), nullptr}, {moved(copy), nullptr}}, {}, points);
    const double exact = 0.001 * 99 * scale + translate.x;
    const bool out = points.centers.numbers().bytes() <= 600 * sizeof(float);  // less if few are distinct
    EXPECT_EQ(points.centers[99].x, out ? static_cast<double>(static_cast<float>(exact)) : exact);
    EXPECT_NEAR(points.centers[99].x, exact, 1e-3 * radius * scale);
    return out;
  };
  // The limit for a radius of 1 is 1e-3 / 2^-24 = 16,777.
  EXPECT_TRUE(are_single({16'000, 0, 0}, 1, 1));
  EXPECT_FALSE(are_single({17'000, 0, 0}, 1, 1));
  EXPECT_FALSE(are_single({0, 0, -17'000}, 1, 1));
  EXPECT_FALSE(are_single({1e6, 0, 0}, 1, 1));
  EXPECT_TRUE(are_single({1e6, 0, 0}, 1, 100));
  EXPECT_TRUE(are_single({1e6, 0, 0}, 100, 1)) << "radii are scaled, too";
  EXPECT_FALSE(are_single({1000, 0, 0}, 0.01, 1));
  EXPECT_FALSE(are_single({}, 1, 1, {0, 17'000, 0})) << "a copy of the assembly itself is far away";
}

TEST(PointsCopies, OutermostImagesAreTheCornersOfTheBlock) {
  scene::Points points = two();
  points.assembly = "1";
  points.radii = {1, 1};
  const std::vector<Copy> copies = {{moved({}), nullptr}, {moved({0.5, 0, 0}), nullptr}};
  const auto check = [&](Vec3d counts) {
    const std::vector<Copy> ends = outermost(copies, box(), counts), all = replicated(copies, box(), counts);
    EXPECT_EQ(ends.size(), 16u);
    EXPECT_EQ(ends.front().transform.translation, all.front().transform.translation);
    EXPECT_EQ(ends.back().transform.translation, all.back().transform.translation);
    const bool rounded = are_rounded(ends, points, points.centers, points.radii);
    EXPECT_EQ(rounded, are_rounded(all, points, points.centers, points.radii));
    return rounded;
  };
  EXPECT_TRUE(check({3, 1, 2}));
  EXPECT_TRUE(check({1600, 1, 1}));
  EXPECT_FALSE(check({1700, 1, 1}));
  EXPECT_FALSE(check({1, 2, 600}));
}

TEST(PointsCopies, AnAssemblyIsFoundByName) {
  data::FrameInfo info;
  info.assemblies = {{"1", {{{}, {moved({1, 0, 0})}}}},
                     {"2", {{{"A"}, {moved({2, 0, 0}), moved({3, 0, 0})}}, {{}, {moved({4, 0, 0})}}}}};
  KeyFaults faults("points[0]");
  scene::Points points;
  points.assembly = "2";
  const std::vector<Copy> copies = copies_of(info, points, faults);
  ASSERT_EQ(copies.size(), 3u);
  EXPECT_EQ(copies[1].transform.translation.x, 3);
  ASSERT_NE(copies[1].chains, nullptr);
  EXPECT_EQ(*copies[1].chains, std::vector<std::string>{"A"});
  EXPECT_EQ(copies[2].chains, nullptr) << "all chains";
  points.assembly = "3";
  EXPECT_TRUE(copies_of(info, points, faults).empty());
  info.assemblies.clear();
  copies_of(info, points, faults);
  EXPECT_TRUE(test::mentions(text_of(faults), {"points[0].assembly", "3", "1", "2"}));
}

TEST(PointsCopies, AnAssemblyWithoutTransformsIsAnError) {
  data::FrameInfo info;
  info.assemblies = {{"1", {{{"A"}, {}}}}};
  KeyFaults faults("points[0]");
  scene::Points points;
  points.assembly = "1";
  EXPECT_TRUE(copies_of(info, points, faults).empty());
  EXPECT_NE(text_of(faults).find("assembly 1 of the file"), std::string::npos);
}

TEST(PointsCopies, ReplicationNeedsABoxAndIntegers) {
  KeyFaults faults("points[0]");
  scene::Points points;
  points.replicate = {1, 1, 2};
  copies_of({}, points, faults);
  points.replicate = {1, 1.5, 1};
  data::FrameInfo info;
  info.box = box();
  copies_of(info, points, faults);
  EXPECT_TRUE(test::mentions(text_of(faults), {"points[0].replicate", "periodic", "points[0].replicate"}));
}

TEST(PointsCopies, ReplicatedAlongTheEdges) {
  const std::vector<Copy> copies = replicated({{moved({0.5, 0, 0}), nullptr}, {moved({}), nullptr}}, box(), {2, 1, 2});
  ASSERT_EQ(copies.size(), 8u);
  EXPECT_EQ(copies[0].transform.translation, (Vec3d{0.5, 0, 0}));
  EXPECT_EQ(copies[2].transform.translation, (Vec3d{10.5, 0, 0}));
  EXPECT_EQ(copies[7].transform.translation, (Vec3d{12, 3, 30}));
}

TEST(PointsCopies, CopiesKeepRadiiMaterialsAndColors) {
  scene::Points points = two();
  make_copies({{moved({}), nullptr}, {moved({0, 0, 5}), nullptr}}, {}, points);
  EXPECT_EQ(points.centers, (std::vector<Vec3d>{{1, 0, 0}, {0, 2, 0}, {1, 0, 5}, {0, 2, 5}}));
  EXPECT_EQ(points.radii, (std::vector<double>{0.5, 0.25, 0.5, 0.25}));
  EXPECT_EQ(points.materials, (std::vector<std::uint32_t>{7, 8, 7, 8}));
  EXPECT_EQ(points.colors, (std::vector<std::uint16_t>{3, 4, 3, 4}));
}

TEST(PointsCopies, CopiesOfSomeChains) {
  const std::vector<std::string> first = {"A", "missing"}, none = {"X"};
  const std::vector<Copy> copies = {
      {moved({0, 0, 1}), &first}, {moved({0, 0, 2}), nullptr}, {moved({0, 0, 3}), &none}, {moved({0, 0, 4}), &first}};
  const Labels chains{{"A", "B"}, {}, {1, 0}};
  EXPECT_EQ(copied_count(copies, chains, 2), 4u);
  EXPECT_EQ(copied_count(copies, {}, 2), 2u) << "those that are known without the chains";
  scene::Points points = two();
  std::vector<std::uint32_t> rows = {20, 30};
  make_copies(copies, chains, points, &rows);
  EXPECT_EQ(rows, (std::vector<std::uint32_t>{30, 20, 30, 30}));
  EXPECT_EQ(points.centers, (std::vector<Vec3d>{{0, 2, 1}, {1, 0, 2}, {0, 2, 2}, {0, 2, 4}}));
  EXPECT_EQ(points.radii, (std::vector<double>{0.25, 0.5, 0.25, 0.25}));
  EXPECT_EQ(points.colors, (std::vector<std::uint16_t>{4, 3, 4, 4}));
}

TEST(PointsCopies, RotationMatricesAreRows) {
  scene::Points points = two();
  Transform turn;  // x to y, y to -x
  turn.rows = {Vec3d{0, -1, 0}, Vec3d{1, 0, 0}, Vec3d{0, 0, 1}};
  turn.translation = {0, 0, 7};
  make_copies({{turn, nullptr}}, {}, points);
  EXPECT_EQ(points.centers, (std::vector<Vec3d>{{0, 1, 7}, {-2, 0, 7}}));
}

/// Scale, turn about x, then y, then z, translate: every other order gives another point.
TEST(PointsCopies, OrderOfTheTransform) {
  scene::Points points;
  points.centers = {{1, 2, 3}};
  points.radii = {0.5};
  points.transform.scale = 2;
  points.transform.rotate = {90, 90, 90};
  points.transform.translate = {10, 20, 30};
  make_copies({{}}, {}, points);
  // (2, 4, 6) about x: (2, -6, 4); about y: (4, -6, -2); about z: (6, 4, -2)
  expect_close(points.centers[0], {16, 24, 28});
  EXPECT_EQ(points.radii[0], 1);
}

TEST(PointsCopies, RotationsAreAppliedInOrder) {
  const auto turned = [](Vec3d p, Vec3d degrees) {
    scene::Points points;
    points.centers = {p};
    points.radii = {1};
    points.transform.rotate = degrees;
    make_copies({{}}, {}, points);
    return points.centers[0];
  };
  const double c = std::sqrt(0.75), s = 0.5;
  expect_close(turned({1, 2, 3}, {30, 0, 0}), {1, 2 * c - 3 * s, 2 * s + 3 * c});
  expect_close(turned({1, 2, 3}, {0, 30, 0}), {1 * c + 3 * s, 2, 3 * c - 1 * s});
  expect_close(turned({1, 2, 3}, {0, 0, 30}), {1 * c - 2 * s, 1 * s + 2 * c, 3});
  const Vec3d after_x = turned({1, 2, 3}, {25, 0, 0}), after_y = turned(after_x, {0, -40, 0});
  expect_close(turned({1, 2, 3}, {25, -40, 110}), turned(after_y, {0, 0, 110}));
}

TEST(PointsCopies, CopiesAreTransformedAfterwards) {
  scene::Points points;
  points.centers = {{1, 0, 0}};
  points.radii = {1};
  points.transform.scale = 3;
  points.transform.translate = {0, 1, 0};
  make_copies({{moved({}), nullptr}, {moved({1, 0, 0}), nullptr}}, {}, points);
  EXPECT_EQ(points.centers, (std::vector<Vec3d>{{3, 1, 0}, {6, 1, 0}}));
  EXPECT_EQ(points.radii, (std::vector<double>{3, 3}));
}

TEST(PointsCopies, ClipKeepsCentersInTheClosedIntervals) {
  scene::Points points = two();
  clip(points);
  EXPECT_EQ(points.centers.size(), 2u);
  points.clip[1] = scene::Interval{2, 3};
  std::vector<std::uint32_t> rows = {20, 30};
  clip(points, &rows);
  EXPECT_EQ(rows, std::vector<std::uint32_t>{30});
  EXPECT_EQ(points.centers, (std::vector<Vec3d>{{0, 2, 0}}));
  EXPECT_EQ(points.radii, std::vector<double>{0.25});
  EXPECT_EQ(points.materials, std::vector<std::uint32_t>{8});
  EXPECT_EQ(points.colors, std::vector<std::uint16_t>{4});
  points.clip[0] = scene::Interval{-2, -1};
  clip(points);
  EXPECT_TRUE(points.centers.empty() && points.radii.empty() && points.materials.empty() && points.colors.empty());
  points = two();
  points.clip[2] = scene::Interval{0.5, 1};
  clip(points);
  EXPECT_TRUE(points.centers.empty());
}

}  // namespace
}  // namespace orrery::points
