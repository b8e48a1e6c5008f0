// SPDX-License-Identifier: Apache-2.0
#include "render/tiles.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <new>
#include <set>
#include <thread>

#include "base/error.h"
#include "base/stop_point.h"

namespace orrery::render {
namespace {

TEST(RenderTiles, AllocationFailureInAnyThreadReachesTheCaller) {
  TilePool pool(3);
  const auto fail = [](std::size_t i, TileWorker&) {
    if (i == 77) throw std::bad_alloc();
  };
  EXPECT_THROW(pool.run(100, fail, [] { return false; }), std::bad_alloc);
}

TEST(RenderTiles, AStopScopeStopsTheWorkOfItsPools) {
  std::atomic<bool> flag{false};
  const base::StopScope scope(&flag);
  TilePool pool(2);
  std::atomic<int> calls{0};
  const auto work = [&](std::size_t, TileWorker&) {
    ++calls;
    flag = true;
  };
  EXPECT_THROW(pool.run(1000, work), base::Error);
  EXPECT_LE(calls, 2) << "one for each thread";
}

TEST(RenderTiles, UsesAtMostTheGivenNumberOfThreads) {
  TilePool pool(2);
  std::mutex mutex;
  std::set<std::thread::id> threads;
  std::size_t calls = 0;
  const auto note = [&](std::size_t, TileWorker&) {
    const std::lock_guard lock(mutex);
    threads.insert(std::this_thread::get_id());
    ++calls;
  };
  EXPECT_TRUE(pool.run(1000, note, [] { return false; }));
  EXPECT_EQ(calls, 1000u);
  EXPECT_LE(threads.size(), 2u);
}

}  // namespace
}  // namespace orrery::render
