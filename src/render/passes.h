// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "base/stopwatch.h"
#include "compile/forward.h"
#include "film/forward.h"
#include "kernel/forward.h"
#include "kernel/pixel_sum.h"

namespace orrery::render {

class TilePool;
class TileRenderer;
struct Settings;
struct Statistics;
struct TileWorker;

/// Reports progress to the caller, on the rendering threads: at each whole percent, and at most ten times a second in
/// between.
class ProgressReporter {
 public:
  /// Starts the clock.
  ///
  /// `total`    expected number of samples to render
  /// `before`   work of earlier runs
  ProgressReporter(const Settings& settings, std::uint64_t total, const film::RenderWork& before);

  /// Counts rendered samples.
  void add(std::uint64_t samples);

  /// Updates the estimated total of samples and what will end the render. Only between iterations. Reported progress
  /// never decreases.
  void expect(std::uint64_t total, std::string goal);

  /// Rendering time, including earlier runs.
  double seconds() const;
  std::uint64_t done() const { return done_.load(std::memory_order_relaxed); }

 private:
  static constexpr double kInterval = 0.1;  // seconds
  const Settings& settings_;
  double seconds_before_;
  std::atomic<std::uint64_t> done_;
  std::mutex mutex_;  // guards the members below
  std::uint64_t total_;
  std::string goal_;
  double max_reported_ = 0;  ///< 0..1
  double last_ = 0;          ///< time of the last report, seconds
  int last_percent_ = -1;    ///< last reported
  base::Stopwatch since_start_;
};

/// Renders pixels up to their target sample counts, on all threads. Can be stopped at any time without losing samples.
class PassRenderer {
 public:
  /// Called for every pixel that has received samples, on the thread that rendered them.
  using OnPixel = std::function<void(int x, int y)>;

  /// Prepares the rendering of `state`; run() starts it.
  ///
  /// Domain     all arguments outlive this
  PassRenderer(const Settings& settings, const TileRenderer& render_tile, TilePool& pool, ProgressReporter& progress,
               film::Sums& state)
      : settings_(settings), render_tile_(render_tile), pool_(pool), progress_(progress), state_(state) {}

  /// Renders every pixel up to the state's goals, in both halves if there are two. Reports the sums when a checkpoint
  /// is due.
  ///
  /// Result     false if cancelled by the settings' `cancel`; each pixel then has its old count or its goal
  bool run(const OnPixel& on_pixel = {});

 private:
  /// Upper left corners of the squares with pixels below their goals.
  std::vector<kernel::PixelPlace> unfinished_squares(int side) const;
  void render_square(int x0, int y0, int side, const OnPixel& on_pixel, TileWorker& worker);

  const Settings& settings_;
  const TileRenderer& render_tile_;
  TilePool& pool_;
  ProgressReporter& progress_;
  film::Sums& state_;
};

/// The work of earlier runs plus that of this pool.
film::RenderWork work_so_far(const film::RenderWork& before, const TilePool& pool, const ProgressReporter& progress);

/// Renders all samples of the settings' pixel shard, in passes of growing size, so that the whole image is soon
/// visible.
///
/// Result     false if cancelled by the settings' `cancel`
bool render_progressively(const compile::CompiledScene& compiled, const Settings& settings,
                          const TileRenderer& render_tile, TilePool& pool, ProgressReporter& progress,
                          film::Sums& state, Statistics& statistics);

}  // namespace orrery::render
