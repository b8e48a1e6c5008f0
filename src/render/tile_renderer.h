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

/// A growing buffer of a tile's light events.
class LightEventBuffer : public kernel::LightEvents {
 public:
  /// Clears the buffer and reserves one event per path, which is all that a scene without lights has.
  void reset(std::size_t paths);
  const kernel::LightEvent* begin() const { return storage_.data(); }

 private:
  static void grow(kernel::LightEvents& events);
  std::vector<kernel::LightEvent> storage_;
};

/// Buffers of one thread, so that the kernel's loop does not allocate.
struct TileWorker {
  std::unique_ptr<kernel::PathStream> stream;
  std::unique_ptr<kernel::PathStreamFast> stream_fast;
  std::vector<kernel::PathRecord> records;
  LightEventBuffer events;
  kernel::TileCounts counts;
};

/// Renders tiles in the scene's precision and adds their paths to the layers, if there are any.
class TileRenderer {
 public:
  /// `is_adaptive`  samples from Sampler::kSecondHalf on are the second half
  /// Domain     all arguments outlive this
  TileRenderer(const compile::CompiledScene& compiled, const accel::Accel& accel, const film::LayerRequest& request,
               bool is_adaptive = false);

  /// Renders one tile.
  ///
  /// `layers`   layer pixels of the whole image, row-major; null if the LayerRequest is empty
  void operator()(const kernel::Tile& tile, TileWorker& worker, film::LayerPixel* layers) const;

 private:
  void trace(const kernel::Tile& tile, TileWorker& worker) const;
  /// The half of the samples, 0 or 1, that a sample belongs to.
  std::size_t half_of(std::uint32_t sample) const;
  void trace_layers(const kernel::Tile& tile, TileWorker& worker, film::LayerPixel* layers) const;

  kernel::SceneView view_;
  kernel::Tracer tracer_;
  const film::LayerRequest& request_;
  int width_, samples_;
  bool is_adaptive_;
  kernel::RenderTile render_ = nullptr;
  kernel::RenderTileFast render_fast_ = nullptr;  ///< used if not null
};

}  // namespace orrery::render
