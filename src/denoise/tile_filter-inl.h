// SPDX-License-Identifier: Apache-2.0
// Weights of a tile. Compiled once per instruction set.
#if defined(ORRERY_DENOISE_TILE_FILTER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_DENOISE_TILE_FILTER_INL_H_
#undef ORRERY_DENOISE_TILE_FILTER_INL_H_
#else
#define ORRERY_DENOISE_TILE_FILTER_INL_H_
#endif

#include <hwy/highway.h>

#include "denoise/similarity-inl.h"
#include "denoise/tile_filter.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::denoise::HWY_NAMESPACE {

inline constexpr std::size_t kUnknowns = kGuides + 1;
inline constexpr std::size_t kEntries = kUnknowns * (kUnknowns + 1) / 2;

/// Added to the mean squares of albedo, normal and inverse depth in the regression: guides that vary less than this are
/// ignored.
inline constexpr float kRidges[kGuides] = {1e-2F, 1e-2F, 1e-2F, 2e-2F, 2e-2F, 2e-2F, 3e-4F};
/// Lower bound of divisors, so that pixels without valid neighbours do not divide by 0.
inline constexpr float kTiny = 1e-12F;

/// Calls `f(index, dx, dy)` for all neighbours.
template <class F>
HWY_INLINE void each_offset(int radius, F f) {
  std::size_t i = 0;
  for (int dy = -radius; dy <= radius; ++dy)
    for (int dx = -radius; dx <= radius; ++dx) f(i++, dx, dy);
}

/// Solves M z = (1, 0, ..., 0) for a symmetric positive definite M by Cholesky factorisation.
///
/// `m`        lower triangle of M, row by row; overwritten
HWY_INLINE void solve_first(D d, V (&m)[kEntries], V (&z)[kUnknowns]) {
  const auto at = [&m](std::size_t row, std::size_t column) -> V& { return m[row * (row + 1) / 2 + column]; };
  V inverse[kUnknowns];
  for (std::size_t j = 0; j < kUnknowns; ++j) {
    for (std::size_t k = 0; k < j; ++k) at(j, j) = hn::Sub(at(j, j), hn::Mul(at(j, k), at(j, k)));
    inverse[j] = hn::Div(hn::Set(d, 1.0F), hn::Sqrt(hn::Max(at(j, j), hn::Set(d, kTiny))));
    for (std::size_t i = j + 1; i < kUnknowns; ++i) {
      for (std::size_t k = 0; k < j; ++k) at(i, j) = hn::Sub(at(i, j), hn::Mul(at(i, k), at(j, k)));
      at(i, j) = hn::Mul(at(i, j), inverse[j]);
    }
  }
  for (std::size_t i = 0; i < kUnknowns; ++i) {
    z[i] = i == 0 ? hn::Set(d, 1.0F) : hn::Zero(d);
    for (std::size_t k = 0; k < i; ++k) z[i] = hn::Sub(z[i], hn::Mul(at(i, k), z[k]));
    z[i] = hn::Mul(z[i], inverse[i]);
  }
  for (std::size_t i = kUnknowns; i-- > 0;) {
    for (std::size_t k = i + 1; k < kUnknowns; ++k) z[i] = hn::Sub(z[i], hn::Mul(at(k, i), z[k]));
    z[i] = hn::Mul(z[i], inverse[i]);
  }
}

