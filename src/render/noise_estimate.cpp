// SPDX-License-Identifier: Apache-2.0
#include "render/noise_estimate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>

#include "film/display_error.h"
#include "render/light_guide.h"
#include "render/small_emitters.h"
#include "render/tiles.h"

namespace orrery::render {
namespace {

/// Half-widths of windows, px: for averaging errors; for averaging if fewer than kMinEffectiveCount pixels effectively
/// contribute to the first mean; and for deciding whether an estimate is reliable.
constexpr int kReach = 2, kWideReach = 4, kReliabilityReach = 3;
constexpr double kMinEffectiveCount = 3;

/// Errors are sparse if effectively less than one pixel in kSparse makes up the mean.
constexpr double kSparse = 64;

/// Side of a patch, px. Windows larger than kWideReach are 3 x 3 and 9 x 9 patches around the pixel's own.
constexpr int kPatch = 16;

/// Lower bound of a pixel's error as a fraction of the image's without its small emitters, so that a pixel unlike its
/// neighbours is never abandoned.
constexpr float kMinError = 1.0f / 64;

/// Paths in a window that must have found light before its error is trusted.
constexpr double kHits = 4;
/// Keeps squared errors within the range of float; far above any error of interest.
constexpr float kLargestError = 0x1p50f;

void run(TilePool& pool, std::size_t count, const std::function<void(std::size_t)>& work) {
  pool.run(
      count, [&](std::size_t i, TileWorker&) { work(i); }, [] { return false; });
}

float relative(float variance, float light) {
  const float floor = static_cast<float>(film::kDarkestLight);
  const float shown = 2 * std::max(light, floor);
  return std::min(variance / (shown * shown), kLargestError);
}

/// Whether no pixel of a block has any variance, as where only a constant background is visible. Such blocks need no
/// guide: all their errors are 0.
bool is_noiseless(const PixelStatistics& s, const PixelBlock& b) {
  for (int y = b.y; y < b.y + b.height; ++y) {
    const float* const row = s.variance.data() + s.at(b.x, y);
    if (std::any_of(row, row + b.width, [](float v) { return v != 0; })) return false;
  }
  return true;
}

/// Errors of single samples of all pixels except one class's, and their sums.
class CrossValidatedErrors {
 public:
  struct Sums {
    double sum = 0, squares = 0;
    int count = 0;

    bool is_enough() const { return sum > 0 && sum * sum >= kMinEffectiveCount * squares; }
    bool is_sparse() const { return sum * sum * kSparse < squares * count; }
    float mean() const { return count > 0 ? static_cast<float>(sum / count) : 0.0f; }
  };

  explicit CrossValidatedErrors(const PixelStatistics& s)
      : s_(s),
        across_((s.width + kPatch - 1) / kPatch),
        down_((s.height + kPatch - 1) / kPatch),
        values_(s.samples.size()),
        patches_(static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_)),
        wide_(patches_.size()) {}

  /// Computes the errors of a block, whose sides are whole patches except at the image's border. Pixels with small
  /// emitters do not count in sums of patches, because it is known that other pixels have no such errors.
  ///
  /// `guide`    radiance of the block's pixels; empty: the block is noiseless
  void fill(const PixelBlock& b, const std::vector<float>& guide, int excluded_class) {
    for (int y = b.y; y < b.y + b.height; y += kPatch)
      for (int x = b.x; x < b.x + b.width; x += kPatch) patch(x / kPatch, y / kPatch) = {};
    std::size_t i = 0;
    for (int y = b.y; y < b.y + b.height; ++y) {
      for (int x = b.x; x < b.x + b.width; ++x, ++i) {
        const std::size_t at = s_.at(x, y);
        const bool is_excluded = class_of(x, y) == excluded_class;
        values_[at] =
            is_excluded || guide.empty() ? 0 : relative(s_.variance[at] * static_cast<float>(s_.samples[at]), guide[i]);
        if (is_excluded || s_.has_small_emitters(at)) continue;
        const auto v = static_cast<double>(values_[at]);
        Sums& c = patch(x / kPatch, y / kPatch);
        c.sum += v;
        c.squares += v * v;
        ++c.count;
      }
    }
  }

  /// Adds up the windows of patches of a row of patches; after the errors of all blocks are computed.
  void add_up_windows(int row) {
    for (int x = 0; x < across_; ++x) {
      const auto at = static_cast<std::size_t>(row * across_ + x);
      wide_[at] = of_patches(x, row, 1);
      if (!wide_[at].is_enough()) wide_[at] = of_patches(x, row, 4);
    }
  }
  int patch_rows() const { return down_; }

