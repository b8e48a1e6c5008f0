// SPDX-License-Identifier: Apache-2.0
// Elementary functions without libm, whose results depend on the processor. Compiled once per instruction set.
#if defined(ORRERY_MATH_FUNCTIONS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_MATH_FUNCTIONS_INL_H_
#undef ORRERY_MATH_FUNCTIONS_INL_H_
#else
#define ORRERY_MATH_FUNCTIONS_INL_H_
#endif

#include <hwy/highway.h>

#include "math/series.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::math::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct SinCos {
  V sin, cos;
};

/// Returns sine and cosine of 2 pi u.
///
/// Domain     0 <= u <= 1
/// Precision  double: 2.3e-16 absolute, float: 1.2e-7; test MathFunctions.SineAndCosineOfATurn
template <class D, class V = hn::Vec<D>>
HWY_INLINE SinCos<V> sin_cos_turn(D d, V u) {
  using T = hn::TFromD<D>;
  // Range reduction to the nearest multiple of 90 degrees: the remainder is exact and at most an eighth of a turn.
  const V quarters = u * hn::Set(d, T(4));
  const V q = hn::Round(quarters);
  const V r = quarters - q;
  const V r2 = r * r;
  constexpr std::size_t kTerms = sizeof(T) == 8 ? 9 : 5;
  V s = hn::Set(d, static_cast<T>(kSinQuarter[kTerms - 1]));
  V c = hn::Set(d, static_cast<T>(kCosQuarter[kTerms - 1]));
  HWY_UNROLL(8)
  for (std::size_t i = 1; i < kTerms; ++i) {
    s = hn::MulAdd(s, r2, hn::Set(d, static_cast<T>(kSinQuarter[kTerms - 1 - i])));
    c = hn::MulAdd(c, r2, hn::Set(d, static_cast<T>(kCosQuarter[kTerms - 1 - i])));
  }
  s = s * r;
  const auto is1 = q == hn::Set(d, T(1)), is2 = q == hn::Set(d, T(2)), is3 = q == hn::Set(d, T(3));
  const auto odd = hn::Or(is1, is3);
  const V sin_magnitude = hn::IfThenElse(odd, c, s);
  const V cos_magnitude = hn::IfThenElse(odd, s, c);
  return {hn::IfThenElse(hn::Or(is2, is3), hn::Neg(sin_magnitude), sin_magnitude),
          hn::IfThenElse(hn::Or(is1, is2), hn::Neg(cos_magnitude), cos_magnitude)};
}

/// Converts an integer below 2^31 (2^52 in 64-bit lanes) to floating point; exact in double, rounded in float.
template <class D, class U>
HWY_INLINE hn::Vec<D> to_real(D d, U bits) {
  if constexpr (sizeof(hn::TFromD<D>) == 8) {
    // The low bits of 2^52 + n are n: no instruction set below AVX-512 converts 64-bit integers.
    const hn::RebindToUnsigned<D> du;
    return hn::BitCast(d, hn::Or(bits, hn::Set(du, 0x4330000000000000u))) - hn::Set(d, 0x1p52);
  } else {
    const hn::RebindToSigned<D> di;
    return hn::ConvertTo(d, hn::BitCast(di, bits));
  }
}

}  // namespace orrery::math::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
