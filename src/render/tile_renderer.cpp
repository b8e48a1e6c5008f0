// SPDX-License-Identifier: Apache-2.0
#include "render/tile_renderer.h"

#include <algorithm>
#include <cfenv>

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

TileRenderer::TileRenderer(const compile::CompiledScene& compiled, const accel::Accel& accel,
                           const film::LayerRequest& request, bool is_adaptive)
    : view_(compiled.view()),
      tracer_(accel.tracer()),
      request_(request),
      width_(compiled.width),
      samples_(compiled.samples),
      is_adaptive_(is_adaptive) {
  const bool layers = request.any();
  if (request.coverage) view_.background_visible = false;
  if (compiled.precision == compile::Precision::kFast) {
    render_fast_ =
        layers ? kernel::record_tile_fast_function(view_.features) : kernel::render_tile_fast_function(view_.features);
  } else {
    render_ = layers ? kernel::record_tile_function(view_.features, compiled.precision)
                     : kernel::render_tile_function(view_.features, compiled.precision);
  }
}

void TileRenderer::operator()(const kernel::Tile& tile, TileWorker& worker, film::LayerPixel* layers) const {
  const DefaultRounding rounding;
  if (layers != nullptr) {
    trace_layers(tile, worker, layers);
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
  worker.counts.target = counts.target;
}

std::size_t TileRenderer::half_of(std::uint32_t sample) const {
  // Each half of a low-discrepancy sequence is a sequence of its own.
  const std::uint32_t first = std::max(1U, static_cast<std::uint32_t>(samples_) / 2);
  return sample >= (is_adaptive_ ? kernel::Sampler::kSecondHalf : first) ? 1 : 0;
}

void TileRenderer::trace_layers(const kernel::Tile& tile, TileWorker& worker, film::LayerPixel* layers) const {
  const auto pixels = static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height);
  const auto samples_at_a_time = std::max(1u, kMaxRecords / static_cast<std::uint32_t>(pixels));
  const auto place_in_picture = [&](kernel::PixelPlace at) {
    return static_cast<std::size_t>(tile.y + at.y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(tile.x + at.x);
  };
  kernel::Tile part = tile;
  part.record_light = request_.paths_light();
  part.record_guides = request_.guides();
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
    for (int i = 0; i < tile.pixel_count(); ++i) {
      const kernel::PixelPlace at = tile.pixel(i);
      const auto within = static_cast<std::size_t>(at.y * tile.width + at.x);
      film::LayerPixel& pixel = layers[place_in_picture(at)];
      const kernel::PathRecord* record = part.records + within * samples;
      for (std::uint32_t s = begin; s < part.sample_end; ++s)
        pixel.add(request_, view_, *record++, view_.filter.weight(s, std::uint64_t{s} + 1), half_of(s));
    }
    if (part.events == nullptr) continue;
    for (const kernel::LightEvent* event = worker.events.begin(); event != worker.events.next; ++event) {
      const auto within = static_cast<int>(event->path / samples);
      const std::uint64_t s = begin + event->path % samples;
      film::LayerPixel& pixel = layers[place_in_picture({within % tile.width, within / tile.width})];
      pixel.add(request_, part.records[event->path], *event, view_.filter.weight(s, s + 1));
    }
  }
}

}  // namespace orrery::render
