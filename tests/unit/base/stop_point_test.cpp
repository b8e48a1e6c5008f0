// SPDX-License-Identifier: Apache-2.0
#include "base/stop_point.h"

#include <gtest/gtest.h>

#include <thread>

#include "base/error.h"

namespace orrery::base {
namespace {

bool stops(const StopPoint& point) {
  try {
    point.check();
    return false;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kStopped);
    return true;
  }
}

TEST(BaseStopPoint, NothingStopsOutsideAScope) {
  EXPECT_FALSE(stops(StopPoint()));
  const StopScope none(nullptr);
  EXPECT_FALSE(stops(StopPoint()));
}

TEST(BaseStopPoint, TheFlagOfTheInnermostScopeStops) {
  const std::atomic<bool> yes{true}, no{false};
  const StopScope outer(&yes);
  EXPECT_TRUE(stops(StopPoint()));
  {
    const StopScope inner(&no);
    EXPECT_FALSE(stops(StopPoint()));
  }
  EXPECT_TRUE(stops(StopPoint()));
}

TEST(BaseStopPoint, ChecksTheFlagOfItsThreadOnEveryThread) {
  std::atomic<bool> flag{false};
  const StopScope scope(&flag);
  const StopPoint point;
  flag = true;
  std::thread([&] {
    EXPECT_TRUE(stops(point));
    EXPECT_FALSE(stops(StopPoint())) << "this thread has no scope";
  }).join();
}

TEST(BaseStopPoint, LoopsCheckInTheirFirstStep) {
  const std::atomic<bool> flag{true};
  const StopScope scope(&flag);
  const StopPoint point;
  EXPECT_THROW(point.check(0), Error);
  EXPECT_NO_THROW(point.check(1));
}

}  // namespace
}  // namespace orrery::base
