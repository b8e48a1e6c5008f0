// SPDX-License-Identifier: Apache-2.0
// The angle by which a hollow ball turns light via its inner sphere, and its level sets. Compiled once per instruction
// set.
#if defined(ORRERY_KERNEL_CAUSTIC_HOLLOW_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_KERNEL_CAUSTIC_HOLLOW_INL_H_
#undef ORRERY_KERNEL_CAUSTIC_HOLLOW_INL_H_
#else
#define ORRERY_KERNEL_CAUSTIC_HOLLOW_INL_H_
#endif

#include <hwy/highway.h>

#include <limits>

#include "kernel/caustic_chain-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

// A ball of glass with a concentric void of radius q, in units of the ball's radius, adds terms to Theta (see
// caustic_chain-inl.h). A ray that the void's sphere reflects turns by
//
//     Theta(b) = 2 asin(b) - 2 asin(b / n) + 2 asin(b / (n q)) - asin(b / p) - asin(b / d),
//
// which increases in b, 0..min(1, n q); a ray that crosses the void turns by pi - 2 asin(b / q) more, in total by less
// for each larger b, 0..q. Neither is convex. But each term's derivative by j, where b is the greatest b times sin(j),
// decreases, so that the derivatives at the ends of an interval bound the slope within: a step of Newton's method with
// the bound never passes a root, and the two ends close in on the band.

/// The spheres of a hollow ball, the point and the light, in units of the greatest b.
template <class V>
struct HollowShells {
  V greatest;  ///< in units of the ball's radius
  CausticShell<V> ball, glass, inner_glass, inner, point, light;
};

/// `inner`    radius of the void
template <bool kThrough, class D, class V = hn::Vec<D>>
HWY_INLINE HollowShells<V> hollow_shells(D d, const CausticShells<V>& at, V inner) {
  const V one = set(d, 1), inverse = 1 / inner;
  const V inner_glass = at.glass.inverse * inverse;
  const V greatest = kThrough ? inner : min(1 / inner_glass, 1);
  const auto shell = [&](V of_unit) {
    const V g = min(of_unit * greatest, 1);
    return CausticShell<V>{g, (1 - g) * (1 + g)};
  };
  return {greatest,
          shell(one),
          shell(at.glass.inverse),
          shell(inner_glass),
          shell(inverse),
          shell(at.point.inverse),
          shell(at.light.inverse)};
}

/// Theta, and the derivatives by j of its increasing and of its decreasing terms.
template <class V>
struct TurnedAngle {
  V theta, rising, falling;

  /// Adds a term, `weight` times the arcsine of a shell's reciprocal radius times sin(j).
  template <class D>
  HWY_INLINE void add(D d, double weight, const CausticShell<V>& shell, SinCos<V> j) {
    const V gc = shell.inverse * j.cos, cos = hn::Sqrt(mul_add(gc, gc, shell.rest));
    theta = mul_add(angle_of(d, shell.inverse * j.sin, cos), set(d, weight), theta);
    // At grazing incidence on the smallest sphere, the derivative is 1.
    const V slope = select(cos > 0, gc / cos, 1);
    if (weight > 0)
      rising = mul_add(slope, set(d, weight), rising);
    else
      falling = neg_mul_add(slope, set(d, weight), falling);
  }
};

template <bool kThrough, class D, class V = hn::Vec<D>>
HWY_INLINE TurnedAngle<V> hollow_angle(D d, const HollowShells<V>& at, V j_turns) {
  const auto j = sin_cos_turn(d, j_turns);
  TurnedAngle<V> out = {set(d, kThrough ? kTurn / 2 : 0), hn::Zero(d), hn::Zero(d)};
  out.add(d, 2, at.ball, j);
  out.add(d, -2, at.glass, j);
  out.add(d, 2, at.inner_glass, j);
  if constexpr (kThrough) out.add(d, -2, at.inner, j);
  out.add(d, -1, at.point, j);
  out.add(d, -1, at.light, j);
  return out;
}

