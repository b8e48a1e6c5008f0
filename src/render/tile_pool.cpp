// SPDX-License-Identifier: Apache-2.0
#include "render/tile_pool.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace orrery::render {

struct TilePool::Impl {
  // Without the limit TBB makes no more threads than there are processors.
  tbb::global_control limit;
  tbb::task_arena arena;
  tbb::enumerable_thread_specific<TileWorker> workers;
  const std::atomic<bool>* cancel;

  Impl(int threads, const std::atomic<bool>* stop)
      : limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)),
        arena(threads),
        cancel(stop) {}
  bool cancelled() const { return cancel != nullptr && cancel->load(std::memory_order_relaxed); }
};

TilePool::TilePool(int threads, const std::atomic<bool>* cancel) : impl_(std::make_unique<Impl>(threads, cancel)) {}
TilePool::~TilePool() = default;

bool TilePool::run(std::size_t count, const std::function<void(std::size_t, TileWorker&)>& work) {
  execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, count, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t i = range.begin(); i < range.end() && !impl_->cancelled(); ++i)
            work(i, impl_->workers.local());
        },
        tbb::simple_partitioner());
  });
  return !impl_->cancelled();
}

void TilePool::execute(const std::function<void()>& work) { impl_->arena.execute(work); }

kernel::TileCounts TilePool::counts() const {
  kernel::TileCounts sum;
  for (const TileWorker& worker : impl_->workers) {
    sum.rays += worker.counts.rays;
    sum.bad_samples += worker.counts.bad_samples;
  }
  return sum;
}

}  // namespace orrery::render
