// SPDX-License-Identifier: Apache-2.0
// The angle by which a ball turns light, and its level sets. Compiled once per instruction set.
#if defined(ORRERY_KERNEL_CAUSTIC_CHAIN_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_KERNEL_CAUSTIC_CHAIN_INL_H_
#undef ORRERY_KERNEL_CAUSTIC_CHAIN_INL_H_
#else
#define ORRERY_KERNEL_CAUSTIC_CHAIN_INL_H_
#endif

#include <hwy/highway.h>

#include <limits>

#include "math/functions-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using namespace math::HWY_NAMESPACE;  // NOLINT(google-build-using-namespace): SIMD vectors of another room

// A ray keeps its impact parameter b when a concentric sphere reflects or refracts it, and stays in a plane through the
// centre C. Lengths are in units of the ball's radius, so that b = sin(i), where i is the angle of incidence on the
// ball. From a point P, at the distance p from C, to the centre of a light at the distance d, a ray that is refracted
// into the ball and out of it, with k - 1 reflections inside, turns around C by
//
//     Theta(i) = k pi + 2 i - 2 k asin(b / n) - asin(b / p) - asin(b / d)
//
// where n is the ball's index, k = 0 stands for reflection, and a sun has no last term. For n > 1, Theta is a convex
// function of i on 0..pi/2: Newton's method from outside of an interval {i: Theta(i) <= t} approaches its end
// monotonically, and a slope of the wrong sign, or an i out of range, proves that the interval is empty.

/// Radians per turn.
inline constexpr double kTurn = 4 * math::HWY_NAMESPACE::kHalfPi;

/// asin(s), radians, with the cosine sqrt(1 - s^2) computed elsewhere.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V angle_of(D d, V sin, V cos) {
  return atan2_turn(d, sin, cos) * kTurn;
}

/// A term asin(b / rho) of Theta, by the reciprocal of rho.
template <class V>
struct CausticShell {
  V inverse;  ///< g = 1 / rho; 0: none
  V rest;     ///< 1 - g^2, without cancellation
};

/// What Theta depends on.
template <class V>
struct CausticShells {
  CausticShell<V> point, light, glass;
};

/// A point of the graph of Theta.
template <class V>
struct CausticPoint {
  V sin, cos;  ///< of i
  V angle;     ///< Theta; only where approach() has computed it
  V slope;     ///< dTheta/di
};

/// The direction of Theta as a unit vector, and its derivative.
template <class V>
struct SweptAngle {
  V cos, sin, slope;
};

/// Computes e^(i Theta) by square roots alone: each term is a factor sqrt(1 - g^2 b^2) - i g b. The derivatives of the
/// terms, g cos(i) / sqrt(1 - g^2 b^2), share one division.
///
/// `kToLight` false: without the light's term, so that Theta is the direction of the ray at infinity
template <int k, bool kToLight, class D, class V = hn::Vec<D>>
HWY_INLINE SweptAngle<V> swept_angle(D d, const CausticShells<V>& at, V s, V c) {
  V x = mul_add(c, c, -(s * s)), y = s * c * 2;
  V numerator = hn::Zero(d), divisor = set(d, 1);
  const auto turn_back = [&](V cos, V sin) {
    const V turned = mul_add(x, cos, y * sin);
    y = neg_mul_add(x, sin, y * cos);
    x = turned;
  };
  const auto cosine_of = [&](const CausticShell<V>& shell, V gc) { return hn::Sqrt(mul_add(gc, gc, shell.rest)); };
  const auto add = [&](V of_numerator, V of_divisor) {
    numerator = mul_add(numerator, of_divisor, of_numerator * divisor);
    divisor = divisor * of_divisor;
  };
  const auto subtract = [&](const CausticShell<V>& shell) {
    const V gc = shell.inverse * c, cos = cosine_of(shell, gc);
    // At grazing incidence on a sphere as large as the ball, the derivative is 1.
    const auto grazes = cos <= 0;
    add(select(grazes, 1, gc), select(grazes, 1, cos));
    turn_back(cos, shell.inverse * s);
  };
  subtract(at.point);
  if constexpr (kToLight) subtract(at.light);
  if constexpr (k > 0) {
    const V gc = at.glass.inverse * c, gs = at.glass.inverse * s, cos = cosine_of(at.glass, gc);
    add(gc * (2 * k), cos);
    const V twice_cos = mul_add(cos, cos, -(gs * gs)), twice_sin = cos * gs * 2;
    for (int j = 0; j < k; ++j) turn_back(twice_cos, twice_sin);
  }
  constexpr bool kOdd = k % 2 != 0;
  return {kOdd ? -x : x, kOdd ? -y : y, 2 - numerator / divisor};
}

