// SPDX-License-Identifier: Apache-2.0
#include "render/render.h"

#include <sys/mman.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/version.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/stop_point.h"
#include "base/stopwatch.h"
#include "compile/compiled_scene.h"
#include "film/layer_planes.h"
#include "film/layers.h"
#include "film/sums.h"
#include "kernel/isa.h"
#include "render/adaptive_sampling.h"
#include "render/empty_pixels.h"
#include "render/passes.h"
#include "render/tiles.h"

namespace orrery::render {
namespace {

int threads_of(const Settings& settings) { return settings.threads > 0 ? settings.threads : available_threads(); }

void count_samples(const compile::CompiledScene& compiled, const Settings& settings, const film::Sums& state,
                   Statistics& statistics) {
  const std::vector<bool> owned = pixels_of(settings.shard, compiled.width, compiled.height);
  const std::uint64_t halves = state.is_adaptive() ? 2 : 1;
  statistics.min_samples = std::numeric_limits<std::uint64_t>::max();
  for (std::size_t i = 0; i < owned.size(); ++i) {
    if (!owned[i]) continue;
    statistics.min_samples = std::min(statistics.min_samples, halves * state.counts[i]);
    statistics.max_samples = std::max(statistics.max_samples, halves * state.counts[i]);
  }
  statistics.min_samples = std::min(statistics.min_samples, statistics.max_samples);
}

/// Lets the pages of sums be cleared a few pixels at a time, so that those of empty pixels are not.
template <class T>
void use_small_pages(base::ZeroVector<T>& sums) {
  const std::size_t bytes = sums.size() * sizeof(T);
  if (bytes >= base::ZeroPageAllocator<T>::kPage) madvise(sums.data(), bytes, MADV_NOHUGEPAGE);
}

/// An image without samples.
film::Sums new_image(const compile::CompiledScene& compiled, const Settings& settings, const film::EmptyPath& empty) {
  film::Sums out(compiled.width, compiled.height, settings.layers, settings.is_adaptive());
  out.empty = empty;
  if (!empty.is_known()) return out;
  for (auto& half : out.light) use_small_pages(half);
  for (auto& half : out.guides) use_small_pages(half);
  return out;
}

/// Reports the pixels of an earlier run.
void report_pixels(const Settings& settings, const film::Sums& state) {
  const int width = state.width, height = state.height;
  std::vector<kernel::PixelPlace> row(static_cast<std::size_t>(width));
  for (int x = 0; x < width; ++x) row[static_cast<std::size_t>(x)] = {x, 0};
  for (int y = 0; y < height; ++y) settings.on_pixels(state, {0, y, width, 1, row});
}

/// Computes the planes of an image on all threads of the current arena.
///
/// `on_done`  called with each range of pixels whose values have been computed, in order
void add_planes(std::vector<film::LayerPlanes> layers, std::size_t pixels, film::Picture& picture,
                const std::function<void(std::size_t begin, std::size_t end)>& on_done) {
  constexpr std::size_t kStep = std::size_t{1} << 18;  // pixels
  for (std::size_t begin = 0; begin < pixels; begin += kStep) {
    const std::size_t end = std::min(begin + kStep, pixels);
    for (film::LayerPlanes& layer : layers) {
      const std::size_t count = layer.planes.size();
      tbb::parallel_for(std::size_t{0}, count, [&](std::size_t k) {
        layer.planes[k].values.reserve(pixels);
        layer.planes[k].values.resize(end);
      });
      tbb::parallel_for(tbb::blocked_range<std::size_t>(begin, end, 1024), [&](const auto& range) {
        std::vector<float> values(count);
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          layer.values_of(i, values.data());
          for (std::size_t k = 0; k < count; ++k) layer.planes[k].values[i] = values[k];
        }
      });
    }
    on_done(begin, end);
  }
  for (film::LayerPlanes& layer : layers)
    std::move(layer.planes.begin(), layer.planes.end(), std::back_inserter(picture.planes));
}

/// Returns the memory of elements to the system. Ranges are released in order.
template <class T>
void release(base::ZeroVector<T>& sums, std::size_t begin, std::size_t end) {
  constexpr std::uintptr_t kPage = 4096;
  if (sums.size() * sizeof(T) < base::ZeroPageAllocator<T>::kPage) return;
  // Both ends are rounded down: what a page holds before `begin` has been released as well.
  const auto page_of = [&](std::size_t i) { return reinterpret_cast<std::uintptr_t>(sums.data() + i) / kPage * kPage; };
  madvise(reinterpret_cast<void*>(page_of(begin)), page_of(end) - page_of(begin), MADV_DONTNEED);
}

/// Converts sums to an image.
///
/// `on_done`  see add_planes()
Result finish(const compile::CompiledScene& compiled, const film::LayerRequest& request, const film::Sums& sums,
              TilePool& pool, const std::function<void(std::size_t begin, std::size_t end)>& on_done) {
  Result result;
  result.completed = true;
  result.picture.width = sums.width;
  result.picture.height = sums.height;
  result.picture.x = compiled.window_x;
  result.picture.y = compiled.window_y;
  result.picture.frame_width = compiled.frame_width;
  result.picture.frame_height = compiled.frame_height;
  result.picture.pixel_aspect = compiled.pixel_aspect;
  result.picture.is_transparent = request.transparent;
  const kernel::SceneView view = compiled.view();
  const std::size_t pixels = sums.pixel_count();
  const base::StopPoint stop;
  pool.execute([&] {
    add_planes(film::image_planes(request, view, sums), pixels, result.picture,
               [&](std::size_t begin, std::size_t end) {
                 stop.check();
                 on_done(begin, end);
               });
    if (request.coverage) result.picture.coverage.resize(pixels);
    for (std::size_t i = 0; i < result.picture.coverage.size(); ++i) result.picture.coverage[i] = sums.coverage(i);
    if (!request.deep) return;
    result.deep = {sums.width, sums.height, std::vector<std::vector<film::DeepSample>>(pixels)};
    tbb::parallel_for(std::size_t{0}, pixels, [&](std::size_t i) {
      result.deep.pixels[i] = film::deep_samples(sums, i, !request.transparent);
    });
  });
  return result;
}

}  // namespace

