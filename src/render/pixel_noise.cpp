// SPDX-License-Identifier: Apache-2.0
#include "render/pixel_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "film/display_error.h"
#include "render/tiles.h"

namespace orrery::render {
namespace {

/// Half-widths of windows, px: around a pixel whose light is compared with that of its neighbours, and of the search
/// for light.
constexpr int kReach = 2, kWideReach = 3;
constexpr int kNeighbours = (2 * kReach + 1) * (2 * kReach + 1) - 1;  ///< of a pixel within kReach

/// Pixels whose neighbours are sorted together: several vectors of any instruction set.
constexpr int kRun = 64;

/// Number of largest samples without which a pixel's own light counts.
constexpr float kTrimmed = 3;

/// Largest half-width of the windows in which errors are averaged, px, and how many pixels must effectively contribute.
constexpr int kLargestReach = 8;
constexpr double kMinEffectiveCount = 3;

/// Lower bound of a pixel's error as a fraction of the image's, so that a pixel unlike its neighbours is never
/// abandoned.
constexpr double kMinError = 1.0 / 64;

/// Paths in a window that must have found light, and expected hits of an emitter in each half, before an error is
/// trusted.
constexpr float kPaths = 4, kHits = 4;

/// The fraction of the squared target that the error of missed emitters may be. Others, such as lamps in two mirrors,
/// may be missed as well.
constexpr double kMissed = 0.25;

/// Samples in each half after which a pixel is given up, so that emitters of a tiny coverage do not decide alone.
constexpr std::uint32_t kSamplesForEmitters = 8192;

/// Light of emitters below this fraction of that around the pixel is ignored.
constexpr float kMinFraction = 1.0f / 8;
/// Coverage that is assumed at least when samples are distributed, so that few are wasted on occluded emitters.
constexpr float kMinCoverage = 1.0f / 32;

/// Keeps squared errors within the range of float; far above any error of interest.
constexpr float kLargestError = 0x1p50f;

constexpr float kDarkest = static_cast<float>(film::kDarkestLight);

/// Calls `use(x, y)` for all pixels: rows in any order and on all threads, the pixels of a row in their order.
template <class Use>
void each_pixel(const PixelStatistics& s, TilePool& pool, Use use) {
  const auto row = [&](std::size_t y, TileWorker&) {
    for (int x = 0; x < s.width; ++x) use(x, static_cast<int>(y));
  };
  pool.run(static_cast<std::size_t>(s.height), row, [] { return false; });
}

/// Calls `use(begin, end)` for the indices of each row of the pixels within `reach`.
template <class Use>
void each_row(const PixelStatistics& s, int x, int y, int reach, Use use) {
  const int left = std::max(x - reach, 0), right = std::min(x + reach, s.width - 1);
  for (int v = std::max(y - reach, 0); v <= std::min(y + reach, s.height - 1); ++v)
    use(s.at(left, v), s.at(right, v) + 1);
}

/// The index of a pixel, which is none of its neighbours; beyond all pixels if there are no others in the image.
std::size_t excluded(const PixelStatistics& s, int x, int y) { return s.samples.size() == 1 ? 1 : s.at(x, y); }

/// Calls `use(index)` for the other pixels within `reach`; for the pixel itself if there are no others in the image.
template <class Use>
void each_neighbour(const PixelStatistics& s, int x, int y, int reach, Use use) {
  const std::size_t self = excluded(s, x, y);
  each_row(s, x, y, reach, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (i != self) use(i);
  });
}

float relative(float variance, float light) {
  const float shown = 2 * std::max(light, kDarkest);
  return std::min(variance / (shown * shown), kLargestError);
}

/// The light that three quarters of the pixels around a pixel exceed, each without its largest sample.
float light_around(const PixelStatistics& s, int x, int y) {
  std::array<float, kNeighbours> light{};
  int count = 0;
  each_neighbour(s, x, y, kReach,
                 [&](std::size_t i) { light[static_cast<std::size_t>(count++)] = s.light[i] - s.outlier[i]; });
  const auto quartile = light.begin() + (count - 1) / 4;
  std::nth_element(light.begin(), quartile, light.begin() + count);
  return *quartile;
}

/// light_around() of kRun pixels from (x, y) on, all of which have all neighbours: a sorting network in vectors, which
/// takes a tenth of the time.
void lights_around(const PixelStatistics& s, int x, int y, float* out) {
  std::array<std::array<float, kRun>, kNeighbours / 4> least;  // of each pixel's neighbours, ascending
  for (auto& rank : least) rank.fill(std::numeric_limits<float>::infinity());
  for (int dy = -kReach; dy <= kReach; ++dy) {
    for (int dx = -kReach; dx <= kReach; ++dx) {
      if (dx == 0 && dy == 0) continue;
      const std::size_t first = s.at(x + dx, y + dy);
      std::array<float, kRun> light;
      for (std::size_t i = 0; i < kRun; ++i) light[i] = s.light[first + i] - s.outlier[first + i];
      for (auto& rank : least) {
        for (std::size_t i = 0; i < kRun; ++i) {
          const float lower = std::min(rank[i], light[i]);
          light[i] = std::max(rank[i], light[i]);
          rank[i] = lower;
        }
      }
    }
  }
  std::copy(least.back().begin(), least.back().end(), out);
}

/// The errors of a row of pixels.
std::vector<float> errors_of_row(const PixelStatistics& s, int y) {
  std::vector<float> around(static_cast<std::size_t>(s.width));
  const bool has_runs = y >= kReach && y + kReach < s.height && s.width >= kRun + 2 * kReach;
  const int end = has_runs ? s.width - kReach : 0;
  for (int x = kReach; x < end; x += kRun) {
    const int first = std::min(x, end - kRun);
    lights_around(s, first, y, &around[static_cast<std::size_t>(first)]);
  }
  for (int x = 0; x < s.width; ++x) {
    const std::size_t i = s.at(x, y);
    float& light = around[static_cast<std::size_t>(x)];
    if (s.variance[i] <= 0)
      light = 0;
    else if (x < kReach || x >= end)
      light = light_around(s, x, y);
    light = relative(s.variance[i], std::max(s.light[i] - kTrimmed * s.outlier[i], std::min(s.light[i], light)));
  }
  return around;
}

/// The fraction of a pixel's light that comes from emitters if the rest is as bright as the pixels around it;
/// 0 if it is negligible.
float share_of_emitters(const PixelStatistics& s, int x, int y) {
  if (s.emitters.empty() || s.emitters[s.at(x, y)].light <= 0) return 0;
  float light = 0;
  int count = 0;
  each_neighbour(s, x, y, kWideReach, [&](std::size_t i) {
    light += s.light[i];
    ++count;
  });
  const float own = s.emitters[s.at(x, y)].light, around = std::max(light / static_cast<float>(count), kDarkest);
  return own < kMinFraction * around ? 0 : own / (own + around);
}

/// The squared relative display error of a single sample that hits emitters by chance.
float error_of_emitters(const PixelStatistics& s, int x, int y) {
  const float share = share_of_emitters(s, x, y);
  if (share == 0) return 0;
  // Hits are 1 with the probability of the coverage, and display errors half the relative errors of radiance.
  return share * share * (1 / std::max(s.emitters[s.at(x, y)].coverage, kMinCoverage) - 1) / 4;
}

/// The squared relative display error of a pixel without the light of its emitters, if its samples are too few to
/// expect several hits of them; 0 if they suffice.
float error_without_emitters(const PixelStatistics& s, int x, int y) {
  const std::size_t i = s.at(x, y);
  const float share = share_of_emitters(s, x, y);
  if (share == 0 || static_cast<float>(s.samples[i]) * s.emitters[i].coverage >= kHits) return 0;
  return share * share / 4;
}

/// Whether a sample has hit an emitter at least half as bright as expected.
bool has_hit_emitters(const PixelStatistics& s, std::size_t i) {
  const float largest = s.outlier[i] * 2 * static_cast<float>(s.samples[i]);
  return 2 * largest * s.emitters[i].coverage >= s.emitters[i].light;
}

/// Whether a pixel's neighbours have found enough light, or can be trusted to be black.
bool has_reliable_estimate(const PixelStatistics& s, int x, int y) {
  if (s.samples[s.at(x, y)] >= kSamplesForReliability) return true;
  int count = 0, dark = 0;
  each_neighbour(s, x, y, kReach, [&](std::size_t i) {
    ++count;
    dark += s.light[i] > 0 || (!s.known_black.empty() && s.known_black[i] != 0) ? 0 : 1;
  });
  if (2 * dark >= count) return false;  // light next to a dark area gives no information about the area
  float light = 0, largest = 0;         // sums over the samples
  each_neighbour(s, x, y, kWideReach, [&](std::size_t i) {
    const float n = 2 * static_cast<float>(s.samples[i]);
    light += n * s.light[i];
    largest = std::max(largest, n * s.outlier[i]);
  });
  return light >= kPaths * largest;
}

}  // namespace

