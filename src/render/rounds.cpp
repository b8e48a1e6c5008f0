// SPDX-License-Identifier: Apache-2.0
#include "render/rounds.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "film/display_error.h"
#include "render/allocation.h"

namespace orrery::render {
namespace {

using kernel::Sampler;

/// Sides of the squares that are rendered in one go, px.
constexpr int kSide = 16;

/// Samples of a half before anything is judged by them: fewer would miss what is rare in a pixel and leave it at that.
constexpr std::uint32_t kFirstSamples = 8;

/// No half has more: its numbers begin where the first's end.
constexpr std::uint32_t kMostSamples = Sampler::kSecondHalf - 1;

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
         ProgressReporter& progress, film::Film& film, bool has_layers)
      : settings_(settings),
        render_tile_(render_tile),
        pool_(pool),
        progress_(progress),
        first_(film),
        second_(world.width, world.height),
        most_(settings.unlimited ? kMostSamples : std::max(1u, static_cast<std::uint32_t>(world.samples) / 2)) {
    errors_.width = world.width;
    errors_.height = world.height;
    errors_.samples.assign(film.pixel_count(), 0);
    errors_.squared.assign(film.pixel_count(), 0);
    if (has_layers) kept_.resize(film.pixel_count());
  }

  bool run() {
    // With a time limit the first round is the smallest there is: it tells the speed.
    std::vector<bool> all(errors_.samples.size(), true);
    for (std::uint32_t n = settings_.seconds > 0 ? 1 : std::min(kFirstSamples, most_); n > 0; n = next_of_all(n))
      if (!run_round(all, n)) return false;
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
      if (!run_round(round.chosen, 0)) return false;
    }
  }

  void finish(film::LayerFilm* layers, Statistics& statistics) {
    if (layers != nullptr)
      for (std::size_t i = 0; i < kept_.size(); ++i) layers->set(i, kept_[i]);
    first_.add(second_);
    const auto [fewest, most] = std::minmax_element(errors_.samples.begin(), errors_.samples.end());
    statistics.fewest_samples = 2 * std::uint64_t{*fewest};
    statistics.most_samples = 2 * std::uint64_t{*most};
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

  /// Brings the chosen pixels to `to` samples in each half; 0: to twice as many as they have.
  bool run_round(const std::vector<bool>& chosen, std::uint32_t to) {
    const double begin = progress_.seconds();
    const std::uint64_t done = progress_.done();
    const int across = (errors_.width + kSide - 1) / kSide, down = (errors_.height + kSide - 1) / kSide;
    const auto squares = static_cast<std::size_t>(across) * static_cast<std::size_t>(down);
    const bool completed = pool_.run(squares, [&](std::size_t i, TileWorker& worker) {
      const int square = static_cast<int>(i);
      render_square(square % across * kSide, square / across * kSide, chosen, to, worker);
    });
    // What the last round has shown counts most: pixels that go on are not like the others.
    const double seconds = progress_.seconds() - begin;
    if (seconds > 0) {
      const double speed = static_cast<double>(progress_.done() - done) / seconds;
      samples_per_second_ = samples_per_second_ > 0 ? (samples_per_second_ + 3 * speed) / 4 : speed;
    }
    return completed;
  }

  /// Pixels of a square that have had as many samples, and shall have as many more, go together.
  void render_square(int x0, int y0, const std::vector<bool>& chosen, std::uint32_t to, TileWorker& worker) {
    kernel::Tile tile;
    tile.x = x0;
    tile.y = y0;
    tile.width = std::min(kSide, errors_.width - x0);
    tile.height = std::min(kSide, errors_.height - y0);
    tile.row_stride = errors_.width;
    std::vector<std::vector<kernel::PixelPlace>> by_count(34);
    for (int y = 0; y < tile.height; ++y)
      for (int x = 0; x < tile.width; ++x)
        if (chosen[at(x0 + x, y0 + y)])
          by_count[static_cast<std::size_t>(std::bit_width(errors_.samples[at(x0 + x, y0 + y)]))].push_back({x, y});
    for (const std::vector<kernel::PixelPlace>& pixels : by_count) {
      if (pixels.empty()) continue;
      const std::uint32_t n = errors_.samples[at(x0 + pixels[0].x, y0 + pixels[0].y)];
      const std::uint32_t next = to > 0 ? to : std::min(2 * n, most_);
      tile.chosen = pixels.data();
      tile.chosen_count = static_cast<int>(pixels.size());
      for (film::Film* half : {&first_, &second_}) {
        const std::uint32_t first = half == &first_ ? 0 : Sampler::kSecondHalf;
        tile.sample_begin = first + n;
        tile.sample_end = first + next;
        tile.sums = half->at(x0, y0);
        render_tile_(tile, worker, kept_.empty() ? nullptr : kept_.data());
      }
      for (const kernel::PixelPlace& p : pixels) {
        const int x = x0 + p.x, y = y0 + p.y;
        errors_.samples[at(x, y)] = next;
        errors_.squared[at(x, y)] =
            static_cast<float>(film::display_error_squared(*first_.at(x, y), *second_.at(x, y)));
      }
      progress_.add(2 * tile.path_count());
    }
  }

  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(errors_.width) + static_cast<std::size_t>(x);
  }

  const Settings& settings_;
  const TileRenderer& render_tile_;
  TilePool& pool_;
  ProgressReporter& progress_;
  film::Film& first_;
  film::Film second_;
  std::uint32_t most_;  ///< samples of a half
  PixelErrors errors_;  ///< samples are those of a half
  std::vector<film::LayerPixel> kept_;
  double samples_per_second_ = 0;
  const char* ended_by_ = "samples";
};

}  // namespace

bool render_in_rounds(const compile::World& world, const Settings& settings, const TileRenderer& render_tile,
                      TilePool& pool, ProgressReporter& progress, film::Film& film, film::LayerFilm* layers,
                      Statistics& statistics) {
  Rounds rounds(world, settings, render_tile, pool, progress, film, layers != nullptr);
  progress.expect(settings.unlimited ? std::uint64_t{1} << 62 : std::uint64_t(world.samples) * film.pixel_count(),
                  settings.noise > 0 ? "noise" : "time");
  if (!rounds.run()) return false;
  rounds.finish(layers, statistics);
  return true;
}

}  // namespace orrery::render
