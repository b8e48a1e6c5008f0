// SPDX-License-Identifier: Apache-2.0
// Elementary functions that do not use libm, whose results depend on the processor.
#pragma once

#include <hwy/highway.h>

#include <array>

#include "math/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::math::HWY_NAMESPACE {

/// pi / 2.
inline constexpr double kHalfPi = 1.57079632679489661923;

namespace detail {
/// Returns the Taylor coefficients of sin (first = 1) or cos (first = 0) of (pi / 2) r in powers of r^2; the caller
/// multiplies the sine by r.
constexpr std::array<double, 9> quarter_series(int first) {
  std::array<double, 9> c{};
  double term = first == 1 ? kHalfPi : 1.0;
  for (int i = 0; i < 9; ++i) {
    c[static_cast<unsigned>(i)] = term;
    const int n = 2 * i + first;
    term = -term * kHalfPi * kHalfPi / ((n + 1) * (n + 2));
  }
  return c;
}

/// Returns the Taylor coefficients of atan(r) / (2 pi) in powers of r^2; the caller multiplies by r.
constexpr std::array<double, 11> atan_turn_series() {
  std::array<double, 11> c{};
  for (int i = 0; i < 11; ++i) c[static_cast<unsigned>(i)] = (i % 2 == 0 ? 1 : -1) / ((2 * i + 1) * 4 * kHalfPi);
  return c;
}
}  // namespace detail

inline constexpr std::array<double, 9> kSinQuarter = detail::quarter_series(1);
inline constexpr std::array<double, 9> kCosQuarter = detail::quarter_series(0);
inline constexpr std::array<double, 11> kAtanTurn = detail::atan_turn_series();

/// Returns the rounding error of the product of a and b, which was rounded to `product`.
///
/// Reference  dekker1971
template <class D, class V = hn::Vec<D>>
HWY_INLINE V product_error(D d, V a, V b, V product) {
#if HWY_NATIVE_FMA
  (void)d;
  return hn::MulSub(a, b, product);
#else
  using T = hn::TFromD<D>;
  const V splitter = set(d, sizeof(T) == 8 ? 0x1p27 + 1 : 0x1p12 + 1);
  const V scaled_a = a * splitter, scaled_b = b * splitter;
  const V high_a = scaled_a - (scaled_a - a), low_a = a - high_a;
  const V high_b = scaled_b - (scaled_b - b), low_b = b - high_b;
  return (((high_a * high_b - product) + high_a * low_b) + low_a * high_b) + low_a * low_b;
#endif
}

template <class V>
struct SinCos {
  V sin, cos;
};

/// Returns the sine and cosine of 2 pi u.
///
/// Domain     0 <= u <= 1
/// Precision  double: 2.3e-16 absolute, float: 1.2e-7; test MathFunctions.SineAndCosineOfATurn
template <class D, class V = hn::Vec<D>>
HWY_INLINE SinCos<V> sin_cos_turn(D d, V u) {
  using T = hn::TFromD<D>;
  // Range reduction to the nearest multiple of 90 degrees: the remainder is exact and at most an eighth of a turn.
  const V quarters = u * 4;
  const V q = hn::Round(quarters);
  const V r = quarters - q;
  const V r2 = r * r;
  constexpr std::size_t kTerms = sizeof(T) == 8 ? 9 : 5;
  V s = set(d, kSinQuarter[kTerms - 1]);
  V c = set(d, kCosQuarter[kTerms - 1]);
  HWY_UNROLL(8)
  for (std::size_t i = 1; i < kTerms; ++i) {
    s = mul_add(s, r2, kSinQuarter[kTerms - 1 - i]);
    c = mul_add(c, r2, kCosQuarter[kTerms - 1 - i]);
  }
  s = s * r;
  const auto is1 = q == 1, is2 = q == 2, is3 = q == 3;
  const auto odd = hn::Or(is1, is3);
  const V sin_magnitude = select(odd, c, s);
  const V cos_magnitude = select(odd, s, c);
  return {select(hn::Or(is2, is3), -sin_magnitude, sin_magnitude),
          select(hn::Or(is1, is2), -cos_magnitude, cos_magnitude)};
}

/// Returns the angle of the point (x, y) from the x axis towards the y axis, in turns; 0 for the origin.
///
/// Domain     the largest of x and y has a finite square and is not subnormal, or both are zero
/// Result     -1/2..1/2; the sign of a zero does not matter
/// Precision  double: 6e-17 absolute, 4e-16 relative; float: 4e-8 absolute, 2e-7 relative;
///            test MathFunctions.AngleOfAPoint
template <class D, class V = hn::Vec<D>>
HWY_INLINE V atan2_turn(D d, V y, V x) {
  using T = hn::TFromD<D>;
  const V across = hn::Abs(x), up = hn::Abs(y);
  const auto steep = up > across;
  const V a = select(steep, across, up), b = select(steep, up, across);
  // The nearest multiple of a sixteenth of a turn is subtracted before the division, by the addition theorem of the
  // tangent. The rest is at most a 32nd of a turn, where the series converges fast.
  constexpr double kTan16 = 0.41421356237309504880, kTan32 = 0.19891236737965800691, kTan3of32 = 0.66817863791929891999;
  const auto is1 = a > b * kTan32, is2 = a > b * kTan3of32;
  const V c = select(is2, 1, hn::IfThenElseZero(is1, set(d, kTan16)));
  const V base = select(is2, 0.125, hn::IfThenElseZero(is1, set(d, 0.0625)));
  const V divisor = mul_add(c, a, b);
  const V r = neg_mul_add(c, b, a) / select(divisor == 0, 1, divisor);
  const V r2 = r * r;
  constexpr std::size_t kTerms = sizeof(T) == 8 ? 11 : 5;
  V series = set(d, kAtanTurn[kTerms - 1]);
  HWY_UNROLL(10)
  for (std::size_t i = 1; i < kTerms; ++i) series = mul_add(series, r2, kAtanTurn[kTerms - 1 - i]);
  V turn = mul_add(series, r, base);
  turn = select(steep, 0.25 - turn, turn);
  turn = select(x < 0, 0.5 - turn, turn);
  return select(y < 0, -turn, turn);
}

/// Converts an integer below 2^31 (2^52 in 64-bit lanes) to floating point; exact in double, rounded in float.
template <class D, class U>
HWY_INLINE hn::Vec<D> to_real(D d, U bits) {
  if constexpr (sizeof(hn::TFromD<D>) == 8) {
    // The low bits of 2^52 + n are n: no instruction set below AVX-512 converts 64-bit integers.
    const hn::RebindToUnsigned<D> du;
    return hn::BitCast(d, hn::Or(bits, hn::Set(du, 0x4330000000000000u))) - 0x1p52;
  } else {
    const hn::RebindToSigned<D> di;
    return hn::ConvertTo(d, hn::BitCast(di, bits));
  }
}

}  // namespace orrery::math::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
