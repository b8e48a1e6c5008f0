// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "accel/accel.h"
#include "compile/forward.h"
#include "film/forward.h"
#include "kernel/guide_sum.h"
#include "kernel/path_record.h"
#include "kernel/path_stream.h"
#include "kernel/pixel_sum.h"
#include "kernel/ray_packet.h"
#include "kernel/render_tile.h"
#include "kernel/scene_view.h"

namespace orrery::render {

struct Settings;

/// A growing buffer of a tile's light events.
class LightEventBuffer : public kernel::LightEvents {
 public:
  /// Clears the buffer and reserves one event per path, the maximum in a scene without lights.
  void reset(std::size_t paths);
  const kernel::LightEvent* begin() const { return storage_.data(); }

 private:
  static void grow(kernel::LightEvents& events);
  std::vector<kernel::LightEvent> storage_;
};

/// Buffers of one thread, so that the kernel's loop does not allocate.
struct TileWorker {
  std::unique_ptr<kernel::PathStream> stream;
  accel::ThreadTraversals traversals;
  std::vector<kernel::PathRecord> records;
  std::vector<kernel::PixelSum> light;   ///< sums of a tile's pixels
  std::vector<kernel::GuideSum> guides;  ///< guides of a tile's pixels
  LightEventBuffer events;
  kernel::TileCounts counts;
};

/// Renders tiles in the scene's precision and adds their paths to the layers, if there are any.
class TileRenderer {
 public:
  /// Selects the kernel's instance for the scene. In adaptive sampling, samples from Sampler::kSecondHalf on are the
  /// second half.
  ///
  /// Domain     all arguments outlive this
  TileRenderer(const compile::CompiledScene& compiled, const accel::Accel& accel, const Settings& settings);

  /// Renders one tile, and adds its paths to the layers and halves of the image.
  void operator()(const kernel::Tile& tile, TileWorker& worker, film::Partial& image) const;

 private:
  void trace(const kernel::Tile& tile, TileWorker& worker) const;
  /// Renders samples of one half into separate sums.
  void trace_half(const kernel::Tile& tile, TileWorker& worker, film::Partial& image) const;
  void trace_records(const kernel::Tile& tile, TileWorker& worker, film::Partial& image) const;

  kernel::SceneView view_;
  const accel::Accel& accel_;
  const std::optional<accel::Traversal> traversal_;
  const film::LayerRequest& request_;
  std::uint32_t second_half_;  ///< first sample of the second half
  kernel::RenderTile render_ = nullptr;
};

}  // namespace orrery::render
