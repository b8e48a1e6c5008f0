// SPDX-License-Identifier: Apache-2.0
#include "render/tile_renderer.h"

#include <algorithm>
#include <cfenv>

namespace orrery::render {
namespace {

/// Paths whose records a thread holds at a time: a few megabytes.
constexpr std::uint32_t kMostRecords = 65536;

/// The picture must not depend on what a host program did to a thread's rounding.
class DefaultRounding {
 public:
  DefaultRounding() {
    std::fegetenv(&before_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~DefaultRounding() { std::fesetenv(&before_); }
  DefaultRounding(const DefaultRounding&) = delete;
  DefaultRounding& operator=(const DefaultRounding&) = delete;

 private:
  std::fenv_t before_;
};

}  // namespace

TileRenderer::TileRenderer(const compile::World& world, const accel::Accel& accel, const film::LayerRequest& request,
                           film::LayerFilm* layers)
    : view_(world.view()), tracer_(accel.tracer()), request_(request), layers_(layers), width_(world.width) {
  if (request.coverage) view_.background_visible = false;
  if (world.precision == compile::Precision::kFast) {
    render_fast_ = layers != nullptr ? kernel::record_tile_fast_function() : kernel::render_tile_fast_function();
  } else {
    render_ = layers != nullptr ? kernel::record_tile_function(world.precision)
                                : kernel::render_tile_function(world.precision);
  }
}

void TileRenderer::operator()(const kernel::Tile& tile, TileWorker& worker) const {
  const DefaultRounding rounding;
  if (layers_ != nullptr) {
    trace_layers(tile, worker);
  } else {
    trace(tile, worker);
  }
}

void TileRenderer::trace(const kernel::Tile& tile, TileWorker& worker) const {
  kernel::TileCounts counts;
  if (render_fast_ != nullptr) {
    if (!worker.stream_fast) worker.stream_fast = std::make_unique<kernel::PathStreamFast>();
    counts = render_fast_(view_, tracer_, tile, *worker.stream_fast);
  } else {
    if (!worker.stream) worker.stream = std::make_unique<kernel::PathStream>();
    counts = render_(view_, tracer_, tile, *worker.stream);
  }
  worker.counts.rays += counts.rays;
  worker.counts.bad_samples += counts.bad_samples;
}

void TileRenderer::trace_layers(const kernel::Tile& tile, TileWorker& worker) const {
  const auto pixels = static_cast<std::uint32_t>(tile.width * tile.height);
  const std::uint32_t samples_at_a_time = std::max(1u, kMostRecords / pixels);
  worker.pixels.assign(pixels, {});
  kernel::Tile part = tile;
  part.record_light = request_.paths_light();
  part.record_guides = request_.guides();
  for (std::uint32_t begin = tile.sample_begin; begin < tile.sample_end; begin = part.sample_end) {
    part.sample_begin = begin;
    part.sample_end = begin + std::min(samples_at_a_time, tile.sample_end - begin);
    const std::uint32_t samples = part.sample_end - begin;
    worker.records.resize(std::size_t{pixels} * samples);
    part.records = worker.records.data();
    trace(part, worker);
    const kernel::PathRecord* record = part.records;
    for (film::LayerPixel& pixel : worker.pixels)
      for (std::uint32_t s = begin; s < part.sample_end; ++s)
        pixel.add(request_, view_, *record++, view_.filter.weight(s, s + 1));
  }
  for (int y = 0; y < tile.height; ++y)
    for (int x = 0; x < tile.width; ++x)
      layers_->set(static_cast<std::size_t>(tile.y + y) * static_cast<std::size_t>(width_) +
                       static_cast<std::size_t>(tile.x + x),
                   worker.pixels[static_cast<std::size_t>(y * tile.width + x)]);
}

}  // namespace orrery::render
