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

/// Three bands of thirty rows with squared errors per sample of 0, 1 and 4.
struct Bands {
  explicit Bands(std::uint32_t samples_each) : samples(40 * 90, samples_each), is_unreliable(samples.size()) {
    for (int y = 0; y < 90; ++y) errors.insert(errors.end(), 40, y < 30 ? 0.0f : y < 60 ? 1.0f : 4.0f);
  }

  PixelSelection choose(const IterationGoal& goal) const { return choose_pixels(samples, errors, is_unreliable, goal); }

  std::vector<std::uint32_t> samples;
  std::vector<float> errors;
  std::vector<std::uint8_t> is_unreliable;
};

int chosen_in(const PixelSelection& selection, int from, int to) {
  return static_cast<int>(std::count(selection.chosen.begin() + from * 40, selection.chosen.begin() + to * 40, true));
}

TEST(RenderAllocation, PixelsWithoutErrorGetNoSamples) {
  const PixelSelection selection = Bands(16).choose({0.01, kAll, kEndless});
  EXPECT_TRUE(selection.any);
  EXPECT_EQ(chosen_in(selection, 0, 30), 0);
  EXPECT_EQ(chosen_in(selection, 30, 90), 60 * 40);
}

TEST(RenderAllocation, ForecastIsNeymansMinimum) {
  // Optimal samples are proportional to the root of a pixel's squared error; the total is (sum of roots)^2 / wanted.
  const double roots = 1200 * (1.0 + 2.0), wanted = 0.01 * 1200 * (1.0 + 4.0) / 16;
  const PixelSelection selection = Bands(16).choose({0.01, kAll, kEndless});
  EXPECT_NEAR(selection.samples_to_goal, roots * roots / wanted - 2400 * 16, 0.06 * roots * roots / wanted);
}

TEST(RenderAllocation, NearTheGoalOnlyTheNoisiestPixelsAreChosen) {
  const PixelSelection selection = Bands(16).choose({0.8, kAll, kEndless});
  EXPECT_EQ(chosen_in(selection, 0, 60), 0);
  EXPECT_GT(chosen_in(selection, 60, 90), 0);
}

TEST(RenderAllocation, StaysWithinTheBudget) {
  Bands bands(16);
  for (std::size_t i = 0; i < bands.errors.size(); ++i) bands.errors[i] *= 1 + static_cast<float>(i) / 500;
  for (const std::uint64_t affordable : {4000u, 30000u}) {
    const PixelSelection selection = bands.choose({0.01, affordable, kEndless});
    const auto price = 16 * std::accumulate(selection.chosen.begin(), selection.chosen.end(), std::uint64_t{0});
    EXPECT_LE(price, affordable);
    EXPECT_GT(price, affordable * 2 / 10) << affordable;
  }
  EXPECT_FALSE(bands.choose({0.01, 0, kEndless}).any);
}

TEST(RenderAllocation, PixelsAtTheSampleLimitAreNotChosen) {
  const PixelSelection selection = Bands(16).choose({0.01, kAll, 16});
  EXPECT_FALSE(selection.any);
  EXPECT_TRUE(selection.limited_by_pixels);
}

TEST(RenderAllocation, PixelsWithUnreliableEstimatesAreChosenWhateverTheirError) {
  Bands bands(16);
  std::fill_n(bands.is_unreliable.begin(), 400, std::uint8_t{1});
  EXPECT_EQ(chosen_in(bands.choose({0.01, kAll, kEndless}), 0, 30), 400);
  const PixelSelection reached = bands.choose({1, kAll, kEndless});
  EXPECT_TRUE(reached.any);
  EXPECT_EQ(chosen_in(reached, 0, 90), 400);
  EXPECT_FALSE(bands.choose({1, 400 * 16 - 1, kEndless}).any);
  EXPECT_FALSE(bands.choose({1, kAll, 16}).any);
}

TEST(RenderAllocation, IterationHasAMinimumSize) {
  Bands bands(16);
  for (int i = 0; i < 40; ++i) bands.errors[static_cast<std::size_t>(60 * 40 + i)] = 6.0f + static_cast<float>(i);
  const PixelSelection selection = bands.choose({0.9999, kAll, kEndless});
  EXPECT_GE(chosen_in(selection, 0, 90), 90 * 40 / 64);
}

}  // namespace
}  // namespace orrery::render
