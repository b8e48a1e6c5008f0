// SPDX-License-Identifier: Apache-2.0
#include "render/tile_renderer.h"

#include <algorithm>
#include <cfenv>

#include "accel/accel.h"
#include "compile/compiled_scene.h"
#include "film/layer_pixel.h"
#include "film/layers.h"
#include "film/partial.h"
#include "render/settings.h"

namespace orrery::render {
namespace {

/// Maximum path records that a thread holds at a time: half a megabyte, which stays in the L2 cache.
constexpr std::uint32_t kMaxRecords = 4096;

/// Sets the default floating-point environment (rounding, exception masks, flush-to-zero) and restores the host's on
/// destruction, so that the image does not depend on it.
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

/// Index of a tile's pixel within the image.
std::size_t index_of(const film::Partial& image, const kernel::Tile& tile, kernel::PixelPlace at) {
  return static_cast<std::size_t>(tile.y + at.y) * static_cast<std::size_t>(image.film.width()) +
         static_cast<std::size_t>(tile.x + at.x);
}

}  // namespace

void LightEventBuffer::reset(std::size_t paths) {
  storage_.resize(std::max(storage_.size(), paths + kernel::kPacketSize));
  next = storage_.data();
  end = next + storage_.size();
  make_room = grow;
}

void LightEventBuffer::grow(kernel::LightEvents& events) {
  auto& self = static_cast<LightEventBuffer&>(events);
  const auto used = self.next - self.storage_.data();
  self.storage_.resize(2 * self.storage_.size());
  self.next = self.storage_.data() + used;
  self.end = self.storage_.data() + self.storage_.size();
}

TileRenderer::TileRenderer(const compile::CompiledScene& compiled, const accel::Accel& accel, const Settings& settings)
    : view_(compiled.view()),
      accel_(accel),
      traversal_(settings.traversal),
      request_(settings.layers),
      // Each half of a low-discrepancy sequence is a sequence in its own right.
      second_half_(settings.sampling.is_adaptive() ? kernel::Sampler::kSecondHalf
                                                   : std::max(1U, static_cast<std::uint32_t>(compiled.samples) / 2)) {
  if (request_.coverage) view_.background_visible = false;
  render_ = kernel::render_tile_function(view_.features, compiled.precision, request_.any());
}

void TileRenderer::operator()(const kernel::Tile& tile, TileWorker& worker, film::Partial& image) const {
  const DefaultRounding rounding;
  if (!request_.guides()) {
    trace_records(tile, worker, image);
    return;
  }
  const std::uint32_t middle = std::clamp(second_half_, tile.sample_begin, tile.sample_end);
  kernel::Tile half = tile;
  half.sample_end = middle;
  if (half.path_count() > 0) trace_half(half, worker, image);
  half.sample_begin = middle;
  half.sample_end = tile.sample_end;
  if (half.path_count() > 0) trace_half(half, worker, image);
}

void TileRenderer::trace(const kernel::Tile& tile, TileWorker& worker) const {
  if (!worker.stream) {
    worker.stream = std::make_unique<kernel::PathStream>();
    if (traversal_) worker.traversals = accel::ThreadTraversals(*traversal_);
  }
  const kernel::TileCounts counts = render_(view_, accel_.thread_tracer(worker.traversals), tile, *worker.stream);
  worker.counts.rays += counts.rays;
  worker.counts.bad_samples += counts.bad_samples;
  worker.counts.target = counts.target;
}

void TileRenderer::trace_half(const kernel::Tile& tile, TileWorker& worker, film::Partial& image) const {
  const auto pixels = static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height);
  worker.light.assign(pixels, {});
  worker.guides.assign(pixels, {});
  kernel::Tile own = tile;
  own.sums = worker.light.data();
  own.guides = worker.guides.data();
  own.row_stride = tile.width;
  trace_records(own, worker, image);
  const std::size_t half = tile.sample_begin < second_half_ ? 0 : 1;
  for (int i = 0; i < tile.pixel_count(); ++i) {
    const kernel::PixelPlace at = tile.pixel(i);
    const auto within = static_cast<std::size_t>(at.y * tile.width + at.x);
    tile.sums[at.y * tile.row_stride + at.x] += worker.light[within];
    image.halves[index_of(image, tile, at)][half] += {worker.light[within], worker.guides[within]};
  }
}

void TileRenderer::trace_records(const kernel::Tile& tile, TileWorker& worker, film::Partial& image) const {
  if (!request_.records()) {
    trace(tile, worker);
    return;
  }
  const auto pixels = static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height);
  const auto samples_at_a_time = std::max(1u, kMaxRecords / static_cast<std::uint32_t>(pixels));
  kernel::Tile part = tile;
  part.record_light = request_.paths_light();
  part.record_hits = request_.path_records();
  for (std::uint32_t begin = tile.sample_begin; begin < tile.sample_end; begin = part.sample_end) {
    part.sample_begin = begin;
    part.sample_end = begin + std::min(samples_at_a_time, tile.sample_end - begin);
    const std::uint32_t samples = part.sample_end - begin;
    worker.records.resize(pixels * samples);
    part.records = worker.records.data();
    if (request_.lights()) {
      worker.events.reset(worker.records.size());
      part.events = &worker.events;
    }
    trace(part, worker);
    for (int i = 0; request_.path_records() && i < tile.pixel_count(); ++i) {
      const kernel::PixelPlace at = tile.pixel(i);
      const auto within = static_cast<std::size_t>(at.y * tile.width + at.x);
      film::LayerPixel& pixel = image.layers[index_of(image, tile, at)];
      const kernel::PathRecord* record = part.records + within * samples;
      for (std::uint32_t s = begin; s < part.sample_end; ++s)
        pixel.add(request_, view_, *record++, view_.filter.weight(s, std::uint64_t{s} + 1));
    }
    if (part.events == nullptr) continue;
    for (const kernel::LightEvent* event = worker.events.begin(); event != worker.events.next; ++event) {
      const auto within = static_cast<int>(event->path / samples);
      const std::uint64_t s = begin + event->path % samples;
      film::LayerPixel& pixel = image.layers[index_of(image, tile, {within % tile.width, within / tile.width})];
      pixel.add(request_, part.records[event->path], *event, view_.filter.weight(s, s + 1));
    }
  }
}

}  // namespace orrery::render