/// Normalizes the similarities of a vector of pixels to a sum of 1.
HWY_INLINE void normalize(int radius, std::size_t at, TileWeights& weights) {
  const D d;
  V sum = hn::Zero(d);
  each_offset(radius, [&](std::size_t i, int, int) { sum = hn::Add(sum, hn::Load(d, weights[i].data() + at)); });
  const V scale = hn::Div(hn::Set(d, 1.0F), hn::Max(sum, hn::Set(d, kTiny)));
  each_offset(radius, [&](std::size_t i, int, int) {
    float* const weight = weights[i].data() + at;
    hn::Store(hn::Mul(hn::Load(d, weight), scale), d, weight);
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
    return hn::Sub(hn::LoadU(d, source.guides[guide]->at(x + dx, y + dy)), center[guide]);
  };
  for (std::size_t g = 0; g < kGuides; ++g) center[g] = hn::LoadU(d, source.guides[g]->at(x, y));
  for (V& v : m) v = hn::Zero(d);
  each_offset(source.radius, [&](std::size_t i, int dx, int dy) {
    const V similarity = hn::Load(d, weights[i].data() + at);
    V guides[kGuides];
    for (std::size_t g = 0; g < kGuides; ++g) guides[g] = relative(g, dx, dy);
    m[0] = hn::Add(m[0], similarity);
    std::size_t entry = 1;
    for (std::size_t row = 0; row < kGuides; ++row) {
      const V weighted = hn::Mul(similarity, guides[row]);
      m[entry] = hn::Add(m[entry], weighted);
      ++entry;
      for (std::size_t column = 0; column <= row; ++column, ++entry)
        m[entry] = add_product(m[entry], weighted, guides[column]);
    }
  });
  const V total = hn::Max(m[0], hn::Set(d, kTiny));
  for (std::size_t i = 1; i < kUnknowns; ++i)
    m[i * (i + 1) / 2 + i] = add_product(m[i * (i + 1) / 2 + i], hn::Set(d, kRidges[i - 1]), total);
  solve_first(d, m, z);

  const V of_total = hn::Div(hn::Set(d, 1.0F), total);
  V fit[3], mean[3];
  for (std::size_t c = 0; c < 3; ++c) fit[c] = mean[c] = hn::Zero(d);
  HWY_ALIGN float means[kOffsets][kMaxLanes];
  each_offset(source.radius, [&](std::size_t i, int dx, int dy) {
    float* const weight = weights[i].data() + at;
    V factor = z[0];
    for (std::size_t g = 0; g < kGuides; ++g) factor = add_product(factor, z[g + 1], relative(g, dx, dy));
    const V similarity = hn::Load(d, weight);
    const V of_fit = hn::Mul(similarity, factor), of_mean = hn::Mul(similarity, of_total);
    hn::Store(of_fit, d, weight);
    hn::Store(of_mean, d, means[i]);
    for (std::size_t c = 0; c < 3; ++c) {
      const V value = hn::LoadU(d, source.target[c]->at(x + dx, y + dy));
      fit[c] = add_product(fit[c], of_fit, value);
      mean[c] = add_product(mean[c], of_mean, value);
    }
  });
  // The largest blend factor from the weighted mean to the regression at which no channel is negative.
  const V one = hn::Set(d, 1.0F);
  V fraction = one;
  for (std::size_t c = 0; c < 3; ++c) {
    const V limit = hn::Div(mean[c], hn::Max(hn::Sub(mean[c], fit[c]), hn::Set(d, 1e-30F)));
    fraction = hn::IfThenElse(hn::Lt(fit[c], hn::Zero(d)), hn::Min(fraction, limit), fraction);
  }
  fraction = hn::Max(fraction, hn::Zero(d));
  if (hn::AllTrue(d, hn::Ge(fraction, one))) return;
  each_offset(source.radius, [&](std::size_t i, int, int) {
    float* const weight = weights[i].data() + at;
    const V of_mean = hn::Load(d, means[i]), of_fit = hn::Load(d, weight);
    const V blend = add_product(of_mean, fraction, hn::Sub(of_fit, of_mean));
    hn::Store(hn::IfThenElse(hn::Lt(fraction, one), blend, of_fit), d, weight);
  });
}

void compute_tile_weights(const WeightSource& source, int x, int y, TileScratch& scratch, TileWeights& out) {
  out.resize(static_cast<std::size_t>((2 * source.radius + 1) * (2 * source.radius + 1)));
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

void apply_tile_weights(const TileWeights& weights, int radius, const PaddedPlane& plane, int x, int y,
                        TilePixels& out) {
  const D d;
  for (int row = 0; row < kTileHeight; ++row) {
    for (int column = 0; column < kTileWidth; column += static_cast<int>(hn::Lanes(d))) {
      const auto at = static_cast<std::size_t>(row * kTileWidth + column);
      V sum = hn::Zero(d);
      each_offset(radius, [&](std::size_t i, int dx, int dy) {
        const V value = hn::LoadU(d, plane.at(x + column + dx, y + row + dy));
        sum = add_product(sum, hn::Load(d, weights[i].data() + at), value);
      });
      hn::Store(sum, d, out.data() + at);
    }
  }
}

}  // namespace orrery::denoise::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
