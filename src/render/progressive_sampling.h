// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "compile/compiled_scene.h"
#include "film/partial.h"
#include "render/progress_reporter.h"
#include "render/render.h"
#include "render/tile_pool.h"
#include "render/tile_renderer.h"

namespace orrery::render {

/// Renders the samples that pixels lack, over all threads, and stops at any time without losing one.
class ProgressiveSampling {
 public:
  /// Called with every pixel that has got samples, from the thread that rendered them.
  using OnPixel = std::function<void(int x, int y)>;

  /// Domain     all arguments outlive this
  ProgressiveSampling(const Settings& settings, const TileRenderer& render_tile, TilePool& pool,
                      ProgressReporter& progress, film::Partial& state)
      : settings_(settings), render_tile_(render_tile), pool_(pool), progress_(progress), state_(state) {}

  /// Brings every pixel to as many samples as the state's goals say, in squares of `side` pixels; in both halves, where
  /// there are two. Snapshots are handed out meanwhile where the settings want them.
  ///
  /// Result     false where the settings' `cancel` stopped it; then each pixel has its old count or its goal
  bool run(int side, const OnPixel& on_pixel = {});

 private:
  /// Upper left corners of those where some pixel has not yet as many samples as it shall have.
  std::vector<kernel::PixelPlace> unfinished_squares(int side) const;
  void render_square(int x0, int y0, int side, const OnPixel& on_pixel, TileWorker& worker);
  void render_group(kernel::Tile& tile, std::uint32_t have, std::uint32_t want, TileWorker& worker);

  const Settings& settings_;
  const TileRenderer& render_tile_;
  TilePool& pool_;
  ProgressReporter& progress_;
  film::Partial& state_;
};

/// What was done before, and by this pool since.
film::RenderWork work_so_far(const film::RenderWork& before, const TilePool& pool, const ProgressReporter& progress);

/// All samples of all pixels of the settings' share, in passes that grow: the first soon show the whole picture.
///
/// Result     false where the settings' `cancel` stopped it
bool render_progressively(const compile::CompiledScene& compiled, const Settings& settings,
                          const TileRenderer& render_tile, TilePool& pool, ProgressReporter& progress,
                          film::Partial& state, Statistics& statistics);

}  // namespace orrery::render
