// SPDX-License-Identifier: Apache-2.0
#include "render/rounds.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "film/display_error.h"
#include "render/allocation.h"
#include "render/passes.h"

namespace orrery::render {
namespace {

/// Sides of the squares that are rendered in one go, px.
constexpr int kSide = 16;

/// Samples of a half before anything is judged by them: fewer would miss what is rare in a pixel and leave it at that.
constexpr std::uint32_t kFirstSamples = 8;

/// No half has more: its numbers begin where the first's end.
constexpr std::uint32_t kMostSamples = kernel::Sampler::kSecondHalf - 1;

/// Of the time that is left, what a round may take: what is known of the speed is known from the rounds before.
constexpr double kShareOfTime = 0.5;
/// Of all time: with less than this left there is no other round.
constexpr double kTimeToSpare = 0.01;

std::string noise_text(double reached, double wanted) {
  char text[64];
  std::snprintf(text, sizeof(text), "noise %.3g of %.3g", reached, wanted);
  return text;
}

class Rounds {
 public:
  Rounds(const compile::World& world, const Settings& settings, const TileRenderer& render_tile, TilePool& pool,
         ProgressReporter& progress, film::Partial& state)
      : settings_(settings),
        passes_(settings, render_tile, pool, progress, state),
        progress_(progress),
        state_(state),
        most_(settings.unlimited ? kMostSamples : std::max(1u, static_cast<std::uint32_t>(world.samples) / 2)) {
    errors_.width = world.width;
    errors_.height = world.height;
    errors_.samples = state.counts;
    errors_.squared.resize(state.pixel_count());
    for (int y = 0; y < world.height; ++y)
      for (int x = 0; x < world.width; ++x) judge(x, y);
  }

  bool run() {
    if (!state_.goals.empty() && !run_round()) return false;  // that in which an earlier run was stopped
    // With a time limit the first round is the smallest there is: it tells the speed.
    std::uint32_t n = *std::min_element(state_.counts.begin(), state_.counts.end());
    for (n = n > 0                   ? next_of_all(n)
             : settings_.seconds > 0 ? 1
                                     : std::min(kFirstSamples, most_);
         n > 0; n = next_of_all(n)) {
      state_.goals.assign(state_.pixel_count(), n);
      if (!run_round()) return false;
    }
    for (;;) {
      const double wanted = settings_.noise * settings_.noise * pixels();
      const double sum = errors_.sum();
      if (settings_.noise > 0 && sum <= wanted) return ended("noise");
      RoundGoal goal;
      goal.squared_sum = settings_.noise > 0 ? wanted : sum / 2;
      goal.most_per_pixel = most_;
      goal.affordable = affordable(kShareOfTime);
      Round round = choose_pixels(errors_, goal);
      if (!round.any && settings_.seconds > 0) {
        goal.affordable = affordable(1);
        round = choose_pixels(errors_, goal);
        if (!round.any)
          return ended(round.limited_by_pixels && static_cast<double>(goal.affordable) > pixels() ? "samples" : "time");
      }
      if (!round.any) return ended(round.limited_by_pixels ? "samples" : "noise");
      if (settings_.noise > 0) expect(round, std::sqrt(sum / pixels()));
      state_.goals = state_.counts;
      for (std::size_t i = 0; i < state_.goals.size(); ++i)
        if (round.chosen[i]) state_.goals[i] = std::min(2 * state_.goals[i], most_);
      if (!run_round()) return false;
    }
  }

  void tell(Statistics& statistics) const {
    statistics.noise = std::sqrt(errors_.sum() / pixels());
    statistics.ended_by = ended_by_;
  }

 private:
  double pixels() const { return static_cast<double>(errors_.samples.size()); }

  bool ended(const char* by) {
    ended_by_ = by;
    return true;
  }

  /// Of a half; how many the next of the first rounds brings every pixel to. 0: those rounds are over.
  std::uint32_t next_of_all(std::uint32_t n) const {
    const std::uint32_t next = std::min({2 * n, kFirstSamples, most_});
    return next > n && affordable(kShareOfTime) >= static_cast<std::uint64_t>(pixels()) * (next - n) ? next : 0;
  }

  /// Samples of a half that a share of the remaining time allows; both are rendered.
  std::uint64_t affordable(double share) const {
    if (settings_.seconds <= 0) return std::numeric_limits<std::uint64_t>::max();
    const double left = settings_.seconds - progress_.seconds();
    if (left < settings_.seconds * kTimeToSpare) return 0;
    return static_cast<std::uint64_t>(left * share * samples_per_second_ / 2);
  }

  void expect(const Round& round, double noise) {
    const double limit = 2.0 * pixels() * most_;
    const double total = static_cast<double>(progress_.done()) + 2 * round.samples_to_goal;
    if (total < limit) {
      progress_.expect(static_cast<std::uint64_t>(total), noise_text(noise, settings_.noise));
    } else {
      progress_.expect(static_cast<std::uint64_t>(std::min(limit, 0x1p62)), "samples");
    }
  }

  /// Brings all pixels to their goals.
  bool run_round() {
    const double begin = progress_.seconds();
    const std::uint64_t done = progress_.done();
    if (!passes_.run(kSide, [this](int x, int y) { judge(x, y); })) return false;
    state_.goals.clear();
    // What the last round has shown counts most: pixels that go on are not like the others.
    const double seconds = progress_.seconds() - begin;
    if (seconds > 0) {
      const double speed = static_cast<double>(progress_.done() - done) / seconds;
      samples_per_second_ = samples_per_second_ > 0 ? (samples_per_second_ + 3 * speed) / 4 : speed;
    }
    return true;
  }

  void judge(int x, int y) {
    errors_.samples[at(x, y)] = state_.counts[at(x, y)];
    errors_.squared[at(x, y)] =
        static_cast<float>(film::display_error_squared(*state_.film.at(x, y), *state_.second.at(x, y)));
  }

  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(errors_.width) + static_cast<std::size_t>(x);
  }

  const Settings& settings_;
  Passes passes_;
  ProgressReporter& progress_;
  film::Partial& state_;
  std::uint32_t most_;  ///< samples of a half
  PixelErrors errors_;  ///< samples are those of a half
  double samples_per_second_ = 0;
  const char* ended_by_ = "samples";
};

}  // namespace

bool render_in_rounds(const compile::World& world, const Settings& settings, const TileRenderer& render_tile,
                      TilePool& pool, ProgressReporter& progress, film::Partial& state, Statistics& statistics) {
  Rounds rounds(world, settings, render_tile, pool, progress, state);
  progress.expect(settings.unlimited ? std::uint64_t{1} << 62 : std::uint64_t(world.samples) * state.pixel_count(),
                  settings.noise > 0 ? "noise" : "time");
  if (!rounds.run()) return false;
  rounds.tell(statistics);
  return true;
}

}  // namespace orrery::render
