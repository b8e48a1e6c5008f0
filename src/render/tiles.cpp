// SPDX-License-Identifier: Apache-2.0
#include "render/tiles.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cfenv>
#include <mutex>

#include "base/stop_point.h"
#include "compile/compiled_scene.h"
#include "film/sums.h"
#include "math/pixels.h"
#include "render/empty_pixels.h"
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
std::size_t index_of(const film::Sums& image, const kernel::Tile& tile, kernel::PixelPlace at) {
  return math::pixel_index(tile.x + at.x, tile.y + at.y, image.width);
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

struct TilePool::Impl {
  // Raises the limit if necessary: by default TBB uses no more threads than processors. The smallest limit applies to
  // all renders of the process, so renders with fewer threads must not set one.
  std::optional<tbb::global_control> limit;
  tbb::task_arena arena;
  tbb::enumerable_thread_specific<TileWorker> workers;
  base::StopPoint stop;

  explicit Impl(int threads) : arena(threads) {
    if (threads > tbb::info::default_concurrency())
      limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  }
};

namespace {

/// Pools that are not in use. oneTBB frees the memory of an arena late or never, so that thousands of them, as of the
/// images of a view, would take ever more.
struct IdlePools {
  static constexpr std::size_t kMost = 4;
  std::mutex mutex;
  std::vector<std::unique_ptr<TilePool::Impl>> pools;
};

IdlePools& idle_pools() {
  static IdlePools& pools = *new IdlePools;  // never destroyed: threads may outlive main()
  return pools;
}

}  // namespace

TilePool::TilePool(int threads) {
  IdlePools& idle = idle_pools();
  const std::lock_guard lock(idle.mutex);
  const auto found = std::find_if(idle.pools.begin(), idle.pools.end(),
                                  [threads](const auto& pool) { return pool->arena.max_concurrency() == threads; });
  if (found == idle.pools.end()) {
    impl_ = std::make_unique<Impl>(threads);
    return;
  }
  impl_ = std::move(*found);
  idle.pools.erase(found);
  impl_->stop = base::StopPoint();
}

TilePool::~TilePool() {
  impl_->workers.clear();
  IdlePools& idle = idle_pools();
  const std::lock_guard lock(idle.mutex);
  if (!impl_->limit && idle.pools.size() < IdlePools::kMost) idle.pools.push_back(std::move(impl_));
}

bool TilePool::run(std::size_t count, const std::function<void(std::size_t, TileWorker&)>& work,
                   const std::function<bool()>& shall_stop) {
  std::atomic<std::size_t> left{count};
  impl_->arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, count, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t i = range.begin(); i < range.end() && !shall_stop(); ++i) {
            work(i, impl_->workers.local());
            left.fetch_sub(1, std::memory_order_relaxed);
          }
        },
        tbb::simple_partitioner());
  });
  return left == 0;
}

void TilePool::run(std::size_t count, const std::function<void(std::size_t, TileWorker&)>& work) {
  run(count, work, [this] {
    impl_->stop.check();
    return false;
  });
}

void TilePool::execute(const std::function<void()>& work) { impl_->arena.execute(work); }

kernel::TileCounts TilePool::counts() const {
  kernel::TileCounts sum;
  for (const TileWorker& worker : impl_->workers) {
    sum.rays += worker.counts.rays;
    sum.bad_samples += worker.counts.bad_samples;
    if (worker.counts.target != 0) sum.target = worker.counts.target;
  }
  return sum;
}

TileRenderer::TileRenderer(const compile::CompiledScene& compiled, const accel::Accel& accel, const Settings& settings,
                           TilePool& pool)
    : seen_emitters_(compiled.view(), compiled.precision, compiled.width, compiled.height),
      view_(compiled.view()),
      tracer_(accel.tracer(settings.traversal)),
      request_(settings.layers),
      // Each half of a low-discrepancy sequence is a sequence in its own right.
      second_half_(settings.is_adaptive() ? kernel::Sampler::kSecondHalf
                                          : std::max(1U, static_cast<std::uint32_t>(compiled.samples) / 2)) {
  view_.seen_emitters = seen_emitters_.view();
  if (request_.transparent) view_.background_visible = false;
  render_ = kernel::render_tile_function(view_.features, compiled.precision, request_.any());
  if (settings.sample_end > 0) return;
  empty_pixels_ = find_empty_pixels(compiled, request_, pool);
  if (!empty_pixels_.empty()) empty_path_ = path_of_empty_pixel(compiled.width, settings.is_adaptive());
  if (!empty_path_.is_known()) empty_pixels_.clear();
}

