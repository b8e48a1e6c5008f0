// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "accel/accel.h"
#include "compile/forward.h"
#include "film/sums.h"
#include "kernel/path_record.h"
#include "kernel/path_stream.h"
#include "kernel/pixel_sum.h"
#include "kernel/ray_packet.h"
#include "kernel/render_tile.h"
#include "kernel/scene_view.h"
#include "render/seen_emitters.h"

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
  std::vector<kernel::PathRecord> records;
  // Of a tile's pixels:
  std::vector<kernel::PixelSum> light;
  std::vector<std::int64_t> covered;
  std::vector<float> largest;
  std::vector<kernel::GuideSum> guides;
  std::vector<kernel::PixelPlace> chosen;
  LightEventBuffer events;
  kernel::TileCounts counts;
};

/// A thread pool for tiles, with buffers that each thread keeps from tile to tile.
class TilePool {
 public:
  /// A base::StopScope of the calling thread can stop run().
  explicit TilePool(int threads);
  ~TilePool();

  /// Calls `work(i, worker)` for i = 0 .. count - 1, in any order and on all threads, until `shall_stop` returns true.
  ///
  /// Result     false if some calls were skipped
  bool run(std::size_t count, const std::function<void(std::size_t i, TileWorker& worker)>& work,
           const std::function<bool()>& shall_stop);
  /// The same for all of them.
  ///
  /// Errors     base::Error(kStopped) in a base::StopScope
  void run(std::size_t count, const std::function<void(std::size_t i, TileWorker& worker)>& work);

  /// Runs `work` within the pool, so that its parallel loops use these threads.
  void execute(const std::function<void()>& work);

  /// Counts of all tiles so far.
  kernel::TileCounts counts() const;

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

/// Renders tiles in the scene's precision, in buffers of the thread, and adds them to the image.
class TileRenderer {
 public:
  /// Selects the kernel's instance for the scene. In adaptive sampling, samples from Sampler::kSecondHalf on are the
  /// second half.
  ///
  /// Domain     all arguments outlive this
  TileRenderer(const compile::CompiledScene& compiled, const accel::Accel& accel, const Settings& settings,
               TilePool& pool);

  /// Renders the pixels and samples of a tile without buffers, and adds its paths to the image. The paths of empty
  /// pixels are known.
  void operator()(const kernel::Tile& tile, TileWorker& worker, film::Sums& image) const;

  /// True if a pixel is in the bounds of no object.
  bool is_empty(std::size_t pixel) const { return !empty_pixels_.empty() && empty_pixels_[pixel]; }
  bool has_empty_pixels() const { return !empty_pixels_.empty(); }
  /// A path of an empty pixel; zero if there are none.
  const film::EmptyPath& empty_path() const { return empty_path_; }
  /// The scene as it is rendered.
  const kernel::SceneView& view() const { return view_; }

 private:
  film::EmptyPath path_of_empty_pixel(int width, bool is_adaptive) const;
  void render(const kernel::Tile& tile, TileWorker& worker, film::Sums& image) const;
  /// Adds the paths of the tile's empty pixels to the image.
  ///
  /// Result     the tile with its other pixels
  kernel::Tile add_empty_pixels(const kernel::Tile& tile, TileWorker& worker, film::Sums& image) const;
  /// The first of the tile's samples that belongs to the second half.
  std::uint32_t middle_of(const kernel::Tile& tile, const film::Sums& image) const;
  /// Gives a tile empty buffers.
  void attach_buffers(kernel::Tile& tile, TileWorker& worker, bool is_adaptive) const;
  /// Adds the sums of a tile, which belongs to one half of the samples or to both, to the image.
  void add_sums(const kernel::Tile& tile, film::Sums& image) const;
  /// Adds the records and light events of a tile to its layers.
  void add_records(const kernel::Tile& tile, const TileWorker& worker, film::Sums& image) const;

  SeenEmitterList seen_emitters_;
  kernel::SceneView view_;
  kernel::Tracer tracer_;
  const film::LayerRequest& request_;
  std::uint32_t second_half_;  ///< first sample of the second half
  kernel::RenderTile render_ = nullptr;
  std::vector<bool> empty_pixels_;  ///< empty: there are none
  film::EmptyPath empty_path_;
};

}  // namespace orrery::render
