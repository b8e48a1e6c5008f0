// SPDX-License-Identifier: Apache-2.0
#include "scene/number_array.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace orrery::scene {
namespace {

using Numbers = std::vector<double>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(SceneNumberArray, EqualNumbersTakeNoMemory) {
  NumberArray numbers;
  for (int i = 0; i < 1000; ++i) numbers.push_back(0.1);
  EXPECT_EQ(numbers.size(), 1000u);
  EXPECT_EQ(numbers.bytes(), 0u);
  EXPECT_TRUE(numbers.is_uniform());
  EXPECT_FALSE(numbers.fits_single()) << "0.1 is no float";
  EXPECT_EQ(numbers[999], 0.1);
}

TEST(SceneNumberArray, FewDifferentNumbersTakeOneByteEach) {
  NumberArray numbers;
  for (int i = 0; i < 1000; ++i) numbers.push_back(i % 16 == 0 ? 0.5 : i % 16);
  EXPECT_EQ(numbers.bytes(), 1000 + 16 * sizeof(double));
  EXPECT_EQ(numbers.palette().size(), 16u);
  EXPECT_EQ(numbers.palette()[numbers.palette_indices()[999]], 7);
  EXPECT_EQ(numbers.singles(), nullptr);
  EXPECT_TRUE(numbers.fits_single());
  numbers.set(3, 0.5);
  EXPECT_EQ(numbers[3], 0.5);
  numbers.set(4, 0.1);
  EXPECT_EQ(numbers.bytes(), 8000u) << "a seventeenth number, which is no float";
  EXPECT_TRUE(numbers.palette().empty());
  EXPECT_EQ(numbers[3], 0.5);
  EXPECT_EQ(numbers[4], 0.1);
  EXPECT_EQ(numbers[999], 7);
}

TEST(SceneNumberArray, FloatsTakeFourBytesAndOneDoubleMakesAllEight) {
  NumberArray numbers;
  Numbers want;
  for (int i = 0; i < 100; ++i) {
    want.push_back(i - 0.5);
    numbers.push_back(want.back());
  }
  EXPECT_EQ(numbers.bytes(), 400u);
  ASSERT_NE(numbers.singles(), nullptr);
  EXPECT_EQ((*numbers.singles())[1], 0.5F);
  EXPECT_TRUE(numbers.fits_single());
  numbers.push_back(0.1);
  want.push_back(0.1);
  EXPECT_EQ(numbers.bytes(), 808u);
  EXPECT_EQ(numbers.singles(), nullptr);
  EXPECT_FALSE(numbers.fits_single());
  EXPECT_EQ(numbers, want);
}

TEST(SceneNumberArray, CopiesShareFloatsUntilOneIsChanged) {
  for (const auto change :
       {+[](NumberArray& numbers) { numbers.set(3, 7); }, +[](NumberArray& numbers) { numbers.push_back(0.5); },
        +[](NumberArray& numbers) { numbers.push_back(0.1); }, +[](NumberArray& numbers) { numbers.resize(10); }}) {
    NumberArray numbers;
    for (int i = 0; i < 100; ++i) numbers.push_back(i - 0.5);
    const NumberArray copy = numbers;
    EXPECT_EQ(copy.singles(), numbers.singles());
    change(numbers);
    EXPECT_NE(copy.singles(), numbers.singles());
    EXPECT_EQ(copy.size(), 100u);
    EXPECT_EQ(copy[3], 2.5);
  }
}

TEST(SceneNumberArray, SignsOfZeroInfinitiesAndNansAreKept) {
  const NumberArray numbers = {0.0, -0.0, kInfinity, -kInfinity, std::nan(""), 0x1p-149, 0x1p-150};
  EXPECT_FALSE(std::signbit(numbers[0]));
  EXPECT_TRUE(std::signbit(numbers[1]));
  EXPECT_EQ(numbers[2], kInfinity);
  EXPECT_EQ(numbers[3], -kInfinity);
  EXPECT_TRUE(std::isnan(numbers[4]));
  EXPECT_EQ(numbers[5], 0x1p-149);
  EXPECT_EQ(numbers[6], 0x1p-150) << "is zero as a float";
}

TEST(SceneNumberArray, SizesChangeAsThoseOfAVector) {
  NumberArray numbers;
  numbers.resize(2);
  EXPECT_EQ(numbers, (Numbers{0, 0}));
  numbers.assign(2, 7);
  numbers.resize(3);
  EXPECT_EQ(numbers, (Numbers{7, 7, 0}));
  numbers.resize(1);
  EXPECT_EQ(numbers, Numbers{7});
  numbers.clear();
  EXPECT_TRUE(numbers.empty());
  numbers.push_back(0.1);
  EXPECT_EQ(numbers, Numbers{0.1});
}

/// Any sequence of operations gives the same bits as that on a vector.
TEST(SceneNumberArray, EqualsAVectorAfterAnyOperations) {
  std::mt19937_64 random(1);
  std::vector<double> values = {0, -0.0, 1, 0.5, 0.1, 1e300, 0x1p-150, kInfinity};
  for (int i = 0; i < 16; ++i) values.push_back(i + (i < 12 ? 0.5 : 0.1));
  for (int run = 0; run < 2000; ++run) {
    NumberArray numbers;
    Numbers want;
    // Few kinds of values, so that all ways of storage occur, and keep occurring.
    const std::size_t kinds = 1 + random() % values.size(), first = random() % values.size();
    for (std::size_t step = 0; step < 60; ++step) {
      const double value = values[(first + random() % kinds) % values.size()];
      switch (random() % 8) {
        case 0: numbers.resize(step % 43), want.resize(step % 43); break;
        case 1: numbers.assign(step % 7, value), want.assign(step % 7, value); break;
        case 2: numbers.reserve(step); break;
        case 3:
          if (want.empty()) break;
          numbers.set(step % want.size(), value);
          want[step % want.size()] = value;
          break;
        default: numbers.push_back(value), want.push_back(value);
      }
      ASSERT_EQ(numbers.size(), want.size()) << run;
      for (std::size_t i = 0; i < want.size(); ++i)
        ASSERT_EQ(std::bit_cast<std::uint64_t>(numbers[i]), std::bit_cast<std::uint64_t>(want[i])) << run;
    }
  }
}

TEST(ScenePointArray, CoordinatesAreStoredTogether) {
  PointArray points = {{1, 2, 3}, {4, 5, 6}};
  EXPECT_EQ(points.numbers().bytes(), 6 + 6 * sizeof(double));
  points.set(1, 2, 9);
  points.push_back({7, 8, 9});
  EXPECT_EQ(points, (std::vector<Vec3d>{{1, 2, 3}, {4, 5, 9}, {7, 8, 9}}));
  points.set(0, {0.1, 0, 0});
  EXPECT_EQ(points[0], (Vec3d{0.1, 0, 0}));
  EXPECT_EQ(points[2], (Vec3d{7, 8, 9}));
  points.resize(1);
  EXPECT_EQ(points.size(), 1u);
  EXPECT_EQ(PointArray(2), (std::vector<Vec3d>{{0, 0, 0}, {0, 0, 0}}));
}

}  // namespace
}  // namespace orrery::scene