int available_threads() { return tbb::this_task_arena::max_concurrency(); }

std::unique_ptr<accel::Accel> build(const compile::CompiledScene& compiled, int threads,
                                    const accel::BuildMonitor& monitor) {
  std::unique_ptr<accel::Accel> accel;
  TilePool(threads).execute([&] {
    accel = compiled.accelerator == compile::Accelerator::kList
                ? accel::make_list(compiled.view(), compiled.precision)
                : accel::make_embree(compiled.view(), compiled.precision, monitor);
  });
  return accel;
}

std::uint32_t samples_of(const compile::CompiledScene& compiled, const Settings& settings) {
  return settings.sample_end > 0 ? settings.sample_end - settings.sample_begin
                                 : static_cast<std::uint32_t>(compiled.samples);
}

double share_with_objects(const compile::CompiledScene& compiled, const film::LayerRequest& layers, int threads) {
  TilePool pool(threads > 0 ? threads : available_threads());
  const std::vector<bool> empty = find_empty_pixels(compiled, layers, pool);
  if (empty.empty()) return 1;
  return static_cast<double>(std::count(empty.begin(), empty.end(), false)) / static_cast<double>(empty.size());
}

Result finished(const compile::CompiledScene& compiled, const film::LayerRequest& request, const film::Sums& sums,
                int threads) {
  TilePool pool(threads > 0 ? threads : available_threads());
  return finish(compiled, request, sums, pool, [](std::size_t, std::size_t) {});
}

Result render(const compile::CompiledScene& compiled, const accel::Accel& accel, const Settings& settings,
              std::optional<film::Sums> from) {
  Statistics statistics;
  statistics.threads = threads_of(settings);
  statistics.accelerator = accel.name();
  statistics.traversal = accel.traversal_name(settings.traversal);

  if (from && settings.on_pixels) report_pixels(settings, *from);
  TilePool pool(statistics.threads);
  const TileRenderer render_tile(compiled, accel, settings, pool);
  if (from) from->add_empty_to_sums();  // its samples may have been divided into halves at another one
  film::Sums state = from ? std::move(*from) : new_image(compiled, settings, render_tile.empty_path());
  const std::vector<bool> owned = pixels_of(settings.shard, compiled.width, compiled.height);
  const auto pixels = static_cast<std::uint64_t>(std::count(owned.begin(), owned.end(), true));
  ProgressReporter progress(settings, samples_of(compiled, settings) * pixels, state.work);
  const bool completed =
      settings.is_adaptive()
          ? render_adaptively(compiled, accel, settings, render_tile, pool, progress, state, statistics)
          : render_progressively(compiled, settings, render_tile, pool, progress, state, statistics);
  base::StopPoint().check();  // before passes over all pixels
  state.work = work_so_far(state.work, pool, progress);
  const std::int64_t target = pool.counts().target;
  statistics.isa = target != 0 ? kernel::isa_name(target) : kernel::isa_name();  // 0: there was nothing left to do
  statistics.set(state.work);
  count_samples(compiled, settings, state, statistics);

  const base::Stopwatch since_rendered;
  Result result;
  if (completed)
    result = finish(compiled, settings.layers, state, pool, [&](std::size_t begin, std::size_t end) {
      if (settings.keeps_sums) return;
      for (auto& half : state.light) release(half, begin, end);
      for (auto& half : state.guides) release(half, begin, end);
    });
  if (settings.keeps_sums || !completed) result.sums = std::move(state);
  statistics.finish_s = since_rendered.seconds();
  result.statistics = std::move(statistics);
  return result;
}

Result render(const compile::CompiledScene& compiled, const Settings& settings, std::optional<film::Sums> from) {
  const base::Stopwatch watch;
  const accel::BuildMonitor monitor = [&settings](double) {
    return settings.cancel == nullptr || !settings.cancel->load(std::memory_order_relaxed);
  };
  std::unique_ptr<accel::Accel> accel;
  try {
    accel = build(compiled, threads_of(settings), monitor);
  } catch (const base::Error& error) {
    if (error.kind() != base::ErrorKind::kStopped) throw;
    return {};
  }
  const double build_s = watch.seconds();
  Result result = render(compiled, *accel, settings, std::move(from));
  result.statistics.build_s = build_s;
  return result;
}

std::string tbb_version() { return TBB_runtime_version(); }

}  // namespace orrery::render
