// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

namespace orrery::kernel {

__extension__ using Int128 = __int128;

/// Samples of one pixel, added up in fixed point (units of 2^-60), so that no order of adding changes a bit.
///
/// A sum of floating-point numbers depends on its order, and with it on threads, tiles, shards and resumption; a sum
/// of integers does not. 2^67 is the largest sum: 2^31 samples of at most kLargestSample.
struct PixelSum {
  Int128 rgb[3] = {0, 0, 0};
  std::int64_t weight = 0;  ///< of all samples, those left out apart: 1 each, but for PixelFilter's negative ones

  PixelSum& operator+=(const PixelSum& other) noexcept {
    for (int c = 0; c < 3; ++c) rgb[c] += other.rgb[c];
    weight += other.weight;
    return *this;
  }
};

/// A sample above this is counted as bad: it would not leave room for 2^31 of its kind.
inline constexpr double kLargestSample = 0x1p35;

/// The sample in units of 2^-60, cut towards zero; exact above 2^-8.
///
/// Domain     |value| <= kLargestSample
inline Int128 to_fixed_point(double value) noexcept {
  if (std::abs(value) < 4) return static_cast<std::int64_t>(value * 0x1p60);  // the common case stays in 64 bits
  const auto whole = static_cast<std::int64_t>(value);
  return (static_cast<Int128>(whole) * (std::int64_t{1} << 60)) +
         static_cast<std::int64_t>((value - static_cast<double>(whole)) * 0x1p60);
}

/// The nearest double, after one rounding to 53 bits and the exact scaling.
inline double from_fixed_point(Int128 sum) noexcept { return static_cast<double>(sum) * 0x1p-60; }

}  // namespace orrery::kernel