  /// The mean around a pixel of the excluded class, over the smallest window in which enough pixels contribute. If a
  /// few pixels of a wide window contribute nearly all of its error, any pixel may be another one, so the wide mean is
  /// a lower bound.
  float around(int x, int y) const {
    const Sums& wide = wide_[static_cast<std::size_t>(y / kPatch * across_ + x / kPatch)];
    if (wide.sum == 0) return 0;
    Sums narrow = within(x, y, kReach);
    if (!narrow.is_enough()) narrow = within(x, y, kWideReach);
    if (narrow.sum > 0 && !narrow.is_enough()) return wide.mean();
    return wide.is_sparse() ? std::max(narrow.mean(), wide.mean()) : narrow.mean();
  }

 private:
  Sums& patch(int x, int y) { return patches_[static_cast<std::size_t>(y * across_ + x)]; }

  Sums within(int x, int y, int reach) const {
    float sum = 0, squares = 0;
    const int x0 = std::max(x - reach, 0), x1 = std::min(x + reach, s_.width - 1);
    for (int v = std::max(y - reach, 0); v <= std::min(y + reach, s_.height - 1); ++v) {
      const float* const row = values_.data() + s_.at(0, v);
      for (int u = x0; u <= x1; ++u) {
        sum += row[u];
        squares += row[u] * row[u];
      }
    }
    const int count = window_size(x, reach, s_.width) * window_size(y, reach, s_.height) -
                      window_size(x, reach, s_.width, x % 3) * window_size(y, reach, s_.height, y % 3);
    return {static_cast<double>(sum), static_cast<double>(squares), count};
  }

  /// Sums of the patches within `reach` patches of a patch.
  Sums of_patches(int x, int y, int reach) const {
    Sums out;
    for (int v = std::max(y - reach, 0); v <= std::min(y + reach, down_ - 1); ++v) {
      for (int u = std::max(x - reach, 0); u <= std::min(x + reach, across_ - 1); ++u) {
        const Sums& c = patches_[static_cast<std::size_t>(v * across_ + u)];
        out.sum += c.sum;
        out.squares += c.squares;
        out.count += c.count;
      }
    }
    return out;
  }

  const PixelStatistics& s_;
  int across_, down_;  ///< patches
  std::vector<float> values_;
  std::vector<Sums> patches_, wide_;  ///< sums of patches, and of the windows around them
};

/// Whether a pixel's neighbours have found enough light, or can be trusted to be black.
bool has_reliable_estimate(const PixelStatistics& s, int x, int y) {
  const double n = s.samples[s.at(x, y)];
  if (n >= kSamplesForReliability) return true;
  if (needs_samples_for_emitters(s, x, y)) return false;
  double light = 0, variance = 0, samples = 0;
  int count = 0, dark = 0;
  for (int v = std::max(y - kReliabilityReach, 0); v <= std::min(y + kReliabilityReach, s.height - 1); ++v) {
    for (int u = std::max(x - kReliabilityReach, 0); u <= std::min(x + kReliabilityReach, s.width - 1); ++u) {
      if ((u - x) % 3 == 0 && (v - y) % 3 == 0) continue;  // the pixel's own class
      const std::size_t at = s.at(u, v);
      light += static_cast<double>(s.light[at]);
      variance += static_cast<double>(s.variance[at]);
      samples += s.samples[at];
      dark += s.light[at] > 0 || s.is_known_black(at) ? 0 : 1;
      ++count;
    }
  }
  if (count == 0 || n * count > 2 * samples) return true;  // its neighbours need more samples, not the pixel itself
  if (2 * dark >= count) return false;       // light next to a dark area gives no information about the area
  return light * light >= kHits * variance;  // the number of hits if all are equally bright
}

/// Whether all pixels that has_reliable_estimate() reads for a block have the same radiance in every sample. Their
/// evidence is then complete.
bool is_lit_without_noise(const PixelStatistics& s, const PixelBlock& b) {
  PixelBlock wide;
  wide.x = std::max(b.x - kReliabilityReach, 0);
  wide.y = std::max(b.y - kReliabilityReach, 0);
  wide.width = std::min(b.x + b.width + kReliabilityReach, s.width) - wide.x;
  wide.height = std::min(b.y + b.height + kReliabilityReach, s.height) - wide.y;
  if (!is_noiseless(s, wide)) return false;
  for (int y = wide.y; y < wide.y + wide.height; ++y) {
    const float* const row = s.light.data() + s.at(wide.x, y);
    if (!std::all_of(row, row + wide.width, [](float l) { return l > 0; })) return false;
  }
  return true;
}

}  // namespace

