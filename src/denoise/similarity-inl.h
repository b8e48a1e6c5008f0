// SPDX-License-Identifier: Apache-2.0
// Similarity of the patches around the pixels of a tile. Compiled once per instruction set.
#if defined(ORRERY_DENOISE_SIMILARITY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_DENOISE_SIMILARITY_INL_H_
#undef ORRERY_DENOISE_SIMILARITY_INL_H_
#else
#define ORRERY_DENOISE_SIMILARITY_INL_H_
#endif

#include <hwy/highway.h>

#include "denoise/tile_filter.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::denoise::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;

// Products and sums are not fused: otherwise, SSE4 would give different bits than AVX2.
HWY_INLINE V add_product(V sum, V a, V b) { return hn::Add(sum, hn::Mul(a, b)); }

/// (1 - x)^4 for x in 0..1, and 0 beyond: like exp(-4 x), with compact support.
HWY_INLINE V bump(D d, V x) {
  const V rest = hn::Max(hn::Zero(d), hn::Sub(hn::Set(d, 1.0F), hn::Max(hn::Zero(d), x)));
  const V squared = hn::Mul(rest, rest);
  return hn::Mul(squared, squared);
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
      const V smaller = hn::Min(here, there);
      V difference = kHalves ? hn::Zero(d) : hn::Neg(hn::Add(here, smaller));
      for (const ComparedChannel& channel : source.compared) {
        const auto step = [&](const PaddedPlane& plane) {
          return hn::Sub(hn::LoadU(d, plane.at(x, y)), hn::LoadU(d, plane.at(x + dx, y + dy)));
        };
        const V a = step(*channel.a);
        difference = add_product(difference, a, kHalves ? step(*channel.b) : a);
      }
      const V noise = add_product(hn::Set(d, kMinNoise), hn::Set(d, 2.0F), smaller);
      const V distance =
          hn::Min(hn::Set(d, kMaxDistance), hn::Max(hn::Set(d, kMinDistance), hn::Div(difference, noise)));
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
      for (std::size_t i = 1; i <= 2 * kPatchRadius; ++i) sum = hn::Add(sum, hn::LoadU(d, from + i * kDistanceStride));
      hn::StoreU(sum, d, columns + x);
    }
    for (int x = 0; x < kTileWidth; x += lanes) {
      V sum = hn::LoadU(d, columns + x);
      for (int i = 1; i <= 2 * kPatchRadius; ++i) sum = hn::Add(sum, hn::LoadU(d, columns + x + i));
      hn::Store(sum, d, out.data() + y * kTileWidth + x);
    }
  }
}

/// Converts the summed distances between each pixel of the tile and its neighbour at an offset to similarities.
HWY_INLINE void similarities(const WeightSource& source, int x0, int y0, int dx, int dy, TilePixels& sums) {
  const D d;
  constexpr float kPatchPixels = (2 * kPatchRadius + 1) * (2 * kPatchRadius + 1);
  const V scale = hn::Set(d, 1.0F / (kPatchPixels * source.tolerance));
  for (int row = 0; row < kTileHeight; ++row) {
    for (int column = 0; column < kTileWidth; column += static_cast<int>(hn::Lanes(d))) {
      const int x = x0 + column, y = y0 + row;
      float* const at = sums.data() + row * kTileWidth + column;
      V weight = bump(d, hn::Mul(hn::Load(d, at), scale));
      if (!source.guides.empty()) {
        const V here = hn::LoadU(d, source.guide_variance->at(x, y));
        const V there = hn::LoadU(d, source.guide_variance->at(x + dx, y + dy));
        V guide_distance = hn::Neg(hn::Add(here, hn::Min(here, there)));
        for (const PaddedPlane* guide : source.guides) {
          const V step = hn::Sub(hn::LoadU(d, guide->at(x, y)), hn::LoadU(d, guide->at(x + dx, y + dy)));
          guide_distance = add_product(guide_distance, step, step);
        }
        weight = hn::Mul(weight, bump(d, guide_distance));
      }
      hn::Store(hn::Mul(weight, hn::LoadU(d, source.valid->at(x + dx, y + dy))), d, at);
    }
  }
}

}  // namespace orrery::denoise::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
