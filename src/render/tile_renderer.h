// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "accel/accel.h"
#include "compile/compiled_scene.h"
#include "film/layer_pixel.h"
#include "film/layers.h"
#include "kernel/render_tile.h"

namespace orrery::render {

/// One thread's own: nothing in the kernel's loop allocates.
struct TileWorker {
  std::unique_ptr<kernel::PathStream> stream;
  std::unique_ptr<kernel::PathStreamFast> stream_fast;
  std::vector<kernel::PathRecord> records;
  kernel::TileCounts counts;
};

/// Runs one tile in the precision of the world, and hands its paths to the layers where there are any.
class TileRenderer {
 public:
  /// Domain     all arguments outlive this
  TileRenderer(const compile::CompiledScene& compiled, const accel::Accel& accel, const film::LayerRequest& request);

  /// `layers`   of the picture, row by row; null where the request is empty
  void operator()(const kernel::Tile& tile, TileWorker& worker, film::LayerPixel* layers) const;

 private:
  void trace(const kernel::Tile& tile, TileWorker& worker) const;
  void trace_layers(const kernel::Tile& tile, TileWorker& worker, film::LayerPixel* layers) const;

  kernel::SceneView view_;
  kernel::Tracer tracer_;
  const film::LayerRequest& request_;
  int width_;
  kernel::RenderTile render_ = nullptr;
  kernel::RenderTileFast render_fast_ = nullptr;  ///< in use where it is not null
};

}  // namespace orrery::render
