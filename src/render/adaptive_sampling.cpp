// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive_sampling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>
#include <vector>

#include "accel/accel.h"
#include "compile/compiled_scene.h"
#include "film/sums.h"
#include "render/allocation.h"
#include "render/emitter_coverage.h"
#include "render/passes.h"
#include "render/pixel_noise.h"
#include "render/result.h"
#include "render/settings.h"
#include "render/tiles.h"

namespace orrery::render {
namespace {

/// Minimum samples of a half before errors are estimated: with fewer, rare light in a pixel would be missed for good.
constexpr std::uint32_t kFirstSamples = 8;
/// The same for an image with halves, which will be denoised; pixels at edges get twice as many.
constexpr std::uint32_t kFirstDenoisedSamples = 2;
/// Contrast of a pixel's neighbours from which it is at an edge.
constexpr float kEdgeContrast = 0.2F;

/// Maximum samples of a half: the second half's sample numbers begin where the first's end.
constexpr std::uint32_t kMaxSamples = kernel::Sampler::kSecondHalf - 1;

/// The fraction of the remaining time that an iteration may take, since the speed is known only from earlier ones.
constexpr double kShareOfTime = 0.5;
/// With less than this fraction of the time budget left, no further iteration starts.
constexpr double kReservedTime = 0.01;

std::string noise_text(double reached, double wanted) {
  char text[64];
  std::snprintf(text, sizeof(text), "noise %.3g of %.3g", reached, wanted);
  return text;
}

/// Means of albedo, normal and inverse depth of a pixel.
using MeanGuides = std::array<float, 7>;

class AdaptiveSampling {
 public:
  AdaptiveSampling(const compile::CompiledScene& compiled, const accel::Accel& accel, const Settings& settings,
                   const TileRenderer& render_tile, TilePool& pool, ProgressReporter& progress, film::Sums& state)
      : settings_(settings),
        render_tile_(render_tile),
        passes_(settings, render_tile, pool, progress, state),
        pool_(pool),
        progress_(progress),
        state_(state),
        first_samples_(settings.layers.halves ? kFirstDenoisedSamples : kFirstSamples),
        max_samples_(settings.unlimited ? kMaxSamples : std::max(1u, static_cast<std::uint32_t>(compiled.samples) / 2)),
        pixels_(compiled.width, compiled.height),
        iteration_begin_(progress.seconds()),
        iteration_begin_samples_(progress.done()) {
    if (settings.layers.transparent || render_tile.has_empty_pixels())
      pixels_.known_black.resize(pixels_.samples.size());
    pixels_.emitters =
        emitter_coverage(render_tile.view(), {accel.tracer(), compiled.precision}, compiled.width, compiled.height);
    if (std::all_of(state.counts.begin(), state.counts.end(), [](std::uint32_t n) { return n == 0; }))
      return;  // the first iteration sets all pixels
    const auto update_row = [&](std::size_t y, TileWorker&) {
      for (int x = 0; x < compiled.width; ++x)
        if (state.counts[pixels_.at(x, static_cast<int>(y))] > 0) update(x, static_cast<int>(y));
    };
    pool.run(static_cast<std::size_t>(compiled.height), update_row);
  }

  bool run() {
    if (!state_.goals.empty() && !run_iteration())
      return false;  // the iteration in which an earlier run was interrupted
    // With a time budget the first iteration is as small as possible: it measures the speed. So it is if somebody
    // looks.
    const bool begins_small = settings_.time_budget_s > 0 || settings_.on_pixels;
    std::uint32_t n = *std::min_element(state_.counts.begin(), state_.counts.end());
    for (n = n > 0          ? next_uniform_count(n)
             : begins_small ? 1
                            : std::min(first_samples_, max_samples_);
         n > 0; n = next_uniform_count(n)) {
      state_.goals.assign(state_.pixel_count(), n);
      if (!run_iteration()) return false;
    }
    if (!sample_edges()) return false;
    const double wanted = settings_.noise * settings_.noise;
    for (;;) {
      noise_ = estimate_noise(pixels_, pool_);
      const double upper = noise_.upper();
      const UnreliablePixels unreliable = find_unreliable_pixels(pixels_, pool_, tolerated_error(upper, wanted));
      unreliable_count_ = unreliable.count;
      if (settings_.noise > 0 && upper <= wanted && unreliable_count_ == 0) return ended("noise");
      IterationGoal goal;
      goal.error_ratio = settings_.noise > 0 ? (upper > wanted ? wanted / upper : 1) : 0.5;
      goal.max_per_pixel = max_samples_;
      goal.affordable = affordable(kShareOfTime);
      const std::vector<float> errors = errors_of_one_sample(pixels_, pool_);
      PixelSelection selection = choose_pixels(pixels_.samples, errors, unreliable.of_pixel, goal);
      if (!selection.any && settings_.time_budget_s > 0) {
        goal.affordable = affordable(1);
        selection = choose_pixels(pixels_.samples, errors, unreliable.of_pixel, goal);
        if (!selection.any)
          return ended(selection.limited_by_pixels && goal.affordable > pixels_.samples.size() ? "samples" : "time");
      }
      if (!selection.any) return ended(selection.limited_by_pixels || unreliable_count_ > 0 ? "samples" : "noise");
      if (settings_.noise > 0) expect(selection, std::sqrt(upper));
      state_.goals = state_.counts;
      for (std::size_t i = 0; i < state_.goals.size(); ++i)
        if (selection.chosen[i])
          state_.goals[i] = state_.goals[i] < max_samples_ / 2 ? 2 * state_.goals[i] : max_samples_;
      if (!run_iteration()) return false;
    }
  }

