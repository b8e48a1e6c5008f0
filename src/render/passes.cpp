// SPDX-License-Identifier: Apache-2.0
#include "render/passes.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/stop_point.h"
#include "compile/compiled_scene.h"
#include "film/sums.h"
#include "kernel/render_tile.h"
#include "math/pixels.h"
#include "render/render.h"
#include "render/settings.h"
#include "render/tiles.h"

namespace orrery::render {
namespace {

/// Maximum side of a square, px: neighbouring pixels see the same spheres.
constexpr int kLargestSquare = 32;
constexpr int kSmallestSquare = 4;

/// Paths in a square: a few milliseconds of work.
constexpr double kPathsPerSquare = 65536;

/// Samples per pixel of the first pass, without and with somebody who looks; growth of their number from pass to pass;
/// and maximum of a pass: a square of the smallest side must finish soon enough for an interactive stop.
constexpr std::uint32_t kFirstPass = 16, kFirstSeenPass = 1, kGrowth = 4, kLargestPass = 4096;

int side_for(double samples) {
  return std::clamp(static_cast<int>(std::sqrt(kPathsPerSquare / samples)), kSmallestSquare, kLargestSquare);
}

}  // namespace

ProgressReporter::ProgressReporter(const Settings& settings, std::uint64_t total, const film::RenderWork& before)
    : settings_(settings), seconds_before_(before.seconds), done_(before.paths), total_(total) {}

double ProgressReporter::seconds() const {
  return seconds_before_ + (settings_.clock ? settings_.clock(done()) : since_start_.seconds());
}

void ProgressReporter::expect(std::uint64_t total, std::string goal) {
  const std::lock_guard lock(mutex_);
  total_ = std::max(total, done());
  goal_ = std::move(goal);
}

void ProgressReporter::add(std::uint64_t samples) {
  const std::uint64_t done = done_.fetch_add(samples, std::memory_order_relaxed) + samples;
  if (!settings_.on_progress) return;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock.owns_lock()) return;  // another thread is reporting
  const double now = seconds();
  double fraction = static_cast<double>(done) / static_cast<double>(std::max<std::uint64_t>(total_, 1));
  if (!goal_.empty() && settings_.time_budget_s > 0)
    fraction = std::max(fraction, std::min(now / settings_.time_budget_s, 0.99));
  const int percent = static_cast<int>(std::min(fraction, 1.0) * 100);
  if (now - last_ < kInterval && percent == last_percent_ && done < total_) return;
  last_ = now;
  last_percent_ = percent;
  if (goal_.empty()) return settings_.on_progress({done, total_, now, goal_});
  max_reported_ = std::min(std::max(max_reported_, fraction), 1.0);
  const auto total = max_reported_ >= 1 ? done : static_cast<std::uint64_t>(static_cast<double>(done) / max_reported_);
  settings_.on_progress({done, std::max(total, done), now, goal_});
}

bool PassRenderer::run(const OnPixel& on_pixel) {
  const auto cancelled = [&] {
    return settings_.cancel != nullptr && settings_.cancel->load(std::memory_order_relaxed);
  };
  const auto shall_pause = [&] {
    return cancelled() || (settings_.checkpoint_is_due && settings_.checkpoint_is_due());
  };
  std::uint32_t most = 1;  // samples of a pixel
  for (std::size_t i = 0; i < state_.goals.size(); ++i)
    if (state_.goals[i] > state_.counts[i]) most = std::max(most, state_.goals[i] - state_.counts[i]);
  const int side = side_for(state_.is_adaptive() ? 2.0 * most : most);
  for (;;) {
    const std::vector<kernel::PixelPlace> squares = unfinished_squares(side);
    const auto render = [&](std::size_t i, TileWorker& worker) {
      render_square(squares[i].x, squares[i].y, side, on_pixel, worker);
    };
    if (pool_.run(squares.size(), render, shall_pause)) return true;
    if (cancelled()) return false;
    const film::RenderWork before = state_.work;
    state_.work = work_so_far(before, pool_, progress_);
    settings_.on_checkpoint(state_);
    state_.work = before;
  }
}

