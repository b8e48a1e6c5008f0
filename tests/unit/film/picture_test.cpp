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

TEST(FilmPicture, CountsEachKindOfBadValueOnceInAllPlanes) {
  const Picture picture{
      3, 2, {{"R", {kNan, kInfinity, -kInfinity, -1, 65505, -70000}}, {"G", {kNan, kNan, -0.0f, 0, 1, 65504}}}};
  const BadValues bad = count_bad_values(picture);
  EXPECT_EQ(bad.nan, 3u);
  EXPECT_EQ(bad.infinite, 2u);
  EXPECT_EQ(bad.negative, 2u);
  EXPECT_EQ(bad.above_half, 2u);
}

TEST(FilmPicture, FindsNothingBadInLightThatAFileHolds) {
  const Picture picture{2, 1, {{"R", {0, kLargestHalf}}, {"A", {1, 1}}}};
  const BadValues bad = count_bad_values(picture);
  EXPECT_EQ(bad.nan + bad.infinite + bad.negative + bad.above_half, 0u);
}

}  // namespace
}  // namespace orrery::film
