// SPDX-License-Identifier: Apache-2.0
#include "film/picture.h"

#include <gtest/gtest.h>

#include <limits>

namespace orrery::film {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

TEST(FilmPicture, FindsAPlaneByItsName) {
  const Picture picture{1, 1, {{"R", {1}}, {"variance.R", {2}}}};
  ASSERT_NE(picture.find("variance.R"), nullptr);
  EXPECT_EQ(picture.find("variance.R")->values[0], 2);
  EXPECT_EQ(picture.find("G"), nullptr);
}

TEST(FilmPicture, CountsEachKindOfBadValue) {
  const BadValues bad = count_bad_values(Plane{"R", {kNan, kInfinity, -kInfinity, -1, 65505, -70000, -0.0f, 65504}});
  EXPECT_EQ(bad.nan, 1u);
  EXPECT_EQ(bad.infinite, 2u);
  EXPECT_EQ(bad.negative, 2u);
  EXPECT_EQ(bad.above_half, 2u);
  EXPECT_TRUE(bad.any());
}

TEST(FilmPicture, AcceptsValuesThatAFileCanHold) {
  EXPECT_FALSE(count_bad_values(Plane{"R", {0, kLargestHalf, 1}}).any());
}

TEST(FilmPicture, AcceptsNegativeVectorsAndLargeData) {
  EXPECT_FALSE(count_bad_values(Plane{"N.X", {-1, 0.5f}, PlaneKind::kVector}).any());
  EXPECT_EQ(count_bad_values(Plane{"N.X", {70000}, PlaneKind::kVector}).above_half, 1u);
  EXPECT_FALSE(count_bad_values(Plane{"Z", {1e30f, -5}, PlaneKind::kData}).any());
  EXPECT_EQ(count_bad_values(Plane{"Z", {kNan}, PlaneKind::kData}).nan, 1u);
}

TEST(FilmPicture, AddsCounts) {
  BadValues sum{1, 2, 3, 4};
  sum += BadValues{10, 20, 30, 40};
  EXPECT_EQ(sum.nan + sum.infinite + sum.negative + sum.above_half, 110u);
  EXPECT_EQ(sum.nan, 11u);
}

TEST(FilmPicture, ReturnsTheLayerOfAPlane) {
  EXPECT_EQ((Plane{"R", {}}.layer()), "");
  EXPECT_EQ((Plane{"denoise.albedo.R", {}}.layer()), "denoise.albedo");
}

}  // namespace
}  // namespace orrery::film