std::vector<kernel::PixelPlace> PassRenderer::unfinished_squares(int side) const {
  const int width = state_.width, height = state_.height;
  const auto lacks_samples = [&](int x, int y) {
    const std::size_t i = math::pixel_index(x, y, width);
    return state_.counts[i] < state_.goals[i];
  };
  const auto is_unfinished = [&](int x0, int y0) {
    for (int y = y0; y < std::min(y0 + side, height); ++y)
      for (int x = x0; x < std::min(x0 + side, width); ++x)
        if (lacks_samples(x, y)) return true;
    return false;
  };
  std::vector<kernel::PixelPlace> out;
  const base::StopPoint stop;
  for (int y = 0; y < height; y += side) {
    stop.check();
    for (int x = 0; x < width; x += side)
      if (is_unfinished(x, y)) out.push_back({x, y});
  }
  return out;
}

/// Pixels of a square with equal sample counts and equal goals are rendered together.
void PassRenderer::render_square(int x0, int y0, int side, const OnPixel& on_pixel, TileWorker& worker) {
  struct Group {
    std::uint32_t have, want;
    std::vector<kernel::PixelPlace> pixels;
  };
  const int width = state_.width;
  kernel::Tile tile;
  tile.x = x0;
  tile.y = y0;
  tile.width = std::min(side, width - x0);
  tile.height = std::min(side, state_.height - y0);
  const auto at = [&](kernel::PixelPlace p) { return math::pixel_index(x0 + p.x, y0 + p.y, width); };
  std::vector<Group> groups;
  for (int y = 0; y < tile.height; ++y) {
    for (int x = 0; x < tile.width; ++x) {
      const std::uint32_t have = state_.counts[at({x, y})], want = state_.goals[at({x, y})];
      if (have >= want) continue;
      auto group =
          std::find_if(groups.begin(), groups.end(), [&](const Group& g) { return g.have == have && g.want == want; });
      if (group == groups.end()) group = groups.insert(group, {have, want, {}});
      group->pixels.push_back({x, y});
    }
  }
  for (const Group& group : groups) {
    const int count = static_cast<int>(group.pixels.size());
    const bool are_all = count == tile.width * tile.height;
    tile.chosen = are_all ? nullptr : group.pixels.data();
    tile.chosen_count = count;
    tile.has_both_halves = state_.is_adaptive();
    const std::uint32_t first = state_.is_adaptive() ? 0 : settings_.sample_begin;
    tile.sample_begin = first + group.have;
    tile.sample_end = first + group.want;
    render_tile_(tile, worker, state_);
    progress_.add(tile.path_count());
    for (const kernel::PixelPlace p : group.pixels) {
      state_.counts[at(p)] = group.want;
      if (on_pixel) on_pixel(x0 + p.x, y0 + p.y);
    }
    if (settings_.on_pixels) settings_.on_pixels(state_, {x0, y0, tile.width, tile.height, group.pixels});
  }
}

film::RenderWork work_so_far(const film::RenderWork& before, const TilePool& pool, const ProgressReporter& progress) {
  const kernel::TileCounts counts = pool.counts();
  film::RenderWork out = before;
  out.paths = progress.done();
  out.rays += counts.rays;
  out.bad_samples += counts.bad_samples;
  out.seconds = progress.seconds();
  return out;
}

bool render_progressively(const compile::CompiledScene& compiled, const Settings& settings,
                          const TileRenderer& render_tile, TilePool& pool, ProgressReporter& progress,
                          film::Sums& state, Statistics& statistics) {
  const std::uint32_t samples = samples_of(compiled, settings);
  const std::vector<bool> owned = pixels_of(settings.shard, compiled.width, compiled.height);
  PassRenderer passes(settings, render_tile, pool, progress, state);
  for (std::uint32_t done = 0; done < samples;) {
    const std::uint32_t first = settings.on_pixels ? kFirstSeenPass : kFirstPass;
    const std::uint32_t pass = done == 0 ? first : std::min((kGrowth - 1) * done, kLargestPass);
    const std::uint32_t goal = done + std::min(pass, samples - done);
    state.goals.resize(state.pixel_count());
    for (std::size_t i = 0; i < state.goals.size(); ++i) state.goals[i] = owned[i] ? goal : 0;
    const bool completed = passes.run();
    state.goals = base::ZeroVector<std::uint32_t>();  // not needed to resume; frees its memory
    if (!completed) return false;
    done = goal;
  }
  statistics.ended_by = "samples";
  return true;
}

}  // namespace orrery::render
