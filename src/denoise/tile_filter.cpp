// SPDX-License-Identifier: Apache-2.0
#include "denoise/tile_filter.h"

#include <hwy/highway.h>

#include <cstddef>

#include "math/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::denoise::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace math::HWY_NAMESPACE;  // NOLINT(google-build-using-namespace): SIMD vectors of another room
using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;

// No multiply-add in this file is fused: otherwise, SSE4 would give different bits than AVX2.

/// (1 - x)^4 for x in 0..1, and 0 beyond: like exp(-4 x), with compact support.
HWY_INLINE V bump(V x) {
  const V rest = max(0, 1 - max(0, x)), squared = rest * rest;
  return squared * squared;
}

inline constexpr int kHaloWidth = kTileWidth + 2 * kPatchRadius, kHaloHeight = kTileHeight + 2 * kPatchRadius;
inline constexpr std::size_t kDistanceStride = kHaloWidth + kMaxLanes;

/// Squared difference of each pixel of the tile, and of its halo, to the pixel at an offset, in units of the variance.
///
/// The product of the differences in two independent halves is an unbiased estimate of the squared difference. Without
/// halves, the expected contribution of noise is subtracted. The variance is twice the smaller of the two pixels', so
/// that a pixel with little noise, for instance in a shadow, takes no light from a different, noisy neighbour.
///
/// Negative products, which are pure noise, are clamped: a single large one would cancel the differences of the whole
/// patch.
template <bool kHalves>
HWY_INLINE void pixel_distances(const WeightSource& source, int x0, int y0, int dx, int dy, float* out) {
  const D d;
  constexpr float kMinNoise = 1e-30F, kMaxDistance = 1e6F, kMinDistance = -3;
  for (int row = 0; row < kHaloHeight; ++row) {
    const int y = y0 + row - kPatchRadius;
    for (int column = 0; column < kHaloWidth; column += static_cast<int>(hn::Lanes(d))) {
      const int x = x0 + column - kPatchRadius;
      const V here = hn::LoadU(d, source.variance->at(x, y));
      const V there = hn::LoadU(d, source.variance->at(x + dx, y + dy));
      const V smaller = min(here, there);
      V difference = kHalves ? hn::Zero(d) : -(here + smaller);
      for (const ComparedChannel& channel : source.compared) {
        const auto step = [&](const PaddedPlane& plane) {
          return hn::LoadU(d, plane.at(x, y)) - hn::LoadU(d, plane.at(x + dx, y + dy));
        };
        const V a = step(*channel.a);
        difference = difference + a * (kHalves ? step(*channel.b) : a);
      }
      const V distance = min(kMaxDistance, max(kMinDistance, difference / (kMinNoise + 2 * smaller)));
      hn::StoreU(distance, d, out + static_cast<std::size_t>(row) * kDistanceStride + column);
    }
  }
}

/// Sums the distances over the patch of each pixel.
HWY_INLINE void patch_sums(const float* distances, float* columns, TilePixels& out) {
  const D d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  for (int y = 0; y < kTileHeight; ++y) {
    for (int x = 0; x < kHaloWidth; x += lanes) {
      const float* const from = distances + static_cast<std::size_t>(y) * kDistanceStride + x;
      V sum = hn::LoadU(d, from);
      for (std::size_t i = 1; i <= 2 * kPatchRadius; ++i) sum = sum + hn::LoadU(d, from + i * kDistanceStride);
      hn::StoreU(sum, d, columns + x);
    }
    for (int x = 0; x < kTileWidth; x += lanes) {
      V sum = hn::LoadU(d, columns + x);
      for (int i = 1; i <= 2 * kPatchRadius; ++i) sum = sum + hn::LoadU(d, columns + x + i);
      hn::Store(sum, d, out.data() + y * kTileWidth + x);
    }
  }
}

/// Converts the summed distances between each pixel of the tile and its neighbour at an offset to similarities.
HWY_INLINE void similarities(const WeightSource& source, int x0, int y0, int dx, int dy, TilePixels& sums) {
  const D d;
  constexpr float kPatchPixels = (2 * kPatchRadius + 1) * (2 * kPatchRadius + 1);
  const float scale = 1.0F / (kPatchPixels * source.tolerance);
  for (int row = 0; row < kTileHeight; ++row) {
    for (int column = 0; column < kTileWidth; column += static_cast<int>(hn::Lanes(d))) {
      const int x = x0 + column, y = y0 + row;
      float* const at = sums.data() + row * kTileWidth + column;
      V weight = bump(hn::Load(d, at) * scale);
      if (!source.guides.empty() && !hn::AllFalse(d, weight > 0)) {
        const V here = hn::LoadU(d, source.guide_variance->at(x, y));
        const V there = hn::LoadU(d, source.guide_variance->at(x + dx, y + dy));
        V guide_distance = -(here + min(here, there));
        for (const PaddedPlane* guide : source.guides) {
          const V step = hn::LoadU(d, guide->at(x, y)) - hn::LoadU(d, guide->at(x + dx, y + dy));
          guide_distance = guide_distance + step * step;
        }
        weight = weight * bump(guide_distance);
      }
      hn::Store(weight * hn::LoadU(d, source.valid->at(x + dx, y + dy)), d, at);
    }
  }
}