NoiseEstimate estimate_noise(const PixelStatistics& s, TilePool& pool) {
  struct Sums {
    double sum = 0, squares = 0;
  };
  const std::vector<PixelBlock> blocks = blocks_of(s.width, s.height);
  NoiseEstimate out;
  out.of_pixel.resize(s.samples.size());
  std::vector<Sums> sums(blocks.size());
  const LightGuide guide(s, kNoClass);
  run(pool, blocks.size(), [&](std::size_t i) {
    const PixelBlock& b = blocks[i];
    if (is_noiseless(s, b)) return;
    const std::vector<float> light = guide.of(b);
    std::size_t k = 0;
    for (int y = b.y; y < b.y + b.height; ++y) {
      for (int x = b.x; x < b.x + b.width; ++x, ++k) {
        // At an edge the guide may overestimate a dark pixel; the pixel's own radiance does not.
        const std::size_t at = s.at(x, y);
        out.of_pixel[at] = relative(s.variance[at], std::min(light[k], s.light[at]));
        const auto e = static_cast<double>(out.of_pixel[at]);
        sums[i].sum += e;
        sums[i].squares += e * e;
      }
    }
  });
  Sums all;
  for (const Sums& block : sums) {
    all.sum += block.sum;
    all.squares += block.squares;
  }
  const auto pixels = static_cast<double>(s.samples.size());
  out.mean_square = all.sum / pixels;
  out.standard_error = std::sqrt(all.squares) / pixels;
  return out;
}

UnreliablePixels find_unreliable_pixels(const PixelStatistics& s, TilePool& pool) {
  UnreliablePixels out;
  out.of_pixel.resize(s.samples.size());
  const std::vector<PixelBlock> blocks = blocks_of(s.width, s.height);
  run(pool, blocks.size(), [&](std::size_t i) {
    const PixelBlock& b = blocks[i];
    if (s.small_emitters.empty() && is_lit_without_noise(s, b)) return;
    for (int y = b.y; y < b.y + b.height; ++y)
      for (int x = b.x; x < b.x + b.width; ++x) out.of_pixel[s.at(x, y)] = has_reliable_estimate(s, x, y) ? 0 : 1;
  });
  for (const std::uint8_t is_missing : out.of_pixel) out.count += is_missing;
  return out;
}

std::vector<float> errors_of_one_sample(const PixelStatistics& s, const NoiseEstimate& noise, TilePool& pool) {
  double sum = 0;
  for (std::size_t i = 0; i < s.samples.size(); ++i)
    if (!s.has_small_emitters(i)) sum += static_cast<double>(noise.of_pixel[i]) * s.samples[i];
  const float least = kMinError * static_cast<float>(sum / static_cast<double>(s.samples.size()));

  std::vector<float> out(s.samples.size());
  const std::vector<PixelBlock> blocks = blocks_of(s.width, s.height);
  CrossValidatedErrors errors(s);
  std::vector<std::uint8_t> noiseless(blocks.size());
  run(pool, blocks.size(), [&](std::size_t i) { noiseless[i] = is_noiseless(s, blocks[i]) ? 1 : 0; });
  for (int own = 0; own < kClasses; ++own) {
    const LightGuide guide(s, own);
    run(pool, blocks.size(), [&](std::size_t i) {
      errors.fill(blocks[i], noiseless[i] != 0 ? std::vector<float>() : guide.of(blocks[i]), own);
    });
    run(pool, static_cast<std::size_t>(errors.patch_rows()),
        [&](std::size_t row) { errors.add_up_windows(static_cast<int>(row)); });
    run(pool, blocks.size(), [&](std::size_t i) {
      const PixelBlock& b = blocks[i];
      for (int y = b.y; y < b.y + b.height; ++y)
        for (int x = b.x; x < b.x + b.width; ++x)
          if (class_of(x, y) == own)
            out[s.at(x, y)] = std::max(errors.around(x, y), error_of_small_emitters(s, x, y)) + least;
    });
  }
  return out;
}

}  // namespace orrery::render
