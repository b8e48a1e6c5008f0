// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

namespace orrery::kernel {

/// A pixel's coordinates within the rendered window, px.
struct PixelPlace {
  int x, y;
};

__extension__ using Int128 = __int128;

/// The sum of a pixel's samples in fixed point (units of 2^-60), so that the order of addition changes no bit.
///
/// A floating-point sum depends on the order, and with it on threads, tiles, shards and resumption; an integer sum does
/// not. A sum is less than 2^67: each of two halves has up to 2^31 samples of at most kLargestSample, which add up to
/// 2^66.
struct PixelSum {
  /// Aligned to four bytes, so that no pixel is padded.
  typedef Int128 Sum __attribute__((aligned(4)));

  Sum rgb[3] = {0, 0, 0};
  std::uint32_t weight = 0;  ///< number of valid samples: of both halves, less than 2^32

  PixelSum& operator+=(const PixelSum& other) noexcept {
    for (int c = 0; c < 3; ++c) rgb[c] += other.rgb[c];
    weight += other.weight;
    return *this;
  }
};

/// Maximum valid sample: 2^31 larger ones could overflow the sum.
inline constexpr double kLargestSample = 0x1p35;

/// True if a sample is finite and small enough for the sums.
inline bool is_valid_sample(double r, double g, double b) noexcept {
  return std::abs(r) <= kLargestSample && std::abs(g) <= kLargestSample && std::abs(b) <= kLargestSample;
}

/// Converts to units of 2^-60, truncating; exact above 2^-8.
///
/// Domain     |value| <= kLargestSample
inline Int128 to_fixed_point(double value) noexcept {
  if (std::abs(value) < 4) return static_cast<std::int64_t>(value * 0x1p60);  // the common case stays in 64 bits
  const auto whole = static_cast<std::int64_t>(value);
  return (static_cast<Int128>(whole) * (std::int64_t{1} << 60)) +
         static_cast<std::int64_t>((value - static_cast<double>(whole)) * 0x1p60);
}

/// Converts back to the nearest double: one rounding to 53 bits and an exact scaling.
inline double from_fixed_point(Int128 sum) noexcept { return static_cast<double>(sum) * 0x1p-60; }

static_assert(sizeof(PixelSum) == 52);

/// Sums of a pixel's denoiser guides over its paths, in fixed point like PixelSum.
struct GuideSum {
  /// Reciprocal distances of the first hits from the ray origins, 1 / scene units, in units of 2^-60; 0 for a miss.
  PixelSum::Sum inverse_depth = 0;
  std::int64_t weight = 0;  ///< number of paths, including those with bad samples
  /// The albedo of the first non-delta surface times the throughput before it, and the surface's unit normal facing the
  /// ray in world space, in units of kGuideUnit. A path that leaves the scene adds the background's radiance, clamped
  /// to 1, and no normal.
  std::int64_t albedo[3] = {0, 0, 0}, normal[3] = {0, 0, 0};

  GuideSum& operator+=(const GuideSum& other) noexcept {
    inverse_depth += other.inverse_depth;
    weight += other.weight;
    for (int k = 0; k < 3; ++k) {
      albedo[k] += other.albedo[k];
      normal[k] += other.normal[k];
    }
    return *this;
  }
};

static_assert(sizeof(GuideSum) == 72);

/// Fixed-point unit: 32 bits hold the guides of a path, 64 bits the sums over 2^31 paths.
inline constexpr double kGuideUnit = 0x1p-30;

/// Upper bound of reciprocal distances: a camera can be arbitrarily close to a surface.
inline constexpr double kLargestInverseDepth = 0x1p28;

}  // namespace orrery::kernel
