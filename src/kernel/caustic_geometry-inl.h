// SPDX-License-Identifier: Apache-2.0
// Geometry of caustics: the angle by which a ball turns light, and the rays for which it reaches a light.
#pragma once

#include <hwy/highway.h>

#include <limits>

#include "math/functions-inl.h"
#include "math/vec3-inl.h"

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

/// A ball and a light as they appear from points, one per lane.
template <class D>
struct BallAndLight {
  using V = hn::Vec<D>;
  Vec3<V> from_center;  ///< from the ball's centre to the point, in units of its radius
  Vec3<V> to_light;     ///< unit, from the ball's centre
  V inverse_distance;   ///< 1 / distance of the light's centre, in units of the ball's radius; 0: a sun
  V light_sin;          ///< sine of the half angle that the light subtends at the ball's centre
  V eta;                ///< index of the glass
  V r0;                 ///< Schlick's constant of the glass
  V inner;              ///< radius of the void of a hollow ball, in units of the ball's radius; else any
  hn::Mask<D> is_glass, is_hollow;
};

/// The values that the images of a light depend on.
template <class D>
struct CausticView {
  using V = hn::Vec<D>;
  CausticShells<V> shells;
  V distance;          ///< of the point; for one in the ball, times the index: b by the sine of the angle to e1
  Vec3<V> e1, e2, e3;  ///< from the centre to the point; towards the light, perpendicular to e1; their product
  V sin, cos;          ///< of the angle between point and light at the centre
  V theta, kappa;      ///< that angle; half width of the band of Theta, radians
  V light_sin;
  V asin_point, asin_light, asin_glass;
  hn::Mask<D> is_inside;  ///< the point is in the ball
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE CausticView<D> caustic_view(D d, const BallAndLight<D>& from) {
  constexpr double kEpsilon = std::numeric_limits<hn::TFromD<D>>::epsilon();
  CausticView<D> at;
  const V p2 = dot(from.from_center, from.from_center);
  at.is_inside = p2 < 1 - 4 * kEpsilon;  // points that touch the ball are outside
  at.distance = select(at.is_inside, hn::Sqrt(p2) * from.eta, max(hn::Sqrt(p2), 1));
  const V inverse = 1 / at.distance, eta_inverse = 1 / from.eta, g = from.inverse_distance;
  at.shells.point = {inverse, max(p2 - 1, 0) * (inverse * inverse)};
  at.shells.light = {g, (1 - g) * (1 + g)};
  at.shells.glass = {eta_inverse, (1 - eta_inverse) * (1 + eta_inverse)};
  at.e1 = normalized(from.from_center);
  const auto& a = at.e1;
  const auto& b = from.to_light;
  const Vec3<V> across = {neg_mul_add(a.z, b.y, a.y * b.z), neg_mul_add(a.x, b.z, a.z * b.x),
                          neg_mul_add(a.y, b.x, a.x * b.y)};
  at.cos = dot(a, b);
  at.sin = hn::Sqrt(dot(across, across));
  // Near the axis, where the product is a rounding error, any plane will do.
  at.e3 = select(at.sin > 64 * kEpsilon, normalized(neg_mul_add(a, dot(a, across), across)), frame_around(d, a).x);
  at.e2 = {neg_mul_add(at.e3.z, a.y, at.e3.y * a.z), neg_mul_add(at.e3.x, a.z, at.e3.z * a.x),
           neg_mul_add(at.e3.y, a.x, at.e3.x * a.y)};
  at.theta = angle_of(d, at.sin, at.cos);
  at.light_sin = mul_add(from.light_sin, set(d, 1 + 8 * kEpsilon), 8 * kEpsilon);
  at.asin_point = angle_of(d, inverse, hn::Sqrt(at.shells.point.rest));
  const V cos_light = hn::Sqrt(max(at.shells.light.rest, 0));
  at.asin_light = angle_of(d, g, cos_light);
  at.asin_glass = angle_of(d, eta_inverse, hn::Sqrt(at.shells.glass.rest));
  // The ray ends at most the light's radius from the light's centre: for each b, Theta is within
  // asin((b + r) / d) - asin(b / d) of the centre's angle, which is largest for b = 1.
  const V reach = g + from.light_sin;
  const V cos_reach = hn::Sqrt(max((1 - reach) * (1 + reach), 0));
  at.kappa = max(angle_of(d, min(reach, 1), cos_reach) - at.asin_light, 0);
  return at;
}

/// The range of azimuth around e1 in which rays with one impact parameter hit the light.
template <class V, class M>
struct AzimuthRange {
  V versine;     ///< 1 - cos of half the range, 0..2; 0: none
  M is_flipped;  ///< the range is centred on the side away from the light
};

/// Computes the range in closed form. At the azimuth phi, the ray leaves in the plane at the angle `swept`, and its
/// squared distance from the light's centre is a parabola in cos(phi), known at 0 and pi. If it is within the light at
/// both, it is within the light everywhere.
template <class D, class V = hn::Vec<D>>
HWY_INLINE AzimuthRange<V, hn::Mask<D>> azimuth_range(D d, const CausticView<D>& at, V b, const SweptAngle<V>& swept) {
  const V bg = b * at.shells.light.inverse;
  const V cc = swept.cos * at.cos, ss = swept.sin * at.sin, sc = swept.sin * at.cos, cs = swept.cos * at.sin;
  const V none = set(d, -1);
  const auto inside = [&](V cos, V sin) {
    const V off = sin - bg;
    return select(cos > 0, (at.light_sin - off) * (at.light_sin + off), none);
  };
  const V near = inside(cc + ss, sc - cs), far = inside(cc - ss, sc + cs);
  const auto flipped = hn::And(far > 0, near <= 0);
  const V depth = select(flipped, far, near);
  const V slope = select(flipped, -ss, ss), cos = select(flipped, cc - ss, cc + ss);
  const V half = neg_mul_add(bg, select(flipped, -cs, cs), slope * cos);
  const V root = hn::Sqrt(max(neg_mul_add(slope * slope, depth, half * half), 0));
  const V divisor = half + root;
  const auto full = hn::Or(hn::And(near > 0, far > 0), depth >= divisor * 2);
  const V versine = select(full, 2, depth / divisor);
  return {hn::IfThenElseZero(depth > 0, versine), hn::AndNot(full, flipped)};
}

// A ball of glass with a concentric void of radius q, in units of the ball's radius, adds terms to Theta.
// A ray that the void's sphere reflects turns by
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

// A ray that leaves a point P in a ball of glass at an angle alpha to the line through P and the centre has, outside
// the ball, the impact parameter b = n p sin(alpha), 0..min(1, n p): with n p for p, the geometry of a point outside.
// It is refracted out of the ball and turns by
//
//     Theta(b) =      asin(b / (n p)) - asin(b / n) + asin(b) - asin(b / d)    away from the centre: outward
//     Theta(b) = pi - asin(b / (n p)) - asin(b / n) + asin(b) - asin(b / d)    past the centre: inward
//
// The first increases. The second decreases, and if n p > 1 increases beyond a minimum. The derivatives of the terms
// decrease as those of a hollow ball do.

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
