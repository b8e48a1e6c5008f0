// SPDX-License-Identifier: Apache-2.0
#include "render/render.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "accel/accel.h"
#include "base/error.h"
#include "film/film.h"
#include "film/layer_film.h"
#include "kernel/isa.h"
#include "render/tile_renderer.h"
#include "render/tiles.h"
#include "render/traversals.h"

namespace orrery::render {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Tells the caller how far the render is, from whichever thread comes by, at most a few times a second.
class ProgressReporter {
 public:
  ProgressReporter(const Settings& settings, std::uint64_t total) : settings_(settings), total_(total) {}

  void add(std::uint64_t samples) {
    const std::uint64_t done = done_.fetch_add(samples, std::memory_order_relaxed) + samples;
    if (!settings_.on_progress) return;
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock.owns_lock()) return;  // somebody else is just telling
    const double now = seconds_since(start_);
    if (now - last_ < kInterval && done < total_) return;
    last_ = now;
    settings_.on_progress({done, total_, now});
  }
  double seconds() const { return seconds_since(start_); }

 private:
  static constexpr double kInterval = 0.1;  // seconds
  const Settings& settings_;
  std::uint64_t total_;
  std::atomic<std::uint64_t> done_{0};
  std::mutex mutex_;
  Clock::time_point start_ = Clock::now();
  double last_ = 0;
};

/// So many threads, whatever the number of processors: without the limit TBB makes no more than there are of those.
class Threads {
 public:
  explicit Threads(int threads)
      : limit_(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)), arena_(threads) {}

  template <class F>
  void execute(F&& f) {
    arena_.execute(std::forward<F>(f));
  }

 private:
  tbb::global_control limit_;
  tbb::task_arena arena_;
};

int threads_of(const Settings& settings) { return settings.threads > 0 ? settings.threads : available_threads(); }

}  // namespace

int available_threads() { return tbb::this_task_arena::max_concurrency(); }

std::unique_ptr<accel::Accel> build(const compile::World& world, int threads, const accel::BuildMonitor& monitor) {
  std::unique_ptr<accel::Accel> accel;
  Threads(threads).execute([&] {
    accel = world.accelerator == compile::Accelerator::kList
                ? accel::make_list(world.view(), world.precision)
                : accel::make_embree(world.view(), world.precision, monitor);
  });
  return accel;
}

Result render(const compile::World& world, accel::Accel& accel, const Settings& settings) {
  Result result;
  result.statistics.threads = threads_of(settings);
  result.statistics.isa = kernel::isa_name();
  result.statistics.accelerator = accel.name();

  film::Film film(world.width, world.height);
  const std::vector<kernel::Tile> tiles = make_tiles(world.width, world.height, world.samples, film);
  std::optional<film::LayerFilm> layers;
  if (settings.layers.any()) layers.emplace(settings.layers, world.view(), world.width, world.height);
  const TileRenderer render_tile(world, accel, settings.layers, layers ? &*layers : nullptr);
  const auto total = static_cast<std::uint64_t>(world.width) * static_cast<std::uint64_t>(world.height) *
                     static_cast<std::uint64_t>(world.samples);
  ProgressReporter progress(settings, total);
  const accel::Traversals traversals = choose_traversals(world, accel, settings.traversal);
  accel.use(traversals);
  result.statistics.traversal = name_of(traversals);
  tbb::enumerable_thread_specific<TileWorker> workers;
  const auto cancelled = [&] { return settings.cancel != nullptr && settings.cancel->load(std::memory_order_relaxed); };
  Threads(result.statistics.threads).execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, tiles.size(), 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t i = range.begin(); i < range.end(); ++i) {
            if (cancelled()) return;
            const kernel::Tile& tile = tiles[i];
            render_tile(tile, workers.local());
            progress.add(std::uint64_t{tile.sample_end - tile.sample_begin} * static_cast<std::uint64_t>(tile.width) *
                         static_cast<std::uint64_t>(tile.height));
          }
        },
        tbb::simple_partitioner());
  });
  result.statistics.render_s = progress.seconds();
  for (const TileWorker& worker : workers) {
    result.statistics.rays += worker.counts.rays;
    result.statistics.bad_samples += worker.counts.bad_samples;
  }
  result.completed = !cancelled();
  if (!result.completed) return result;
  result.statistics.paths = total;
  result.picture = film.picture();
  result.picture.x = world.window_x;
  result.picture.y = world.window_y;
  result.picture.frame_width = world.frame_width;
  result.picture.frame_height = world.frame_height;
  result.picture.pixel_aspect = world.pixel_aspect;
  if (layers) {
    layers->move_to(result.picture);
    result.deep = layers->take_deep();
  }
  return result;
}

Result render(const compile::World& world, const Settings& settings) {
  const auto start = Clock::now();
  const accel::BuildMonitor monitor = [&settings](double fraction) {
    if (settings.on_build) settings.on_build(fraction);
    return settings.cancel == nullptr || !settings.cancel->load(std::memory_order_relaxed);
  };
  std::unique_ptr<accel::Accel> accel;
  try {
    accel = build(world, threads_of(settings), monitor);
  } catch (const base::Error& error) {
    if (error.kind() != base::ErrorKind::kStopped) throw;
    return {};
  }
  const double build_s = seconds_since(start);
  Result result = render(world, *accel, settings);
  result.statistics.build_s = build_s;
  return result;
}

}  // namespace orrery::render
