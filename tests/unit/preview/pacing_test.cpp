// SPDX-License-Identifier: Apache-2.0
#include "preview/pacing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

namespace orrery::preview {
namespace {

/// Runs a render of 100 s in steps of 50 ms; returns the number of updates and their total cost.
std::pair<int, double> simulated(double interval_s, int threads, double cost_s) {
  Pacing pacing(interval_s);
  int updates = 0;
  for (int step = 1; step <= 2000; ++step) {
    const double now = 0.05 * step;
    if (!pacing.is_due(now, threads * now)) continue;
    pacing.updated(now, cost_s);
    ++updates;
  }
  return {updates, updates * cost_s};
}

TEST(PreviewPacing, UpdatesOncePerInterval) { EXPECT_NEAR(simulated(1, 2, 1e-4).first, 100, 5); }

TEST(PreviewPacing, ExpensiveUpdatesAreLessFrequent) {
  for (const int threads : {1, 2, 64})
    for (const double cost : {0.01, 0.1, 0.4}) {
      const double limit = kShareOfTime * threads * 100;
      EXPECT_LE(simulated(0.5, threads, cost).second, std::max(limit * 1.0001, cost)) << threads << " " << cost;
      EXPECT_GE(simulated(0.5, threads, cost).first, 1);
    }
  EXPECT_NEAR(simulated(0.5, 1, 0.1).second, kShareOfTime * 100, 0.101);
}

TEST(PreviewPacing, TimeBetweenUpdatesCounts) {
  Pacing pacing(1);
  EXPECT_FALSE(pacing.is_due(0.9, 0.9));
  EXPECT_TRUE(pacing.is_due(1.1, 1.1));
  pacing.spend(0.05);
  EXPECT_FALSE(pacing.is_due(100, 0.9 * 0.05 / kShareOfTime));
  EXPECT_TRUE(pacing.is_due(100, 1.1 * 0.05 / kShareOfTime));
}

}  // namespace
}  // namespace orrery::preview
