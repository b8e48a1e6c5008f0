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

/// Theta as a sum of terms, each `weight` times the arcsine of a shell's reciprocal radius times sin(j). Radii are in
/// units of the greatest b.
template <class V, int kTerms>
struct CausticTurn {
  struct Term {
    int weight;
    CausticShell<V> shell;
  };
  V greatest;    ///< in units of the ball's radius
  double start;  ///< Theta without terms, radians
  Term terms[kTerms];
};

/// A shell in units of the greatest b, by its reciprocal radius in those of the ball's radius.
template <class V>
HWY_INLINE CausticShell<V> scaled_shell(V inverse, V greatest) {
  const V g = min(inverse * greatest, 1);
  return {g, (1 - g) * (1 + g)};
}

/// `inner`    radius of the void
template <bool kThrough, class D, class V = hn::Vec<D>>
HWY_INLINE auto hollow_turn(D d, const CausticShells<V>& at, V inner) {
  const V one = set(d, 1), inverse = 1 / inner;
  const V inner_glass = at.glass.inverse * inverse;
  const V greatest = kThrough ? inner : min(1 / inner_glass, 1);
  const auto shell = [&](V of_unit) { return scaled_shell(of_unit, greatest); };
  const auto ball = shell(one), glass = shell(at.glass.inverse), of_inner = shell(inner_glass),
             point = shell(at.point.inverse), light = shell(at.light.inverse);
  if constexpr (kThrough)
    return CausticTurn<V, 6>{
        greatest, kTurn / 2, {{2, ball}, {-2, glass}, {2, of_inner}, {-2, shell(inverse)}, {-1, point}, {-1, light}}};
  else
    return CausticTurn<V, 5>{greatest, 0, {{2, ball}, {-2, glass}, {2, of_inner}, {-1, point}, {-1, light}}};
}

/// Theta, and the derivatives by j of its increasing and of its decreasing terms.
template <class V>
struct TurnedAngle {
  V theta, rising, falling;
};

template <int kTerms, class D, class V = hn::Vec<D>>
HWY_INLINE TurnedAngle<V> turned_angle(D d, const CausticTurn<V, kTerms>& turn, V j_turns) {
  const auto j = sin_cos_turn(d, j_turns);
  TurnedAngle<V> out = {set(d, turn.start), hn::Zero(d), hn::Zero(d)};
  HWY_UNROLL(6)
  for (const auto& [weight, shell] : turn.terms) {
    const V gc = shell.inverse * j.cos, cos = hn::Sqrt(mul_add(gc, gc, shell.rest));
    out.theta = mul_add(angle_of(d, shell.inverse * j.sin, cos), set(d, weight), out.theta);
    // At grazing incidence on the smallest sphere, the derivative is 1.
    const V slope = select(cos > 0, gc / cos, 1);
    if (weight > 0)
      out.rising = mul_add(slope, set(d, weight), out.rising);
    else
      out.falling = neg_mul_add(slope, set(d, weight), out.falling);
  }
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

/// Finds the values of b for which Theta is in a band, or a few more, where it decreases or increases.
///
/// `first`, `last`  turns of j between which it does
template <bool kDecreases, int kTerms, class D, class V = hn::Vec<D>>
HWY_INLINE CausticPiece<V> section_piece(D d, const CausticTurn<V, kTerms>& turn, V first, V last,
                                         const AngleBand<V>& band, hn::Mask<D> lanes) {
  constexpr double kEpsilon = std::numeric_limits<hn::TFromD<D>>::epsilon();
  for (int step = 0; step < kHollowSteps; ++step) {
    const TurnedAngle<V> from = turned_angle(d, turn, first), to = turned_angle(d, turn, last);
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
  const auto b = [&](V turns) { return turn.greatest * sin_cos_turn(d, min(max(turns, 0), 0.25)).sin; };
  return grown_piece(d, lanes, b(first), b(last));
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
