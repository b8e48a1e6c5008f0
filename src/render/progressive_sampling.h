// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "compile/forward.h"
#include "film/forward.h"
#include "kernel/forward.h"
#include "kernel/pixel_place.h"

namespace orrery::render {

class ProgressReporter;
class TilePool;
class TileRenderer;
struct Settings;
struct Statistics;
struct TileWorker;

/// Renders pixels up to their target sample counts, on all threads. Can be stopped at any time without losing samples.
class ProgressiveSampling {
 public:
  /// Called for every pixel that has received samples, on the thread that rendered them.
  using OnPixel = std::function<void(int x, int y)>;

  /// Prepares the rendering of `state`; run() starts it.
  ///
  /// Domain     all arguments outlive this
  ProgressiveSampling(const Settings& settings, const TileRenderer& render_tile, TilePool& pool,
                      ProgressReporter& progress, film::Partial& state)
      : settings_(settings), render_tile_(render_tile), pool_(pool), progress_(progress), state_(state) {}

  /// Renders every pixel up to the state's goals, in squares of `side` pixels, in both halves if there are two. Takes
  /// snapshots if the settings request them.
  ///
  /// Result     false if cancelled by the settings' `cancel`; each pixel then has its old count or its goal
  bool run(int side, const OnPixel& on_pixel = {});

 private:
  /// Upper left corners of the squares with pixels below their goals.
  std::vector<kernel::PixelPlace> unfinished_squares(int side) const;
  void render_square(int x0, int y0, int side, const OnPixel& on_pixel, TileWorker& worker);
  void render_group(kernel::Tile& tile, std::uint32_t have, std::uint32_t want, TileWorker& worker);

  const Settings& settings_;
  const TileRenderer& render_tile_;
  TilePool& pool_;
  ProgressReporter& progress_;
  film::Partial& state_;
};

/// The work of earlier runs plus that of this pool.
film::RenderWork work_so_far(const film::RenderWork& before, const TilePool& pool, const ProgressReporter& progress);

/// Renders all samples of the settings' pixel shard, in passes of growing size, so that the whole image is soon
/// visible.
///
/// Result     false if cancelled by the settings' `cancel`
bool render_progressively(const compile::CompiledScene& compiled, const Settings& settings,
                          const TileRenderer& render_tile, TilePool& pool, ProgressReporter& progress,
                          film::Partial& state, Statistics& statistics);

}  // namespace orrery::render
