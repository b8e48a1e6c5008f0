// SPDX-License-Identifier: Apache-2.0
// The angle by which a ball turns light to points inside it, and its level sets. Compiled once per instruction set.
#if defined(ORRERY_KERNEL_CAUSTIC_INSIDE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_KERNEL_CAUSTIC_INSIDE_INL_H_
#undef ORRERY_KERNEL_CAUSTIC_INSIDE_INL_H_
#else
#define ORRERY_KERNEL_CAUSTIC_INSIDE_INL_H_
#endif

#include <hwy/highway.h>

#include "kernel/caustic_chain-inl.h"
#include "kernel/caustic_hollow-inl.h"
#include "kernel/caustic_view-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

// A ray that leaves a point P in a ball of glass at an angle alpha to the line through P and the centre has, outside
// the ball, the impact parameter b = n p sin(alpha), 0..min(1, n p): with n p for p, the geometry of a point outside.
// It is refracted out of the ball and turns by
//
//     Theta(b) =      asin(b / (n p)) - asin(b / n) + asin(b) - asin(b / d)    away from the centre: outward
//     Theta(b) = pi - asin(b / (n p)) - asin(b / n) + asin(b) - asin(b / d)    past the centre: inward
//
// The first increases. The second decreases, and if n p > 1 increases beyond a minimum. The derivatives of the terms
// decrease as those of a hollow ball do (see caustic_hollow-inl.h).

template <bool kInwards, class D, class V = hn::Vec<D>>
HWY_INLINE CausticTurn<V, 4> inside_turn(D d, const CausticView<D>& at) {
  const V greatest = min(at.distance, 1);
  // Exactly 1 where the point limits b: a rounding error would move the band.
  const V point = select(at.distance <= 1, 1, at.shells.point.inverse);
  return {greatest,
          kInwards ? kTurn / 2 : 0,
          {{kInwards ? -1 : 1, {point, (1 - point) * (1 + point)}},
           {-1, scaled_shell(at.shells.glass.inverse, greatest)},
           {1, scaled_shell(set(d, 1), greatest)},
           {-1, scaled_shell(at.shells.light.inverse, greatest)}}};
}

/// The values of b for which Theta is near the angle of the light, or a few more. Those of inward rays are disjoint.
template <class V>
struct InsideBand {
  CausticPiece<V> outward, inward[3];
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE InsideBand<V> inside_band(D d, const CausticView<D>& at, hn::Mask<D> lanes) {
  const auto outward = inside_turn<false>(d, at), inward = inside_turn<true>(d, at);
  const V zero = hn::Zero(d), quarter = set(d, 0.25);
  // The place of the minimum, by bisection. Where it is wrong, pieces are wider.
  V before = zero, least = quarter;
  for (int step = 0; step < 10; ++step) {
    const V middle = (before + least) * 0.5;
    const auto there = turned_angle(d, inward, middle);
    const auto falls = there.falling > there.rising;
    before = select(falls, middle, before);
    least = select(falls, least, middle);
  }
  const auto direct = band_around(d, at.theta, at.kappa), around = band_around(d, kTurn - at.theta, at.kappa);
  InsideBand<V> band;
  band.outward = section_piece<false>(d, outward, zero, quarter, direct, lanes);
  band.inward[0] = section_piece<true>(d, inward, zero, least, direct, lanes);
  band.inward[1] = band.inward[2] = {zero, zero};
  const auto rises = hn::And(lanes, least < 0.25);
  if (hn::AllFalse(d, rises)) return band;
  // Falling angles are at most pi, so that the light at 2 pi - theta is never nearer.
  band.inward[1] = section_piece<false>(d, inward, least, quarter, direct, rises);
  band.inward[2] = section_piece<false>(d, inward, least, quarter, around, rises);
  for (int i = 1; i < 3; ++i) band.inward[i].low = max(band.inward[i].low, band.inward[i - 1].high);
  return band;
}

/// The direction of Theta without the light's term, for rays at an angle alpha from the point's direction.
template <class D, class V = hn::Vec<D>>
HWY_INLINE SweptAngle<V> inside_swept(D d, const CausticView<D>& at, SinCos<V> alpha, V b) {
  const V inner = b * at.shells.glass.inverse;
  const V cos = hn::Sqrt((1 - b) * (1 + b)), inner_cos = hn::Sqrt((1 - inner) * (1 + inner));
  const V turn_cos = mul_add(cos, inner_cos, b * inner), turn_sin = neg_mul_add(cos, inner, b * inner_cos);
  return {neg_mul_add(alpha.sin, turn_sin, alpha.cos * turn_cos), mul_add(alpha.cos, turn_sin, alpha.sin * turn_cos),
          hn::Zero(d)};
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