/// The direction of Theta without the light's term, by that of rays that are refracted into a ball without a void and
/// out of it.
template <bool kThrough, class V>
HWY_INLINE SweptAngle<V> hollow_swept(const CausticShells<V>& at, SweptAngle<V> refracted, V inner, V b) {
  const auto turn = [&](V sin, double way) {
    const V s = min(sin, 1), cos = hn::Sqrt((1 - s) * (1 + s));
    const V twice_cos = mul_add(cos, cos, -(s * s)), twice_sin = cos * s * (2 * way);
    const V turned = neg_mul_add(refracted.sin, twice_sin, refracted.cos * twice_cos);
    refracted.sin = mul_add(refracted.cos, twice_sin, refracted.sin * twice_cos);
    refracted.cos = turned;
  };
  const V to_inner = b / inner;
  turn(to_inner * at.glass.inverse, 1);
  if constexpr (kThrough)
    turn(to_inner, -1);
  else
    refracted.cos = -refracted.cos, refracted.sin = -refracted.sin;
  return refracted;
}

/// Maximum number of steps. Fewer lead to wider pieces, not to errors.
inline constexpr int kHollowSteps = 12;

/// Angles near one at which the light may lie.
template <class V>
struct AngleBand {
  V lowest, highest;
  V tolerance;  ///< ends of pieces that are less too far out stay
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE AngleBand<V> band_around(D d, V theta, V kappa) {
  constexpr double kEpsilon = std::numeric_limits<hn::TFromD<D>>::epsilon();
  const V tolerance = mul_add(kappa, set(d, 0.02), 32 * kEpsilon);
  const V width = mul_add(kappa, set(d, 1.001), 32 * kEpsilon);
  return {theta - width, theta + width, tolerance};
}

/// Places on the graph of Theta, in turns of j, between which it decreases or increases.
template <class V>
struct GraphSection {
  V first, last;
  V greatest;  ///< b at a quarter turn
};

/// Finds the values of b in a section for which Theta is in a band, or a few more.
///
/// `angle`    TurnedAngle of a place
template <bool kDecreases, class D, class Angle, class V = hn::Vec<D>>
HWY_INLINE CausticPiece<V> section_piece(D d, const Angle& angle, const GraphSection<V>& section,
                                         const AngleBand<V>& band, hn::Mask<D> lanes) {
  constexpr double kEpsilon = std::numeric_limits<hn::TFromD<D>>::epsilon();
  V first = section.first, last = section.last;
  for (int step = 0; step < kHollowSteps; ++step) {
    const TurnedAngle<V> from = angle(first), to = angle(last);
    const V before = kDecreases ? from.theta - band.highest : band.lowest - from.theta;
    const V after = kDecreases ? band.lowest - to.theta : to.theta - band.highest;
    const V steepest = kDecreases ? from.falling - to.rising : from.rising - to.falling;
    // A lane ends on its own, so that its result does not depend on the others.
    const auto open = hn::And(lanes, max(before, after) > band.tolerance);
    if (hn::AllFalse(d, open)) break;
    const V turns = hn::IfThenElseZero(open, (1 / kTurn) / max(steepest, kEpsilon));
    first = mul_add(max(before, 0), turns, first);
    last = neg_mul_add(max(after, 0), turns, last);
    lanes = hn::And(lanes, first <= last);
  }
  const auto b = [&](V turns) { return section.greatest * sin_cos_turn(d, min(max(turns, 0), 0.25)).sin; };
  return {hn::IfThenElseZero(lanes, b(first) * (1 - 8 * kEpsilon)),
          hn::IfThenElseZero(lanes, min(mul_add(b(last), set(d, 1 + 8 * kEpsilon), kEpsilon), 1))};
}

/// Finds the values of b for which Theta is in a band, or a few more.
template <bool kThrough, class D, class V = hn::Vec<D>>
HWY_INLINE CausticPiece<V> hollow_piece(D d, const HollowShells<V>& at, const AngleBand<V>& band, hn::Mask<D> lanes) {
  const auto angle = [&](V j_turns) { return hollow_angle<kThrough>(d, at, j_turns); };
  return section_piece<kThrough>(d, angle, {hn::Zero(d), set(d, 0.25), at.greatest}, band, lanes);
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