/// The graph's ends, i = 0 and i = pi/2.
template <class V>
struct CausticEnds {
  CausticPoint<V> normal, grazing;
};

/// Computes the ends of the graph from the angles of its terms at grazing incidence.
template <int k, class D, class V = hn::Vec<D>>
HWY_INLINE CausticEnds<V> graph_ends(D d, const CausticShells<V>& at, V asin_point, V asin_light, V asin_glass) {
  const V one = set(d, 1), zero = hn::Zero(d);
  const V grazing_slope = select(at.point.rest > 0, 2, one) - hn::IfThenElseZero(at.light.rest <= 0, one);
  return {{zero, one, set(d, k * kTurn / 2),
           neg_mul_add(at.glass.inverse, set(d, 2 * k), 2) - at.point.inverse - at.light.inverse},
          {one, zero, neg_mul_add(asin_glass, set(d, 2 * k), (k + 1) * kTurn / 2) - asin_point - asin_light,
           grazing_slope}};
}

/// Maximum number of Newton steps. Fewer lead to wider pieces, not to errors.
inline constexpr int kCausticSteps = 10;

enum class GraphSide { kRising, kFalling };

/// Moves points along one side of the graph of Theta towards the angle `target`, by Newton's method. They stay above
/// it, except for rounding. The angle that is left is taken from its sine, which is smaller, so that no step is too
/// long.
///
/// `lanes`    where {i: Theta <= target} may have elements; becomes false where it has none
/// `tolerance` of the angle: points below target + tolerance stop
/// Domain     points to the right of the interval on the rising side, to the left on the falling one
template <int k, GraphSide kSide, class D, class V = hn::Vec<D>>
HWY_INLINE void approach(D d, const CausticShells<V>& at, V target, V tolerance, hn::Mask<D>& lanes,
                         CausticPoint<V>& point) {
  const V zero = hn::Zero(d), one = set(d, 1);
  V rest = point.angle - target, bound = rest;
  auto active = hn::And(lanes, rest > 0);
  if (hn::AllFalse(d, active)) return;
  const V turns = target * (1 / kTurn);
  const auto to = sin_cos_turn(d, turns - hn::Floor(turns));
  for (int step = 0; step < kCausticSteps && !hn::AllFalse(d, active); ++step) {
    const auto towards = kSide == GraphSide::kRising ? point.slope > 0 : point.slope < 0;
    // The tangent lies below the graph: if it reaches the target beyond the range, no i does. The rotation by
    // 2 atan(x / 2), rational in sine and cosine, is shorter than x = rest / slope.
    const V steep = hn::Abs(point.slope) * 2, rest2 = rest * rest;
    const V inverse = 1 / mul_add(steep, steep, rest2);
    const V turn_cos = mul_add(steep, steep, -rest2) * inverse, turn_sin = steep * rest * inverse * 2;
    const V signed_sin = kSide == GraphSide::kRising ? turn_sin : -turn_sin;
    const V s = neg_mul_add(point.cos, signed_sin, point.sin * turn_cos);
    const V c = mul_add(point.sin, signed_sin, point.cos * turn_cos);
    const auto in_range = hn::And(hn::And(s >= 0, c >= 0), rest <= steep * 0.8);
    const auto exists = hn::And(towards, in_range);
    lanes = hn::AndNot(hn::AndNot(exists, active), lanes);
    active = hn::And(active, exists);
    const auto swept = swept_angle<k, true>(d, at, s, c);
    const V cos = mul_add(swept.cos, to.cos, swept.sin * to.sin);
    const V sin = neg_mul_add(swept.cos, to.sin, swept.sin * to.cos);
    // By convexity, no angle is above this bound. It distinguishes a rest that rounding made negative from one beyond
    // three quarters of a turn.
    const V lower = max(neg_mul_add(hn::Abs(swept.slope), turn_sin, bound), 0);
    const V near = select(sin > 0, sin, select(lower < 4.7, zero, one * 1.5));
    const V left = select(cos > 0, near, 1.5);
    bound = select(active, lower, bound);
    rest = select(active, left, rest);
    point.sin = select(active, s, point.sin);
    point.cos = select(active, c, point.cos);
    point.slope = select(active, swept.slope, point.slope);
    point.angle = select(active, target + left, point.angle);
    active = hn::And(active, rest > tolerance);
  }
}

