// SPDX-License-Identifier: Apache-2.0
#include "render/pixel_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

#include "base/stop_point.h"
#include "film/display_error.h"
#include "render/tiles.h"

namespace orrery::render {
namespace {

/// Half-widths of windows, px: around a pixel whose light is compared with that of its neighbours, and of the search
/// for light.
constexpr int kReach = 2, kWideReach = 3;
constexpr int kNeighbours = (2 * kReach + 1) * (2 * kReach + 1) - 1;  ///< of a pixel within kReach
/// One in so many neighbours is darker than the light around a pixel.
constexpr std::size_t kDarkerOneIn = 4;

/// Pixels that are compared with their neighbours together: several vectors of any instruction set.
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

/// Calls `use(y)` for all rows, in any order and on all threads.
template <class Use>
void each_row(const PixelStatistics& s, TilePool& pool, Use use) {
  const auto row = [&](std::size_t y, TileWorker&) { use(static_cast<int>(y)); };
  pool.run(static_cast<std::size_t>(s.height), row);
}

/// Calls `use(x, y)` for all pixels: rows in any order and on all threads, the pixels of a row in their order.
template <class Use>
void each_pixel(const PixelStatistics& s, TilePool& pool, Use use) {
  each_row(s, pool, [&](int y) {
    for (int x = 0; x < s.width; ++x) use(x, y);
  });
}

/// Calls `use(begin, end)` for the indices of each row of the pixels within `reach`.
template <class Use>
void each_row_within(const PixelStatistics& s, int x, int y, int reach, Use use) {
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
  each_row_within(s, x, y, reach, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (i != self) use(i);
  });
}

/// Calls `use(x, count)` for runs of pixels that contain those of a row, with `count` an integral constant: kRun for
/// runs with all neighbours within `reach`, 1 for other pixels. each_neighbour() of the first pixel has the first
/// pixels of the neighbouring runs.
template <class Use>
void each_run(const PixelStatistics& s, int y, int reach, Use use) {
  const bool has_runs = y >= reach && y + reach < s.height && s.width >= kRun + 2 * reach;
  const int end = has_runs ? s.width - reach : 0;
  for (int x = reach; x < end; x += kRun) use(std::min(x, end - kRun), std::integral_constant<std::size_t, kRun>());
  for (int x = 0; x < s.width; ++x)
    if (x < reach || x >= end) use(x, std::integral_constant<std::size_t, 1>());
}

float relative(float variance, float light) {
  const float shown = 2 * std::max(light, kDarkest);
  return std::min(variance / (shown * shown), kLargestError);
}

/// The light that three quarters of the pixels around each pixel of a run exceed, each without its largest sample. A
/// sorting network in vectors takes a tenth of the time of std::nth_element.
template <std::size_t N>
void lights_around(const PixelStatistics& s, int x, int y, float* out) {
  std::array<std::array<float, N>, kNeighbours / kDarkerOneIn> least;  // of each pixel's neighbours, ascending
  for (auto& rank : least) rank.fill(std::numeric_limits<float>::infinity());
  std::size_t count = 0;
  each_neighbour(s, x, y, kReach, [&](std::size_t first) {
    ++count;
    std::array<float, N> light;
    for (std::size_t i = 0; i < N; ++i) light[i] = s.light[first + i] - s.outlier[first + i];
    for (auto& rank : least) {
      for (std::size_t i = 0; i < N; ++i) {
        const float lower = std::min(rank[i], light[i]);
        light[i] = std::max(rank[i], light[i]);
        rank[i] = lower;
      }
    }
  });
  std::ranges::copy(least[(count - 1) / kDarkerOneIn], out);
}

/// The errors of a row of pixels.
std::vector<float> errors_of_row(const PixelStatistics& s, int y) {
  std::vector<float> out(static_cast<std::size_t>(s.width));
  each_run(s, y, kReach,
           [&](int x, auto count) { lights_around<count()>(s, x, y, &out[static_cast<std::size_t>(x)]); });
  for (int x = 0; x < s.width; ++x) {
    const std::size_t i = s.at(x, y);
    float& value = out[static_cast<std::size_t>(x)];
    value = relative(s.variance[i], std::max(s.light[i] - kTrimmed * s.outlier[i], std::min(s.light[i], value)));
  }
  return out;
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

/// What the neighbours of pixels have found.
class FoundLight {
 public:
  FoundLight(const PixelStatistics& s, TilePool& pool)
      : s_(s), light_(s.samples.size()), largest_(light_.size()), is_dark_(light_.size()) {
    each_pixel(s, pool, [&](int x, int y) {
      const std::size_t i = s.at(x, y);
      const float n = 2 * static_cast<float>(s.samples[i]);
      light_[i] = n * s.light[i];
      largest_[i] = n * s.outlier[i];
      is_dark_[i] = s.light[i] > 0 || (!s.known_black.empty() && s.known_black[i] != 0) ? 0 : 1;
    });
  }

  /// Sets `is_unreliable` of a row of pixels.
  void find_unreliable(int y, std::vector<std::uint8_t>& is_unreliable) const {
    each_run(s_, y, kWideReach, [&]<std::size_t N>(int x, std::integral_constant<std::size_t, N>) {
      std::array<float, N> light{}, largest{}, dark{};
      float count = 0;
      each_neighbour(s_, x, y, kReach, [&](std::size_t first) {
        ++count;
        for (std::size_t i = 0; i < N; ++i) dark[i] += is_dark_[first + i];
      });
      each_neighbour(s_, x, y, kWideReach, [&](std::size_t first) {
        for (std::size_t i = 0; i < N; ++i) light[i] += light_[first + i];
        for (std::size_t i = 0; i < N; ++i) {
          const float before = largest[i], other = largest_[first + i];  // values: references would be branches
          largest[i] = before < other ? other : before;
        }
      });
      for (std::size_t i = 0; i < N; ++i) {
        const std::size_t own = s_.at(x, y) + i;
        is_unreliable[own] = is_reliable(own, count, dark[i], light[i], largest[i]) ? 0 : 1;
      }
    });
  }

 private:
  /// Whether a pixel's neighbours have found enough light, or can be trusted to be black. Light next to a dark area
  /// gives no information about the area.
  bool is_reliable(std::size_t own, float count, float dark, float light, float largest) const {
    return s_.samples[own] >= kSamplesForReliability || (2 * dark < count && light >= kPaths * largest);
  }

  const PixelStatistics& s_;
  std::vector<float> light_, largest_, is_dark_;  ///< of the samples: sum, largest; 1: none has found light
};

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
  each_row(s, pool, [&](int y) {
    Sums& row = rows[static_cast<std::size_t>(y)];
    for (const float error : errors_of_row(s, y)) {
      const auto e = static_cast<double>(error);
      row.sum += e;
      row.squares += e * e;
    }
  });
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
  const FoundLight found(s, pool);
  each_row(s, pool, [&](int y) { found.find_unreliable(y, out.of_pixel); });
  each_pixel(s, pool, [&](int x, int y) {
    const std::size_t i = s.at(x, y);
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
  const base::StopPoint stop;
  for (std::size_t i = 0; i < own.size(); ++i) {
    stop.check(i);
    mean += static_cast<double>(own[i]) / static_cast<double>(own.size());
  }
  // For each pixel, how many before it have an error: in large parts of an image, such as a background, none has.
  std::vector<std::uint32_t> noisy_before(own.size() + 1);
  for (std::size_t i = 0; i < own.size(); ++i) noisy_before[i + 1] = noisy_before[i] + (own[i] > 0 ? 1 : 0);

  const auto suffices = [](double sum, double squares) { return sum > 0 && sum * sum >= kMinEffectiveCount * squares; };
  const auto around = [&](int x, int y) {
    const std::size_t self = excluded(s, x, y);
    for (int reach = 2;; reach *= 2) {
      double sum = 0, squares = 0;
      std::size_t count = 0;
      each_row_within(s, x, y, reach, [&](std::size_t begin, std::size_t end) {
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
      if (suffices(sum, squares)) return sum / others;
      if (reach == kLargestReach) return sum > 0 ? mean : 0;  // any pixel may be another one of a few noisy ones
    }
  };
  const auto set = [&](int x, int y, double error) {
    const std::size_t i = s.at(x, y);
    out[i] = static_cast<float>(std::max(error, static_cast<double>(of_emitters[i])) + kMinError * mean);
  };
  const auto set_row = [&](int y) {
    each_run(s, y, 1, [&]<std::size_t N>(int x, std::integral_constant<std::size_t, N>) {
      std::array<double, N> sum{}, squares{};
      double count = 0;
      each_neighbour(s, x, y, 1, [&](std::size_t first) {
        ++count;
        for (std::size_t i = 0; i < N; ++i) {
          const auto e = static_cast<double>(own[first + i]);
          sum[i] += e;
          squares[i] += e * e;
        }
      });
      for (std::size_t i = 0; i < N; ++i) {
        const int at = x + static_cast<int>(i);
        set(at, y, suffices(sum[i], squares[i]) ? sum[i] / count : around(at, y));
      }
    });
  };
  each_row(s, pool, set_row);
  return out;
}

}  // namespace orrery::render