void PixelStatistics::set(std::size_t i, std::uint32_t half, const kernel::PixelSum& a, const kernel::PixelSum& b,
                          float largest) {
  const film::HalvesEstimate halves = film::compare_halves(a, b);
  samples[i] = half;
  light[i] = static_cast<float>(std::max(halves.light, 0.0));
  const auto weight = static_cast<double>(a.weight + b.weight);
  const double excess = std::max(static_cast<double>(largest) / 3 - halves.light, 0.0);
  const double raised = weight > 1 ? excess / (weight - 1) : 0;
  outlier[i] = static_cast<float>(raised);
  variance[i] = static_cast<float>(std::max(halves.variance, raised * raised * halves.color));
}

NoiseEstimate estimate_noise(const PixelStatistics& s, TilePool& pool) {
  struct Sums {
    double sum = 0, squares = 0;
  };
  std::vector<Sums> rows(static_cast<std::size_t>(s.height));
  const auto add_row = [&](std::size_t y, TileWorker&) {
    for (const float error : errors_of_row(s, static_cast<int>(y))) {
      const auto e = static_cast<double>(error);
      rows[y].sum += e;
      rows[y].squares += e * e;
    }
  };
  pool.run(rows.size(), add_row, [] { return false; });
  Sums all;
  for (const Sums& row : rows) {
    all.sum += row.sum;
    all.squares += row.squares;
  }
  const auto pixels = static_cast<double>(s.samples.size());
  return {all.sum / pixels, std::sqrt(all.squares) / pixels};
}

