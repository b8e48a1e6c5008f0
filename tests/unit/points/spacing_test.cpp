// SPDX-License-Identifier: Apache-2.0
#include "points/spacing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

namespace orrery::points {
namespace {

using math::Vec3d;
using Points = std::vector<Vec3d>;

double by_definition(const Points& points) {
  std::vector<double> nearest;
  for (const Vec3d& a : points) {
    double best = std::numeric_limits<double>::infinity();
    for (const Vec3d& b : points)
      if (a != b) best = std::min(best, length(a - b));
    nearest.push_back(best);
  }
  std::sort(nearest.begin(), nearest.end());
  return nearest.empty() || std::isinf(nearest.front()) ? 0 : nearest[(nearest.size() - 1) / 2];
}

class PointsSpacing : public testing::Test {
 protected:
  double uniform() { return uniform_(engine_); }
  double normal() { return normal_(engine_); }
  template <class Make>
  Points made(std::size_t count, Make make) {
    Points out(count);
    for (std::size_t i = 0; i < count; ++i) out[i] = make(i);
    return out;
  }
  Points uniform_points(std::size_t count) {
    return made(count, [&](std::size_t) { return Vec3d{uniform(), uniform(), uniform()}; });
  }

 private:
  std::mt19937_64 engine_{18};
  std::uniform_real_distribution<double> uniform_;
  std::normal_distribution<double> normal_;
};

TEST_F(PointsSpacing, SmallSets) {
  EXPECT_EQ(median_neighbor_distance({}), 0);
  EXPECT_EQ(median_neighbor_distance(Points{{1, 2, 3}}), 0);
  EXPECT_EQ(median_neighbor_distance(Points(100, Vec3d{1, 2, 3})), 0);
  EXPECT_EQ(median_neighbor_distance(Points(100, Vec3d{0, 0, 0})), 0);
  EXPECT_EQ(median_neighbor_distance(Points{{1, 2, 3}, {1, 2, 5}}), 2);
  EXPECT_EQ(median_neighbor_distance(Points{{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {6, 0, 0}, {10, 0, 0}}), 2);
  EXPECT_EQ(median_neighbor_distance(Points{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {3, 4, 0}}), 5) << "coincident points";
}

TEST_F(PointsSpacing, EqualsTheDefinition) {
  for (const std::size_t count : {2u, 3u, 7u, 8u, 9u, 17u, 100u, 700u}) {
    const auto check = [&](const char* name, const Points& points) {
      const double expected = by_definition(points);
      EXPECT_NEAR(median_neighbor_distance(points), expected, 1e-12 * expected) << name << ' ' << count;
    };
    check("uniform", uniform_points(count));
    check("needle", made(count, [&](std::size_t) { return Vec3d{1e6 * uniform(), uniform(), 1e-3 * uniform()}; }));
    check("far from the origin", made(count, [&](std::size_t) { return Vec3d{1e9 + uniform(), -1e9, uniform()}; }));
    check("clustered", made(count, [&](std::size_t) {
            const double r = std::pow(uniform(), 8);
            return Vec3d{r * normal(), r * normal(), r * normal()};
          }));
    check("on a grid", made(count, [&](std::size_t) {
            return Vec3d{std::floor(5 * uniform()), std::floor(5 * uniform()), std::floor(5 * uniform())};
          }));
    check("on a line", made(count, [](std::size_t i) { return Vec3d{static_cast<double>(i * i), 0, 0}; }));
    check("geometric", made(count, [](std::size_t i) {
            return Vec3d{0, std::ldexp(1.0, -static_cast<int>(i / 2)), 0};
          }));
    Points outliers = uniform_points(count);
    outliers[0] = {1e12, -1e12, 3};
    check("outlier", outliers);
  }
}

TEST_F(PointsSpacing, ScalesWithThePoints) {
  const Points points = uniform_points(500);
  const double distance = median_neighbor_distance(points);
  for (const double factor : {0x1p-700, 0x1p-100, 0x1p100, 0x1p700}) {
    Points scaled = points;
    for (Vec3d& p : scaled) p = p * factor;
    EXPECT_EQ(median_neighbor_distance(scaled), distance * factor) << factor;
  }
}

TEST_F(PointsSpacing, LatticeLargerThanTheSample) {
  constexpr std::size_t kSide = 60;
  Points points;
  for (std::size_t i = 0; i < kSide * kSide * kSide; ++i)
    points.push_back({0.25 * static_cast<double>(i % kSide), 0.25 * static_cast<double>(i / kSide % kSide),
                      0.25 * static_cast<double>(i / kSide / kSide)});
  EXPECT_EQ(median_neighbor_distance(points), 0.25);
  points[7] = {1e9, 1e9, -1e9};  // one cell of a grid over the bounds would hold all others
  EXPECT_EQ(median_neighbor_distance(points), 0.25);
}

TEST_F(PointsSpacing, SampleAgreesWithTheDistribution) {
  // The distance to the nearest of n uniform points per unit of volume has the median (3 ln 2 / (4 pi n))^(1/3). The
  // median of 4,096 values deviates by 0.75 % (one standard deviation), the boundary of the cube adds 0.5 %.
  constexpr std::size_t kCount = 400'000;
  const double expected = std::cbrt(3 * std::numbers::ln2 / (4 * std::numbers::pi * kCount));
  const Points points = uniform_points(kCount);
  EXPECT_NEAR(median_neighbor_distance(points) / expected, 1, 0.035);
}

TEST_F(PointsSpacing, MillionsOfPointsAtFewPlaces) {
  EXPECT_EQ(median_neighbor_distance(Points(300'000, Vec3d{1, 2, 3})), 0);
  Points points(300'000, Vec3d{1, 2, 3});
  points[123'456] = {1, 2, 4.5};
  EXPECT_EQ(median_neighbor_distance(points), 1.5) << "only one point of the sample's place differs";
  EXPECT_EQ(median_neighbor_distance(made(300'000,
                                          [](std::size_t i) {
                                            return Vec3d{i % 2 == 0 ? 0.0 : 3.0, 0, 0};
                                          })),
            3);
}

}  // namespace
}  // namespace orrery::points