/// Values of b from `low` to `high`; empty if low >= high.
template <class V>
struct CausticPiece {
  V low, high;
};

/// A piece that has grown by rounding errors; empty in other lanes.
template <class D, class V = hn::Vec<D>>
HWY_INLINE CausticPiece<V> grown_piece(D d, hn::Mask<D> lanes, V low, V high) {
  constexpr double kEpsilon = std::numeric_limits<hn::TFromD<D>>::epsilon();
  return {hn::IfThenElseZero(lanes, low * (1 - 8 * kEpsilon)),
          hn::IfThenElseZero(lanes, min(mul_add(high, set(d, 1 + 8 * kEpsilon), kEpsilon), 1))};
}

/// Angles near one at which the light may lie.
template <class V>
struct AngleBand {
  V lowest, highest;
  V tolerance;  ///< ends of pieces that are less too far out stay
};

/// `kappa`    half width of the band
template <class D, class V = hn::Vec<D>>
HWY_INLINE AngleBand<V> band_around(D d, V theta, V kappa) {
  constexpr double kEpsilon = std::numeric_limits<hn::TFromD<D>>::epsilon();
  // A hundredth more than the half width costs a hundredth of the samples, and saves Newton steps.
  const V tolerance = mul_add(kappa, set(d, 0.02), 32 * kEpsilon);
  const V width = mul_add(kappa, set(d, 1.001), 32 * kEpsilon);
  return {theta - width, theta + width, tolerance};
}

/// The values of b for which Theta is near one of the angles at which the light may lie: theta, 2 pi - theta,
/// 2 pi + theta, as many as k + 1. A superset: the light's image is in it. The pieces are disjoint.
template <int k, class V>
struct CausticBand {
  static constexpr int kPieces = 2 * (k + 1);
  CausticPiece<V> piece[kPieces];
};

/// Finds the band of b for a light at `theta` and a half width of `kappa`.
template <int k, class D, class V = hn::Vec<D>>
HWY_INLINE CausticBand<k, V> caustic_band(D d, const CausticShells<V>& at, const CausticEnds<V>& ends, V theta, V kappa,
                                          hn::Mask<D> lanes) {
  const V zero = hn::Zero(d), tolerance = band_around(d, theta, kappa).tolerance;
  V upper[k + 1], lower[k + 1];
  for (int j = 0; j <= k; ++j) {
    const auto near = band_around(d, j == 0 ? theta : j == 1 ? kTurn - theta : kTurn + theta, kappa);
    upper[j] = near.highest;
    lower[j] = near.lowest - tolerance;
    if (j > 0) lower[j] = max(lower[j], upper[j - 1]);
  }
  struct LevelSet {
    hn::Mask<D> exists;
    V first, last;
  };
  LevelSet within[k + 1], below[k + 1];
  CausticPoint<V> falling = ends.normal, rising = ends.grazing;
  // In descending order, so that each search starts where the one before ended.
  const auto level_set = [&](V target) {
    approach<k, GraphSide::kRising>(d, at, target, tolerance, lanes, rising);
    if constexpr (k == 0)
      lanes = hn::AndNot(zero > target, lanes);
    else
      approach<k, GraphSide::kFalling>(d, at, target, tolerance, lanes, falling);
    lanes = hn::And(lanes, falling.sin <= rising.sin);
    return LevelSet{lanes, falling.sin, rising.sin};
  };
  for (int j = k; j >= 0; --j) {
    within[j] = level_set(upper[j]);
    below[j] = level_set(lower[j]);
    // A hole must be a subset.
    const V highest = lower[j] + tolerance;
    below[j].exists = hn::And(below[j].exists, hn::And(falling.angle <= highest, rising.angle <= highest));
  }
  CausticBand<k, V> band;
  for (int j = 0; j <= k; ++j) {
    LevelSet hole = below[j];
    if (j > 0) {
      const LevelSet& inner = within[j - 1];
      const auto both = hn::And(hole.exists, inner.exists);
      const auto only = hn::AndNot(hole.exists, inner.exists);
      hole.first = select(both, min(hole.first, inner.first), select(only, inner.first, hole.first));
      hole.last = select(both, max(hole.last, inner.last), select(only, inner.last, hole.last));
      hole.exists = hn::Or(hole.exists, inner.exists);
    }
    const auto whole = grown_piece(d, within[j].exists, within[j].first, within[j].last);
    band.piece[2 * j] = {whole.low, hn::IfThenElseZero(hole.exists, hole.first)};
    band.piece[2 * j + 1] = {select(hole.exists, hole.last, whole.low), whole.high};
  }
  return band;
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