double tolerated_error(double upper, double wanted) {
  return std::min(upper <= wanted ? wanted - upper : wanted, wanted * kMissed);
}

UnreliablePixels find_unreliable_pixels(const PixelStatistics& s, TilePool& pool, double tolerated) {
  UnreliablePixels out;
  out.of_pixel.resize(s.samples.size());
  std::vector<float> without_emitters(s.samples.size());
  each_pixel(s, pool, [&](int x, int y) {
    const std::size_t i = s.at(x, y);
    out.of_pixel[i] = has_reliable_estimate(s, x, y) ? 0 : 1;
    const float error = error_without_emitters(s, x, y);
    if (error > 0 && (s.samples[i] < kSamplesForEmitters || !has_hit_emitters(s, i))) without_emitters[i] = error;
  });
  double sum = 0;
  for (const float error : without_emitters) sum += static_cast<double>(error);
  const bool may_be_missed = sum <= tolerated * static_cast<double>(without_emitters.size());
  for (std::size_t i = 0; i < without_emitters.size(); ++i) {
    const bool lacks_hits = !may_be_missed && without_emitters[i] > 0;
    out.count += out.of_pixel[i] != 0 || lacks_hits ? 1 : 0;
    if (lacks_hits && s.samples[i] < kSamplesForEmitters) out.of_pixel[i] = 1;
  }
  return out;
}

std::vector<float> errors_of_one_sample(const PixelStatistics& s, TilePool& pool) {
  std::vector<float> own(s.samples.size()), of_emitters(own.size()), out(own.size());
  each_pixel(s, pool, [&](int x, int y) {
    const std::size_t i = s.at(x, y);
    of_emitters[i] = error_of_emitters(s, x, y);
    // It is known that other pixels have no such errors.
    own[i] = of_emitters[i] > 0 ? 0 : relative(s.variance[i] * static_cast<float>(s.samples[i]), s.light[i]);
  });
  double mean = 0;
  for (const float e : own) mean += static_cast<double>(e) / static_cast<double>(own.size());
  // For each pixel, how many before it have an error: in large parts of an image, such as a background, none has.
  std::vector<std::uint32_t> noisy_before(own.size() + 1);
  for (std::size_t i = 0; i < own.size(); ++i) noisy_before[i + 1] = noisy_before[i] + (own[i] > 0 ? 1 : 0);

  const auto around = [&](int x, int y) {
    const std::size_t self = excluded(s, x, y);
    for (int reach = 1;; reach *= 2) {
      double sum = 0, squares = 0;
      std::size_t count = 0;
      each_row(s, x, y, reach, [&](std::size_t begin, std::size_t end) {
        count += end - begin;
        if (noisy_before[begin] == noisy_before[end]) return;
        for (std::size_t i = begin; i < end; ++i) {
          if (i == self) continue;
          const auto e = static_cast<double>(own[i]);
          sum += e;
          squares += e * e;
        }
      });
      const auto others = static_cast<double>(self < own.size() ? count - 1 : count);
      if (sum > 0 && sum * sum >= kMinEffectiveCount * squares) return sum / others;
      if (reach == kLargestReach) return sum > 0 ? mean : 0;  // any pixel may be another one of a few noisy ones
    }
  };
  each_pixel(s, pool, [&](int x, int y) {
    const std::size_t i = s.at(x, y);
    out[i] = static_cast<float>(std::max(around(x, y), static_cast<double>(of_emitters[i])) + kMinError * mean);
  });
  return out;
}

}  // namespace orrery::render