  void report(Statistics& statistics) const {
    statistics.expected_noise = std::sqrt(noise_.mean_square);
    statistics.noise = std::sqrt(noise_.upper());
    statistics.unreliable_pixels = unreliable_count_;
    statistics.ended_by = ended_by_;
  }

 private:
  bool ended(const char* by) {
    ended_by_ = by;
    return true;
  }

  /// The next uniform sample count of a half; 0: the initial, uniform iterations are over.
  std::uint32_t next_uniform_count(std::uint32_t n) const {
    const std::uint32_t next = std::min({2 * n, first_samples_, max_samples_});
    return next > n && affordable(kShareOfTime) >= std::uint64_t{next - n} * pixels_.samples.size() ? next : 0;
  }

  /// Samples of a half that can be rendered, together with those of the other, in a fraction of the remaining time.
  std::uint64_t affordable(double share) const {
    if (settings_.time_budget_s <= 0) return std::numeric_limits<std::uint64_t>::max();
    const double left = settings_.time_budget_s - progress_.seconds();
    if (left < settings_.time_budget_s * kReservedTime) return 0;
    return static_cast<std::uint64_t>(left * share * samples_per_second_ / 2);
  }

  void expect(const PixelSelection& selection, double noise) {
    const double limit = 2.0 * static_cast<double>(pixels_.samples.size()) * max_samples_;
    const double total = static_cast<double>(progress_.done()) + 2 * selection.samples_to_goal;
    if (total < limit) {
      progress_.expect(static_cast<std::uint64_t>(total), noise_text(noise, settings_.noise));
    } else {
      progress_.expect(static_cast<std::uint64_t>(std::min(limit, 0x1p62)), "samples");
    }
  }

  /// Doubles the first samples of pixels at edges in an image with halves: no neighbour has the same mixture of
  /// objects, so that the denoiser leaves their noise. Their neighbours decide, see errors_of_one_sample().
  ///
  /// Result     false if cancelled
  bool sample_edges() {
    const auto is_first = [this](std::uint32_t n) { return n == first_samples_; };
    const std::uint32_t goal = std::min(2 * first_samples_, max_samples_);
    if (!settings_.layers.halves || goal == first_samples_ ||
        !std::all_of(state_.counts.begin(), state_.counts.end(), is_first))
      return true;
    const auto each_pixel = [this](const auto& use) {
      const auto row = [&](std::size_t y, TileWorker&) {
        for (int x = 0; x < pixels_.width; ++x) use(x, static_cast<int>(y));
      };
      pool_.run(static_cast<std::size_t>(pixels_.height), row);
    };
    std::vector<MeanGuides> guides(pixels_.samples.size());
    each_pixel([&](int x, int y) { guides[pixels_.at(x, y)] = guides_in(pixels_.at(x, y)); });
    base::ZeroVector<std::uint32_t> goals = state_.counts;
    each_pixel([&](int x, int y) {
      if (contrast_around(guides, x, y) > kEdgeContrast) goals[pixels_.at(x, y)] = goal;
    });
    const auto edges = static_cast<std::uint64_t>(std::count(goals.begin(), goals.end(), goal));
    if (edges == 0 || affordable(kShareOfTime) < edges * (goal - first_samples_)) return true;
    state_.goals = std::move(goals);
    return run_iteration();
  }

