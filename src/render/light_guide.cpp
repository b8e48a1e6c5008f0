// SPDX-License-Identifier: Apache-2.0
#include "render/light_guide.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace orrery::render {
namespace {

/// Side of a block, px. Windows extend beyond its edges, so larger blocks repeat less work; this size stays in the
/// cache.
constexpr int kBlockSide = 128;

/// Windows extend 2^1 .. 2^kRadii pixels to each side.
constexpr int kRadii = 4;
constexpr int kGuideReach = 1 << kRadii;

/// Added to squared radiance in denominators; a thousandth of white, squared.
constexpr float kNoLight = 1e-12f;

/// A block with a border of kGuideReach pixels; 0 outside the image and in the excluded class.
struct Padded {
  int width, height;
  std::vector<float> values;

  explicit Padded(const PixelBlock& b)
      : width(b.width + 2 * kGuideReach),
        height(b.height + 2 * kGuideReach),
        values(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

  float* row(int y) { return values.data() + static_cast<std::ptrdiff_t>(y) * width; }
  const float* row(int y) const { return values.data() + static_cast<std::ptrdiff_t>(y) * width; }
};

/// Sums over windows of 2^(k + 1) + 1 pixels along the rows of a padded block, of its inner columns and all its rows.
/// Sums of 2, 4, 8 .. pixels are built by pairwise addition. Nothing is subtracted, so dark pixels next to bright ones
/// keep their precision, and the order is the same everywhere.
using RowSums = std::array<std::vector<float>, kRadii>;

RowSums sums_along_rows(const Padded& p, int radii) {
  const int inner = p.width - 2 * kGuideReach;
  RowSums out;
  for (int k = 0; k < radii; ++k)
    out[static_cast<std::size_t>(k)].resize(static_cast<std::size_t>(inner) * static_cast<std::size_t>(p.height));
  std::vector<float> run(static_cast<std::size_t>(p.width));
  for (int y = 0; y < p.height; ++y) {
    const float* const in = p.row(y);
    std::copy_n(in, p.width, run.begin());
    int length = 1, end = p.width;
    for (int k = 0; k < radii; ++k) {
      for (const int wanted = 4 << k; length < wanted; length *= 2) {
        end -= length;
        for (int x = 0; x < end; ++x) run[static_cast<std::size_t>(x)] += run[static_cast<std::size_t>(x + length)];
      }
      const int radius = 2 << k;
      float* const sums = out[static_cast<std::size_t>(k)].data() + static_cast<std::ptrdiff_t>(y) * inner;
      const float* const first = run.data() + kGuideReach - radius;
      const float* const last = in + kGuideReach + radius;
      for (int x = 0; x < inner; ++x) sums[x] = first[x] + last[x];
    }
  }
  return out;
}

/// The same along the columns: sums over whole windows of the inner pixels.
std::vector<float> sums_down_columns(const std::vector<float>& rows, int width, int height, int k) {
  const int radius = 2 << k, inner = height - 2 * kGuideReach;
  const auto w = static_cast<std::ptrdiff_t>(width);
  std::vector<float> run(rows.begin() + w * (kGuideReach - radius), rows.begin() + w * (kGuideReach + radius + inner));
  std::ptrdiff_t end = inner + 2 * radius;
  for (std::ptrdiff_t length = 1; length < 2 * radius; length *= 2) {
    end -= length;
    for (std::ptrdiff_t i = 0; i < end * w; ++i)
      run[static_cast<std::size_t>(i)] += run[static_cast<std::size_t>(i + length * w)];
  }
  const float* const last = rows.data() + w * (kGuideReach + radius);
  run.resize(static_cast<std::size_t>(w * inner));
  for (std::ptrdiff_t i = 0; i < w * inner; ++i) run[static_cast<std::size_t>(i)] += last[i];
  return run;
}

}  // namespace

std::vector<PixelBlock> blocks_of(int width_px, int height_px) {
  std::vector<PixelBlock> out;
  for (int y = 0; y < height_px; y += kBlockSide)
    for (int x = 0; x < width_px; x += kBlockSide)
      out.push_back({x, y, std::min(kBlockSide, width_px - x), std::min(kBlockSide, height_px - y)});
  return out;
}

int window_size(int at, int reach, int size) { return std::min(at + reach, size - 1) - std::max(at - reach, 0) + 1; }

int window_size(int at, int reach, int size, int remainder) {
  if (remainder < 0) return 0;
  const auto below = [&](int end) { return (end - remainder + 2) / 3; };  // of 0 .. end - 1; 0 for end = 0
  return below(std::min(at + reach, size - 1) + 1) - below(std::max(at - reach, 0));
}

LightGuide::LightGuide(const PixelStatistics& statistics, int excluded_class)
    : statistics_(statistics), excluded_class_(excluded_class) {
  double sum = 0;
  std::size_t count = 0;
  for (int y = 0; y < statistics.height; ++y) {
    for (int x = 0; x < statistics.width; ++x) {
      if (class_of(x, y) == excluded_class) continue;
      sum += static_cast<double>(statistics.light[statistics.at(x, y)]);
      ++count;
    }
  }
  if (count > 0) mean_ = static_cast<float>(sum / static_cast<double>(count));
}

std::vector<float> LightGuide::of(const PixelBlock& b) const {
  const PixelStatistics& s = statistics_;
  const int excluded_x = excluded_class_ == kNoClass ? -1 : excluded_class_ % 3;
  const int excluded_y = excluded_class_ == kNoClass ? -1 : excluded_class_ / 3;

  Padded light(b), variance(b), squares(b);
  for (int y = std::max(b.y - kGuideReach, 0); y < std::min(b.y + b.height + kGuideReach, s.height); ++y) {
    const int x0 = std::max(b.x - kGuideReach, 0), x1 = std::min(b.x + b.width + kGuideReach, s.width);
    const int row = y - b.y + kGuideReach, column = x0 - b.x + kGuideReach;
    float* const l = light.row(row) + column;
    float* const v = variance.row(row) + column;
    std::copy_n(s.light.data() + s.at(x0, y), x1 - x0, l);
    std::copy_n(s.variance.data() + s.at(x0, y), x1 - x0, v);
    if (y % 3 == excluded_y)
      for (int x = x0 + (excluded_x - x0 % 3 + 3) % 3; x < x1; x += 3) l[x - x0] = v[x - x0] = 0;
    float* const square = squares.row(row) + column;
    for (int x = 0; x < x1 - x0; ++x) square[x] = l[x] * l[x];
  }

  const auto width = static_cast<std::size_t>(b.width);
  std::vector<float> guide(width * static_cast<std::size_t>(b.height), mean_);
  const RowSums light_rows = sums_along_rows(light, kRadii), variance_rows = sums_along_rows(variance, kRadii);
  std::vector<float> across(width), own_across(width);
  std::vector<float> light_sums, variance_sums, square_sums;
  const auto count_across = [&](int radius) {
    for (int x = 0; x < b.width; ++x) {
      across[static_cast<std::size_t>(x)] = static_cast<float>(window_size(b.x + x, radius, s.width));
      own_across[static_cast<std::size_t>(x)] = static_cast<float>(window_size(b.x + x, radius, s.width, excluded_x));
    }
  };
  for (int k = kRadii; k-- > 0;) {
    const int radius = 2 << k;
    const auto plane = static_cast<std::size_t>(k);
    light_sums = sums_down_columns(light_rows[plane], b.width, light.height, k);
    variance_sums = sums_down_columns(variance_rows[plane], b.width, light.height, k);
    count_across(radius);
    for (int y = 0; y < b.height; ++y) {
      const auto down = static_cast<float>(window_size(b.y + y, radius, s.height));
      const auto own_down = static_cast<float>(window_size(b.y + y, radius, s.height, excluded_y));
      const std::size_t row = static_cast<std::size_t>(y) * width;
      for (std::size_t x = 0; x < width; ++x) {
        const float share = 1 / (across[x] * down - own_across[x] * own_down);
        const float mean = light_sums[row + x] * share, noise = variance_sums[row + x] * share * share;
        float& g = guide[row + x];
        const float spread = g * g + kNoLight;
        g += (mean - g) * (spread / (spread + noise));
      }
    }
  }

  square_sums = sums_down_columns(sums_along_rows(squares, 1)[0], b.width, squares.height, 0);
  for (int y = 0; y < b.height; ++y) {  // light_sums, variance_sums and counts are those of the smallest window
    const auto down = static_cast<float>(window_size(b.y + y, 2, s.height));
    const auto own_down = static_cast<float>(window_size(b.y + y, 2, s.height, excluded_y));
    const std::size_t row = static_cast<std::size_t>(y) * width;
    const float* const own = light.row(y + kGuideReach) + kGuideReach;
    const float* const own_noise = variance.row(y + kGuideReach) + kGuideReach;
    for (std::size_t x = 0; x < width; ++x) {
      const float share = 1 / (across[x] * down - own_across[x] * own_down);
      const float mean = light_sums[row + x] * share, noise = variance_sums[row + x] * share;
      const float spread = std::max(square_sums[row + x] * share - mean * mean - noise, 0.0f);
      float& g = guide[row + x];
      g += (own[x] - g) * ((spread + kNoLight) / (spread + own_noise[x] + kNoLight));
    }
  }
  return guide;
}

}  // namespace orrery::render