inline constexpr std::size_t kUnknowns = kGuides + 1;
inline constexpr std::size_t kEntries = kUnknowns * (kUnknowns + 1) / 2;

/// Added to the mean squares of albedo, normal and inverse depth in the regression: guides that vary less than this are
/// ignored.
inline constexpr float kRidges[kGuides] = {2.5e-3F, 2.5e-3F, 2.5e-3F, 5e-3F, 5e-3F, 5e-3F, 0.75e-4F};
/// Lower bound of divisors, so that pixels without valid neighbours do not divide by 0.
inline constexpr float kTiny = 1e-12F;

/// Calls `f(index, dx, dy)` for all neighbours.
template <class F>
HWY_INLINE void each_offset(int radius, F f) {
  std::size_t i = 0;
  for (int dy = -radius; dy <= radius; ++dy)
    for (int dx = -radius; dx <= radius; ++dx)
      if (is_neighbor(radius, dx, dy)) f(i++, dx, dy);
}

/// Solves M z = (1, 0, ..., 0) for a symmetric positive definite M by Cholesky factorisation.
///
/// `m`        lower triangle of M, row by row; overwritten
HWY_INLINE void solve_first(D d, V (&m)[kEntries], V (&z)[kUnknowns]) {
  const auto at = [&m](std::size_t row, std::size_t column) -> V& { return m[row * (row + 1) / 2 + column]; };
  V inverse[kUnknowns];
  for (std::size_t j = 0; j < kUnknowns; ++j) {
    for (std::size_t k = 0; k < j; ++k) at(j, j) = at(j, j) - at(j, k) * at(j, k);
    inverse[j] = 1 / hn::Sqrt(max(at(j, j), kTiny));
    for (std::size_t i = j + 1; i < kUnknowns; ++i) {
      for (std::size_t k = 0; k < j; ++k) at(i, j) = at(i, j) - at(i, k) * at(j, k);
      at(i, j) = at(i, j) * inverse[j];
    }
  }
  for (std::size_t i = 0; i < kUnknowns; ++i) {
    z[i] = set(d, i == 0 ? 1 : 0);
    for (std::size_t k = 0; k < i; ++k) z[i] = z[i] - at(i, k) * z[k];
    z[i] = z[i] * inverse[i];
  }
  for (std::size_t i = kUnknowns; i-- > 0;) {
    for (std::size_t k = i + 1; k < kUnknowns; ++k) z[i] = z[i] - at(k, i) * z[k];
    z[i] = z[i] * inverse[i];
  }
}

/// Normalizes the similarities of a vector of pixels to a sum of 1.
HWY_INLINE void normalize(int radius, std::size_t at, TileWeights& weights) {
  const D d;
  V sum = hn::Zero(d);
  each_offset(radius, [&](std::size_t i, int, int) { sum = sum + hn::Load(d, weights[i].data() + at); });
  const V scale = 1 / max(sum, kTiny);
  each_offset(radius, [&](std::size_t i, int, int) {
    float* const weight = weights[i].data() + at;
    hn::Store(hn::Load(d, weight) * scale, d, weight);
  });
}