film::EmptyPath TileRenderer::path_of_empty_pixel(int width, bool is_adaptive) const {
  const DefaultRounding rounding;
  const auto pixel =
      static_cast<int>(std::find(empty_pixels_.begin(), empty_pixels_.end(), true) - empty_pixels_.begin());
  TileWorker worker;
  worker.stream = std::make_unique<kernel::PathStream>();
  kernel::Tile tile;
  tile.x = pixel % width;
  tile.y = pixel / width;
  tile.width = tile.height = 1;
  tile.sample_end = 1;
  attach_buffers(tile, worker, is_adaptive);
  render_(view_, tracer_, tile, *worker.stream);
  film::EmptyPath out;
  out.light = worker.light[0];
  if (request_.guides()) out.guides = worker.guides[0];
  if (is_adaptive) out.largest = worker.largest[0];
  out.first_half = second_half_;
  return out;
}

void TileRenderer::operator()(const kernel::Tile& tile, TileWorker& worker, film::Sums& image) const {
  if (empty_pixels_.empty()) return render(tile, worker, image);
  const kernel::Tile others = add_empty_pixels(tile, worker, image);
  if (others.chosen_count > 0) render(others, worker, image);
}

kernel::Tile TileRenderer::add_empty_pixels(const kernel::Tile& tile, TileWorker& worker, film::Sums& image) const {
  const std::uint32_t middle = middle_of(tile, image), first = middle - tile.sample_begin,
                      second = tile.has_both_halves ? first : tile.sample_end - middle;
  worker.chosen.clear();
  for (int i = 0; i < tile.pixel_count(); ++i) {
    const kernel::PixelPlace at = tile.pixel(i);
    const std::size_t pixel = index_of(image, tile, at);
    if (empty_pixels_[pixel]) {
      image.add_empty(0, pixel, empty_path_, first);
      image.add_empty(1, pixel, empty_path_, second);
    } else {
      worker.chosen.push_back(at);
    }
  }
  // Counted as if they were traced, so that statistics do not depend on the layers.
  worker.counts.rays += tile.path_count() - worker.chosen.size() * (first + second);
  kernel::Tile others = tile;
  others.chosen_count = static_cast<int>(worker.chosen.size());
  others.chosen = others.chosen_count < tile.pixel_count() ? worker.chosen.data() : tile.chosen;
  return others;
}

void TileRenderer::render(const kernel::Tile& tile, TileWorker& worker, film::Sums& image) const {
  if (tile.has_both_halves && request_.records()) {  // a path's record is found by its sample
    kernel::Tile half = tile;
    half.has_both_halves = false;
    render(half, worker, image);
    half.sample_begin += kernel::Sampler::kSecondHalf;
    half.sample_end += kernel::Sampler::kSecondHalf;
    return render(half, worker, image);
  }
  const DefaultRounding rounding;
  if (!worker.stream) worker.stream = std::make_unique<kernel::PathStream>();
  const auto pixels = static_cast<std::uint32_t>(tile.width) * static_cast<std::uint32_t>(tile.height);
  const std::uint32_t most = request_.records() ? std::max(1u, kMaxRecords / pixels) : ~0u;
  const std::uint32_t middle = middle_of(tile, image);
  kernel::Tile part = tile;
  for (std::uint32_t begin = tile.sample_begin; begin < tile.sample_end; begin = part.sample_end) {
    part.sample_begin = begin;
    part.sample_end = begin + std::min(most, (begin < middle ? middle : tile.sample_end) - begin);
    attach_buffers(part, worker, image.is_adaptive());
    const kernel::TileCounts counts = render_(view_, tracer_, part, *worker.stream);
    worker.counts.rays += counts.rays;
    worker.counts.bad_samples += counts.bad_samples;
    worker.counts.target = counts.target;
    add_sums(part, image);
    if (request_.records()) add_records(part, worker, image);
  }
}

