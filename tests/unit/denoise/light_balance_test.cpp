// SPDX-License-Identifier: Apache-2.0
#include "denoise/light_balance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace orrery::denoise {
namespace {

Values random_values(Frame frame, float from, float to) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(from, to);
  Values out(frame.pixels());
  for (float& v : out) v = uniform(random);
  return out;
}

double sum(const Values& values) {
  double out = 0;
  for (const float v : values) out += static_cast<double>(v);
  return out;
}

double balanced_sum(const LightBalance& balance, const Values& before, const Values& after, Frame frame) {
  double out = 0;
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const std::size_t i = frame.at(x, y);
      out += balance.at(x, y, before[i], after[i]) * static_cast<double>(after[i]);
    }
  return out;
}

LightBalance balance_of(const Values& before, const Values& after, Frame frame) {
  return {padded(before, frame), after, padded(Values(frame.pixels(), 1), frame), frame};
}

TEST(DenoiseLightBalance, KeepsTheSumOfImagesOfAnySize) {
  for (const Frame frame : {Frame{1, 1}, Frame{63, 64}, Frame{64, 65}, Frame{200, 3}, Frame{257, 140}}) {
    const Values before = random_values(frame, 0, 1);
    Values less = random_values(frame, 0.96F, 0.99F), more = random_values(frame, 0.5F, 4);
    for (std::size_t i = 0; i < less.size(); ++i) {
      less[i] *= before[i];
      more[i] *= before[i];
    }
    for (const Values& after : {less, more})
      EXPECT_NEAR(balanced_sum(balance_of(before, after, frame), before, after, frame) / sum(before), 1, 1e-6)
          << frame.width << " x " << frame.height;
  }
}

TEST(DenoiseLightBalance, PartsDoNotAffectDistantOnes) {
  constexpr Frame kFrame{400, 20};
  const Values before(kFrame.pixels(), 1);
  Values after = before;
  for (int y = 0; y < kFrame.height; ++y) after[kFrame.at(10, y)] = 0.5F;
  const LightBalance balance = balance_of(before, after, kFrame);
  EXPECT_GT(balance.at(20, 10, 1, 1), 1.005);
  EXPECT_GT(balance.at(20, 10, 1, 1), balance.at(60, 10, 1, 1));
  EXPECT_EQ(balance.at(10 + 2 * kPartSpacing, 10, 1, 1), 1);
}

TEST(DenoiseLightBalance, WhatWasGainedIsGivenBackByThoseWhoGainedIt) {
  // A bright pixel gives its light to more pixels than it should.
  constexpr Frame kFrame{100, 100};
  Values before(kFrame.pixels(), 0.1F), after = before;
  before[kFrame.at(50, 50)] = 1000;
  for (int y = 45; y <= 55; ++y)
    for (int x = 45; x <= 55; ++x) after[kFrame.at(x, y)] = 15;
  const LightBalance balance = balance_of(before, after, kFrame);
  EXPECT_NEAR(balanced_sum(balance, before, after, kFrame) / sum(before), 1, 1e-6);
  EXPECT_EQ(balance.at(30, 50, 0.1F, 0.1F), 1);
  EXPECT_LT(balance.at(45, 50, 0.1F, 15), 0.6);
}

TEST(DenoiseLightBalance, RestoresTheLightOfOutliers) {
  constexpr Frame kFrame{400, 200};
  const Values plane(kFrame.pixels(), 1);
  const PaddedPlane valid = padded(plane, kFrame);
  const auto lift = [&](const std::vector<RemovedLight>& removed, int x, int y) {
    return LightBalance(valid, plane, valid, kFrame, removed).at(x, y, 1, 1) - 1;
  };
  const auto sum_of_lifts = [&](const std::vector<RemovedLight>& removed) {
    const LightBalance balance(valid, plane, valid, kFrame, removed);
    double out = 0;
    for (int y = 0; y < kFrame.height; ++y)
      for (int x = 0; x < kFrame.width; ++x) out += balance.at(x, y, 1, 1) - 1;
    return out;
  };
  const std::size_t at = kFrame.at(64, 64);
  EXPECT_NEAR(sum_of_lifts({{at, 40}}), 40, 1e-3);
  EXPECT_GT(lift({{at, 40}}, 64, 64), 0.005);
  EXPECT_EQ(lift({{at, 40}}, 300, 64), 0) << "nearby";
  EXPECT_NEAR(sum_of_lifts({{at, 2000}}), 2000, 1e-3);
  EXPECT_LT(lift({{at, 2000}}, 64, 64), 0.05) << "limited";
  EXPECT_GT(lift({{at, 2000}}, 300, 64), 0.01) << "the rest is spread over the image";
  std::vector<RemovedLight> many;
  for (int i = 0; i < 100; ++i) many.push_back({kFrame.at(64 + i % 10, 64 + i / 10), 5});
  std::sort(many.begin(), many.end(), [](const auto& a, const auto& b) { return a.pixel < b.pixel; });
  EXPECT_NEAR(sum_of_lifts(many), 500, 1e-3);
  EXPECT_EQ(lift(many, 300, 150), 0) << "the number of many is known";
}

TEST(DenoiseLightBalance, IsLimitedAndIgnoresInvalidPixels) {
  constexpr Frame kFrame{30, 30};
  const auto factor = [&](float before, float after) {
    return balance_of(Values(kFrame.pixels(), before), Values(kFrame.pixels(), after), kFrame)
        .at(15, 15, before, after);
  };
  EXPECT_NEAR(factor(1, 0.99F), 1 / 0.99, 1e-6);
  EXPECT_NEAR(factor(1, 0.1F), 1.05, 1e-9);
  EXPECT_NEAR(factor(0.1F, 1), 0.1, 1e-6);
  EXPECT_EQ(factor(0, 1), 0);
  EXPECT_EQ(factor(1, 0), 1);
  EXPECT_EQ(factor(-1, -0.99F), 1);
  EXPECT_EQ(factor(-1, 1), 0);  // all that it gained, but no more

  const Values before(kFrame.pixels(), 1);
  Values after = before, valid = before;
  valid[7] = 0;
  for (const float invalid : {1e6F, -1e6F, std::numeric_limits<float>::infinity()}) {
    after[7] = invalid;
    const LightBalance balance(padded(before, kFrame), after, padded(valid, kFrame), kFrame);
    EXPECT_EQ(balance.at(9, 0, 1, 2), 1) << invalid;  // a pixel with a gain
  }
}

}  // namespace
}  // namespace orrery::denoise
