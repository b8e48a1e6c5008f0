// SPDX-License-Identifier: Apache-2.0
#include "render/tile_pool.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <optional>

#include "kernel/render_tile.h"
#include "render/tile_renderer.h"

namespace orrery::render {

struct TilePool::Impl {
  // Raises the limit if necessary: by default TBB uses no more threads than processors. The smallest limit applies to
  // all renders of the process, so renders with fewer threads must not set one.
  std::optional<tbb::global_control> limit;
  tbb::task_arena arena;
  tbb::enumerable_thread_specific<TileWorker> workers;

  explicit Impl(int threads) : arena(threads) {
    if (threads > tbb::info::default_concurrency())
      limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  }
};

TilePool::TilePool(int threads) : impl_(std::make_unique<Impl>(threads)) {}
TilePool::~TilePool() = default;

bool TilePool::run(std::size_t count, const std::function<void(std::size_t, TileWorker&)>& work,
                   const std::function<bool()>& shall_stop) {
  std::atomic<std::size_t> left{count};
  execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, count, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t i = range.begin(); i < range.end() && !shall_stop(); ++i) {
            work(i, impl_->workers.local());
            left.fetch_sub(1, std::memory_order_relaxed);
          }
        },
        tbb::simple_partitioner());
  });
  return left == 0;
}

void TilePool::execute(const std::function<void()>& work) { impl_->arena.execute(work); }

kernel::TileCounts TilePool::counts() const {
  kernel::TileCounts sum;
  for (const TileWorker& worker : impl_->workers) {
    sum.rays += worker.counts.rays;
    sum.bad_samples += worker.counts.bad_samples;
    if (worker.counts.target != 0) sum.target = worker.counts.target;
  }
  return sum;
}

std::string TilePool::traversals() const {
  using accel::ThreadTraversals, accel::Traversal, accel::TraversalChoice;
  const auto name_of = [this](TraversalChoice ThreadTraversals::*kind) -> std::string {
    bool by_packets = false, single = false;
    for (const TileWorker& worker : impl_->workers) {
      const TraversalChoice& choice = worker.traversals.*kind;
      by_packets |= !choice.is_made() || choice.next() == Traversal::kPacket;
      single |= !choice.is_made() || choice.next() == Traversal::kSingle;
    }
    return !single ? "packet" : !by_packets ? "single" : "both";
  };
  const std::string camera = name_of(&ThreadTraversals::camera), secondary = name_of(&ThreadTraversals::secondary);
  return camera == secondary ? camera : camera + ", secondary " + secondary;
}

}  // namespace orrery::render