/// Replaces the similarities of a vector of pixels by the weights of a regression.
///
/// The value at the pixel of the linear function of the guides that fits the neighbours best is z X^T W y, where X
/// holds the neighbours' guides relative to the pixel's, W the similarities, y the values, and X^T W X z = (1, 0, ...,
/// 0). The weights z X^T W do not depend on y: one matrix serves all layers.
HWY_INLINE void regress(const WeightSource& source, int x, int y, std::size_t at, TileWeights& weights) {
  const D d;
  V center[kGuides], m[kEntries], z[kUnknowns];
  const auto relative = [&](std::size_t guide, int dx, int dy) {
    return hn::LoadU(d, source.guides[guide]->at(x + dx, y + dy)) - center[guide];
  };
  for (std::size_t g = 0; g < kGuides; ++g) center[g] = hn::LoadU(d, source.guides[g]->at(x, y));
  for (V& v : m) v = hn::Zero(d);
  each_offset(source.radius, [&](std::size_t i, int dx, int dy) {
    const V similarity = hn::Load(d, weights[i].data() + at);
    if (hn::AllFalse(d, similarity > 0)) return;  // saves time, no bits
    V guides[kGuides];
    for (std::size_t g = 0; g < kGuides; ++g) guides[g] = relative(g, dx, dy);
    m[0] = m[0] + similarity;
    std::size_t entry = 1;
    for (std::size_t row = 0; row < kGuides; ++row) {
      const V weighted = similarity * guides[row];
      m[entry] = m[entry] + weighted;
      ++entry;
      for (std::size_t column = 0; column <= row; ++column, ++entry) m[entry] = m[entry] + weighted * guides[column];
    }
  });
  const V total = max(m[0], kTiny);
  for (std::size_t i = 1; i < kUnknowns; ++i) {
    V& diagonal = m[i * (i + 1) / 2 + i];
    diagonal = diagonal + kRidges[i - 1] * total;
  }
  solve_first(d, m, z);

  const V of_total = 1 / total;
  V fit[3], mean[3];
  for (std::size_t c = 0; c < 3; ++c) fit[c] = mean[c] = hn::Zero(d);
  HWY_ALIGN float means[neighbors(kWindowRadius)][kMaxLanes];
  each_offset(source.radius, [&](std::size_t i, int dx, int dy) {
    float* const weight = weights[i].data() + at;
    const V similarity = hn::Load(d, weight);
    if (hn::AllFalse(d, similarity > 0)) return hn::Store(similarity, d, means[i]);
    V factor = z[0];
    for (std::size_t g = 0; g < kGuides; ++g) factor = factor + z[g + 1] * relative(g, dx, dy);
    const V of_fit = similarity * factor, of_mean = similarity * of_total;
    hn::Store(of_fit, d, weight);
    hn::Store(of_mean, d, means[i]);
    for (std::size_t c = 0; c < 3; ++c) {
      const V value = hn::LoadU(d, source.target[c]->at(x + dx, y + dy));
      fit[c] = fit[c] + of_fit * value;
      mean[c] = mean[c] + of_mean * value;
    }
  });
  // The largest blend factor from the weighted mean to the regression at which no channel is negative.
  V fraction = hn::Set(d, 1.0F);
  for (std::size_t c = 0; c < 3; ++c)
    fraction = select(fit[c] < 0, min(fraction, mean[c] / max(mean[c] - fit[c], 1e-30F)), fraction);
  fraction = max(fraction, 0);
  if (hn::AllTrue(d, fraction >= 1)) return;
  each_offset(source.radius, [&](std::size_t i, int, int) {
    float* const weight = weights[i].data() + at;
    const V of_mean = hn::Load(d, means[i]), of_fit = hn::Load(d, weight);
    hn::Store(select(fraction < 1, of_mean + fraction * (of_fit - of_mean), of_fit), d, weight);
  });
}

}  // namespace

void compute_weights(const WeightSource& source, int x, int y, TileScratch& scratch, TileWeights& out) {
  out.resize(neighbors(source.radius));
  scratch.distances.resize(kDistanceStride * kHaloHeight);
  scratch.columns.resize(kDistanceStride);
  const bool has_halves = source.compared.front().a != source.compared.front().b;
  each_offset(source.radius, [&](std::size_t i, int dx, int dy) {
    (has_halves ? pixel_distances<true> : pixel_distances<false>)(source, x, y, dx, dy, scratch.distances.data());
    patch_sums(scratch.distances.data(), scratch.columns.data(), out[i]);
    similarities(source, x, y, dx, dy, out[i]);
  });
  for (int row = 0; row < kTileHeight; ++row) {
    for (int column = 0; column < kTileWidth; column += static_cast<int>(hn::Lanes(D()))) {
      const auto at = static_cast<std::size_t>(row * kTileWidth + column);
      if (source.has_regression) {
        regress(source, x + column, y + row, at, out);
      } else {
        normalize(source.radius, at, out);
      }
    }
  }
}

void apply_weights(const TileWeights& weights, int radius, const PaddedPlane& plane, int x, int y, TilePixels& out) {
  const D d;
  for (int row = 0; row < kTileHeight; ++row) {
    for (int column = 0; column < kTileWidth; column += static_cast<int>(hn::Lanes(d))) {
      const auto at = static_cast<std::size_t>(row * kTileWidth + column);
      V sum = hn::Zero(d);
      each_offset(radius, [&](std::size_t i, int dx, int dy) {
        const V value = hn::LoadU(d, plane.at(x + column + dx, y + row + dy));
        sum = sum + hn::Load(d, weights[i].data() + at) * value;
      });
      hn::Store(sum, d, out.data() + at);
    }
  }
}

}  // namespace orrery::denoise::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
