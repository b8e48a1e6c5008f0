// SPDX-License-Identifier: Apache-2.0
#include "render/allocation.h"

#include <gtest/gtest.h>

#include <algorithm>

#include <cmath>
#include <limits>
#include <numeric>

namespace orrery::render {
namespace {

constexpr std::uint64_t kAll = std::numeric_limits<std::uint64_t>::max();
constexpr std::uint32_t kEndless = 1u << 30;

/// Three bands of thirty rows: no noise, some, and four times as much of one sample's squared error.
PixelErrors bands(std::uint32_t samples) {
  PixelErrors e;
  e.width = 40;
  e.height = 90;
  for (int y = 0; y < e.height; ++y) {
    for (int x = 0; x < e.width; ++x) {
      e.samples.push_back(samples);
      e.squared.push_back(static_cast<float>(y < 30 ? 0 : y < 60 ? 1 : 4) / static_cast<float>(samples));
    }
  }
  return e;
}

int chosen_in(const Round& round, int from, int to) {
  return static_cast<int>(std::count(round.chosen.begin() + from * 40, round.chosen.begin() + to * 40, true));
}

TEST(RenderAllocation, WhatHasNoErrorGetsNoSamples) {
  const PixelErrors e = bands(16);
  const Round round = choose_pixels(e, {e.sum() / 100, kAll, kEndless});
  EXPECT_TRUE(round.any);
  EXPECT_EQ(chosen_in(round, 0, 28), 0);
  EXPECT_EQ(chosen_in(round, 32, 90), 58 * 40);
}

TEST(RenderAllocation, TheForecastIsNeymansMinimum) {
  const PixelErrors e = bands(16);
  const double wanted = e.sum() / 100;
  // Samples in proportion to the root of a pixel's squared error: (sum of roots)^2 / wanted, by hand.
  const double roots = 1200 * (1.0 + 2.0);
  const Round round = choose_pixels(e, {wanted, kAll, kEndless});
  EXPECT_NEAR(round.samples_to_goal, roots * roots / wanted - 2400 * 16, 0.06 * roots * roots / wanted);
}

TEST(RenderAllocation, NearTheGoalOnlyTheNoisiestGoOn) {
  const PixelErrors e = bands(16);
  const Round round = choose_pixels(e, {e.sum() * 0.8, kAll, kEndless});
  EXPECT_EQ(chosen_in(round, 0, 57), 0);
  EXPECT_GT(chosen_in(round, 62, 90), 0);
}

TEST(RenderAllocation, ItKeepsWithinWhatCanBePaid) {
  PixelErrors e = bands(16);
  for (std::size_t i = 0; i < e.squared.size(); ++i) e.squared[i] *= 1 + static_cast<float>(i) / 500;
  for (const std::uint64_t affordable : {4000u, 30000u}) {
    const Round round = choose_pixels(e, {e.sum() / 100, affordable, kEndless});
    const auto price = 16 * std::accumulate(round.chosen.begin(), round.chosen.end(), std::uint64_t{0});
    EXPECT_LE(price, affordable);
    EXPECT_GT(price, affordable * 2 / 10) << affordable;
  }
  EXPECT_FALSE(choose_pixels(e, {e.sum() / 100, 0, kEndless}).any);
}

TEST(RenderAllocation, PixelsThatHaveHadAllStayBehind) {
  const PixelErrors e = bands(16);
  const Round round = choose_pixels(e, {e.sum() / 100, kAll, 16});
  EXPECT_FALSE(round.any);
  EXPECT_TRUE(round.limited_by_pixels);
}

TEST(RenderAllocation, OneLuckyPixelAmongNoisyOnesGoesOnWithThem) {
  PixelErrors e = bands(16);
  e.squared[75 * 40 + 20] = 0;
  const Round round = choose_pixels(e, {e.sum() / 100, kAll, kEndless});
  EXPECT_TRUE(round.chosen[75 * 40 + 20]);
}

}  // namespace
}  // namespace orrery::render