  /// What the paths of a pixel see first.
  MeanGuides guides_in(std::size_t i) const {
    kernel::GuideSum sum = state_.guides_of(0, i);
    sum += state_.guides_of(1, i);
    const auto count = static_cast<double>(std::max<std::int64_t>(sum.weight, 1));
    MeanGuides out{};
    for (std::size_t k = 0; k < 3; ++k) {
      out[k] = static_cast<float>(static_cast<double>(sum.albedo[k]) * kernel::kGuideUnit / count);
      out[3 + k] = static_cast<float>(static_cast<double>(sum.normal[k]) * kernel::kGuideUnit / count);
    }
    out[6] = static_cast<float>(kernel::from_fixed_point(sum.inverse_depth) / count);
    return out;
  }

  /// By how much the neighbours of a pixel differ: squared ranges of albedo, normal and depth, weighted as in the
  /// denoiser.
  float contrast_around(const std::vector<MeanGuides>& guides, int x, int y) const {
    MeanGuides low, high;
    low.fill(std::numeric_limits<float>::max());
    high.fill(std::numeric_limits<float>::lowest());
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, pixels_.height - 1); ++v)
      for (int u = std::max(x - 1, 0); u <= std::min(x + 1, pixels_.width - 1); ++u)
        for (std::size_t k = 0; k < low.size() && (u != x || v != y); ++k) {
          low[k] = std::min(low[k], guides[pixels_.at(u, v)][k]);
          high[k] = std::max(high[k], guides[pixels_.at(u, v)][k]);
        }
    const auto square = [&](std::size_t k) { return (high[k] - low[k]) * (high[k] - low[k]); };
    const float depth = high[6] > 0 ? (high[6] - low[6]) / high[6] : 0;
    return 2 * (square(0) + square(1) + square(2)) + (square(3) + square(4) + square(5)) / 2 + depth * depth / 8;
  }

  /// Renders all pixels up to their goals.
  bool run_iteration() {
    if (!passes_.run([this](int x, int y) { update(x, y); })) return false;
    state_.goals = base::ZeroVector<std::uint32_t>();
    // The last iteration counts most, since the pixels that continue are unlike the others. Its time includes choosing
    // them.
    const double seconds = progress_.seconds() - iteration_begin_;
    if (seconds > 0) {
      const double speed = static_cast<double>(progress_.done() - iteration_begin_samples_) / seconds;
      samples_per_second_ = samples_per_second_ > 0 ? (samples_per_second_ + 3 * speed) / 4 : speed;
    }
    iteration_begin_ = progress_.seconds();
    iteration_begin_samples_ = progress_.done();
    return true;
  }

  void update(int x, int y) {
    const std::size_t i = pixels_.at(x, y);
    pixels_.set(i, state_.counts[i], state_.light_of(0, i), state_.light_of(1, i), state_.largest[i]);
    // With a transparent background, pixels in which no path hits a sphere are black.
    if (!pixels_.known_black.empty())
      pixels_.known_black[i] =
          render_tile_.is_empty(i) || (settings_.layers.transparent && state_.layers.covered[i] == 0) ? 1 : 0;
  }

  const Settings& settings_;
  const TileRenderer& render_tile_;
  PassRenderer passes_;
  TilePool& pool_;
  ProgressReporter& progress_;
  film::Sums& state_;
  std::uint32_t first_samples_, max_samples_;  ///< of a half
  PixelStatistics pixels_;
  NoiseEstimate noise_;
  std::uint64_t unreliable_count_ = 0;  ///< pixels
  double samples_per_second_ = 0;
  double iteration_begin_;  ///< seconds
  std::uint64_t iteration_begin_samples_;
  const char* ended_by_ = "samples";
};

}  // namespace

bool render_adaptively(const compile::CompiledScene& compiled, const accel::Accel& accel, const Settings& settings,
                       const TileRenderer& render_tile, TilePool& pool, ProgressReporter& progress, film::Sums& state,
                       Statistics& statistics) {
  AdaptiveSampling rounds(compiled, accel, settings, render_tile, pool, progress, state);
  progress.expect(settings.unlimited ? std::uint64_t{1} << 62 : std::uint64_t(compiled.samples) * state.pixel_count(),
                  settings.noise > 0 ? "noise" : "time");
  if (!rounds.run()) return false;
  rounds.report(statistics);
  return true;
}

}  // namespace orrery::render