std::uint32_t TileRenderer::middle_of(const kernel::Tile& tile, const film::Sums& image) const {
  return image.has_halves() ? std::clamp(second_half_, tile.sample_begin, tile.sample_end) : tile.sample_end;
}

void TileRenderer::attach_buffers(kernel::Tile& tile, TileWorker& worker, bool is_adaptive) const {
  const std::size_t pixels = math::pixel_count(tile.width, tile.height);
  tile.row_stride = tile.width;
  tile.half_stride = static_cast<std::int64_t>(pixels);
  const auto clear = [&](auto& buffer, bool has_halves) {
    const std::size_t size = (has_halves && tile.has_both_halves ? 2 : 1) * pixels;
    if (tile.chosen == nullptr || buffer.size() < size) {
      buffer.assign(size, {});
      return buffer.data();
    }
    for (int i = 0; i < tile.chosen_count; ++i)  // often few
      for (std::size_t k = math::pixel_index(tile.chosen[i].x, tile.chosen[i].y, tile.width); k < size; k += pixels)
        buffer[k] = {};
    return buffer.data();
  };
  tile.sums = clear(worker.light, true);
  if (is_adaptive) tile.largest = clear(worker.largest, false);
  if (request_.guides()) tile.guides = clear(worker.guides, true);
  if (request_.coverage) tile.covered = clear(worker.covered, false);
  if (!request_.records()) return;
  worker.records.resize(pixels * (tile.sample_end - tile.sample_begin));
  tile.records = worker.records.data();
  tile.record_light = request_.paths_light();
  tile.record_hits = request_.path_records();
  if (!request_.lights()) return;
  worker.events.reset(worker.records.size());
  tile.events = &worker.events;
}

void TileRenderer::add_sums(const kernel::Tile& tile, film::Sums& image) const {
  const std::size_t first = image.has_halves() && tile.sample_begin >= second_half_ ? 1 : 0,
                    end = tile.has_both_halves ? 2 : first + 1;
  const std::uint32_t samples = tile.sample_end - tile.sample_begin;
  for (int i = 0; i < tile.pixel_count(); ++i) {
    const kernel::PixelPlace at = tile.pixel(i);
    const std::size_t within = math::pixel_index(at.x, at.y, tile.width), pixel = index_of(image, tile, at);
    for (std::size_t half = first; half < end; ++half) {
      const std::size_t from = within + (half - first) * static_cast<std::size_t>(tile.half_stride);
      image.add_light(half, pixel, tile.sums[from], samples);
      if (tile.guides != nullptr) image.add_guides(half, pixel, tile.guides[from], samples);
    }
    if (tile.covered != nullptr) image.layers.covered[pixel] += tile.covered[within];
    if (tile.largest != nullptr) image.largest[pixel] = std::max(image.largest[pixel], tile.largest[within]);
  }
}

void TileRenderer::add_records(const kernel::Tile& tile, const TileWorker& worker, film::Sums& image) const {
  const std::uint32_t samples = tile.sample_end - tile.sample_begin;
  for (int i = 0; request_.path_records() && i < tile.pixel_count(); ++i) {
    const kernel::PixelPlace at = tile.pixel(i);
    const kernel::PathRecord* const records = tile.records + math::pixel_index(at.x, at.y, tile.width) * samples;
    for (std::uint32_t s = 0; s < samples; ++s)
      image.layers.add(request_, view_, index_of(image, tile, at), records[s]);
  }
  if (tile.events == nullptr) return;
  for (const kernel::LightEvent* event = worker.events.begin(); event != worker.events.next; ++event) {
    const auto within = static_cast<int>(event->path / samples);
    image.layers.add(request_, index_of(image, tile, {within % tile.width, within / tile.width}),
                     tile.records[event->path], *event);
  }
}

}  // namespace orrery::render
