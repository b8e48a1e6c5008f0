// SPDX-License-Identifier: Apache-2.0
// A ball and a light as they appear from a point, and the azimuth of rays that hit the light. Compiled once per
// instruction set.
#if defined(ORRERY_KERNEL_CAUSTIC_VIEW_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_KERNEL_CAUSTIC_VIEW_INL_H_
#undef ORRERY_KERNEL_CAUSTIC_VIEW_INL_H_
#else
#define ORRERY_KERNEL_CAUSTIC_VIEW_INL_H_
#endif

#include <hwy/highway.h>

#include <limits>

#include "kernel/caustic_chain-inl.h"
#include "kernel/sample-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

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

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
