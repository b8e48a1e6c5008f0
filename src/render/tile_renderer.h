// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "accel/accel.h"
#include "compile/world.h"
#include "film/layer_film.h"
#include "film/layers.h"
#include "kernel/render_tile.h"

namespace orrery::render {

/// One thread's own: nothing in the kernel's loop allocates.
struct TileWorker {
  std::unique_ptr<kernel::PathStream> stream;
  std::unique_ptr<kernel::PathStreamFast> stream_fast;
  std::vector<kernel::PathRecord> records;
  std::vector<film::LayerPixel> pixels;
  kernel::TileCounts counts;
};

/// Runs one tile in the precision of the world, and hands its paths to the layers where there are any.
class TileRenderer {
 public:
  /// Domain     all arguments outlive this; layers null: beauty only
  TileRenderer(const compile::World& world, const accel::Accel& accel, const film::LayerRequest& request,
               film::LayerFilm* layers);

  /// Layers are finished tile by tile, unless somebody keeps what is known of each pixel.
  ///
  /// `kept`     of the picture, row by row, or null
  void operator()(const kernel::Tile& tile, TileWorker& worker, film::LayerPixel* kept = nullptr) const;

 private:
  void trace(const kernel::Tile& tile, TileWorker& worker) const;
  void trace_layers(const kernel::Tile& tile, TileWorker& worker, film::LayerPixel* kept) const;

  kernel::SceneView view_;
  kernel::Tracer tracer_;
  const film::LayerRequest& request_;
  film::LayerFilm* layers_;
  int width_;
  kernel::RenderTile render_ = nullptr;
  kernel::RenderTileFast render_fast_ = nullptr;  ///< in use where it is not null
};

}  // namespace orrery::render
