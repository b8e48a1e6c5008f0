// SPDX-License-Identifier: Apache-2.0
#include "render/render.h"

#include <tbb/task_arena.h>

#include <chrono>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "accel/accel.h"
#include "base/error.h"
#include "film/film.h"
#include "film/layer_film.h"
#include "kernel/isa.h"
#include "render/progress_reporter.h"
#include "render/rounds.h"
#include "render/tile_pool.h"
#include "render/tile_renderer.h"
#include "render/tiles.h"
#include "render/traversals.h"

namespace orrery::render {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

int threads_of(const Settings& settings) { return settings.threads > 0 ? settings.threads : available_threads(); }

/// All samples of a pixel, then the next pixel: what neighbouring paths look at is in the cache.
bool render_at_once(const compile::World& world, const TileRenderer& render_tile, TilePool& pool,
                    ProgressReporter& progress, film::Film& film, Statistics& statistics) {
  const std::vector<kernel::Tile> tiles = make_tiles(world.width, world.height, world.samples, film);
  statistics.fewest_samples = statistics.most_samples = static_cast<std::uint64_t>(world.samples);
  statistics.ended_by = "samples";
  return pool.run(tiles.size(), [&](std::size_t i, TileWorker& worker) {
    render_tile(tiles[i], worker);
    progress.add(tiles[i].path_count());
  });
}

}  // namespace

int available_threads() { return tbb::this_task_arena::max_concurrency(); }

std::unique_ptr<accel::Accel> build(const compile::World& world, int threads, const accel::BuildMonitor& monitor) {
  std::unique_ptr<accel::Accel> accel;
  TilePool(threads, nullptr).execute([&] {
    accel = world.accelerator == compile::Accelerator::kList
                ? accel::make_list(world.view(), world.precision)
                : accel::make_embree(world.view(), world.precision, monitor);
  });
  return accel;
}

Result render(const compile::World& world, accel::Accel& accel, const Settings& settings) {
  Result result;
  Statistics& statistics = result.statistics;
  statistics.threads = threads_of(settings);
  statistics.isa = kernel::isa_name();
  statistics.accelerator = accel.name();

  std::optional<film::LayerFilm> layers;
  if (settings.layers.any()) layers.emplace(settings.layers, world.view(), world.width, world.height);
  film::Film film(world.width, world.height);
  const bool in_rounds = settings.noise > 0 || settings.seconds > 0;
  ProgressReporter progress(settings, std::uint64_t(world.samples) * film.pixel_count());
  const accel::Traversals traversals = choose_traversals(world, accel, settings.traversal);
  accel.use(traversals);
  statistics.traversal = name_of(traversals);
  TilePool pool(statistics.threads, settings.cancel);
  const TileRenderer render_tile(world, accel, settings.layers, layers ? &*layers : nullptr);
  result.completed = in_rounds ? render_in_rounds(world, settings, render_tile, pool, progress, film,
                                                  layers ? &*layers : nullptr, statistics)
                               : render_at_once(world, render_tile, pool, progress, film, statistics);
  statistics.render_s = progress.seconds();
  const kernel::TileCounts counts = pool.counts();
  statistics.rays = counts.rays;
  statistics.bad_samples = counts.bad_samples;
  if (!result.completed) return result;
  statistics.paths = progress.done();
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
