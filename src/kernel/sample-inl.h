// SPDX-License-Identifier: Apache-2.0
// Sampling of shapes from uniform numbers.
#if defined(ORRERY_KERNEL_SAMPLE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_KERNEL_SAMPLE_INL_H_
#undef ORRERY_KERNEL_SAMPLE_INL_H_
#else
#define ORRERY_KERNEL_SAMPLE_INL_H_
#endif

#include <hwy/highway.h>

#include "math/functions-inl.h"
#include "math/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using namespace math::HWY_NAMESPACE;  // NOLINT(google-build-using-namespace): SIMD vectors of another room

/// A point on the unit sphere, uniform by area.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> sample_unit_sphere(D d, V u, V v) {
  const V radius = hn::Sqrt(u * (1 - u)) * 2;  // radius of the circle at height 1 - 2u
  const auto turn = sin_cos_turn(d, v);
  return {radius * turn.cos, radius * turn.sin, 1 - (u + u)};
}

/// A point on the unit disc, uniform by area.
template <class D, class V>
struct DiscPoint {
  V x, y;
};
template <class D, class V = hn::Vec<D>>
HWY_INLINE DiscPoint<D, V> sample_unit_disc(D d, V u, V v) {
  const V radius = hn::Sqrt(u);
  const auto turn = sin_cos_turn(d, v);
  return {radius * turn.cos, radius * turn.sin};
}

/// Two unit vectors that form a right-handed orthonormal basis with the unit vector `axis`.
///
/// Reference  duff2017
template <class V>
struct Frame {
  Vec3<V> x, y;
};
template <class D, class V = hn::Vec<D>>
HWY_INLINE Frame<V> frame_around(D d, const Vec3<V>& axis) {
  const V one = set(d, 1);
  const V sign = hn::CopySign(one, axis.z);
  const V a = -(1 / (sign + axis.z));
  const V b = axis.x * axis.y * a;
  return {{mul_add(sign * axis.x, axis.x * a, 1), sign * b, -(sign * axis.x)},
          {b, mul_add(axis.y, axis.y * a, sign), -axis.y}};
}

/// The cone that a sphere subtends from a point outside.
template <class V>
struct SubtendedCone {
  V distance;       ///< to the centre
  V sin, cos;       ///< sine and cosine of half the apex angle
  V one_minus_cos;  ///< computed without cancellation at any distance
};

/// Computes the cone that a sphere subtends.
///
/// Domain     distance > radius
/// Precision  1 - cos from sin^2 / (1 + cos), and cos from the difference (distance - radius) (distance + radius)
template <class V>
HWY_INLINE SubtendedCone<V> subtended_cone(const Vec3<V>& to_center, V radius) {
  const V distance = hn::Sqrt(dot(to_center, to_center));
  const V sin = radius / distance;
  const V cos = hn::Sqrt(max((distance - radius) * (distance + radius), 0)) / distance;
  return {distance, sin, cos, sin * sin / (1 + cos)};
}

/// The solid angle of a cone with this 1 - cos, in steradians.
template <class V>
HWY_INLINE V solid_angle(V one_minus_cos) {
  return one_minus_cos * 6.283185307179586476925;
}

/// Points of a sphere that are visible from outside, uniform by solid angle.
template <class V>
struct SphereSample {
  Vec3<V> direction;  ///< unit, to the point
  Vec3<V> normal;     ///< unit, of the sphere at the point
};

/// Samples the visible points of a sphere.
///
/// `to_center` from the point outside to the sphere's centre
/// Precision  the angle at the sphere's centre follows from the law of sines, without the difference of distances
template <class D, class V = hn::Vec<D>>
HWY_INLINE SphereSample<V> sample_visible_sphere(D d, const Vec3<V>& to_center, const SubtendedCone<V>& cone, V u,
                                                 V v) {
  const V zero = hn::Zero(d), one = set(d, 1), two = set(d, 2);
  const V versine = u * cone.one_minus_cos;
  const V cos = one - versine;
  // sin^2 of the direction's angle divided by sin^2 of the rim's: sin^2 of the angle of incidence on the sphere.
  const V incidence2 = u * (two - versine) / (one + cone.cos);
  const V sin_incidence = hn::Sqrt(incidence2);
  const V cos_incidence = hn::Sqrt(max(one - incidence2, zero));
  const V sin = cone.sin * sin_incidence;
  const V sin_center = sin_incidence * neg_mul_add(cone.sin, cos_incidence, cos);
  const V cos_center = mul_add(cos_incidence, cos, cone.sin * incidence2);
  const Vec3<V> axis = to_center * (one / cone.distance);
  const auto frame = frame_around(d, axis);
  const auto turn = sin_cos_turn(d, v);
  const Vec3<V> across = mul_add(frame.x, turn.cos, frame.y * turn.sin);
  return {mul_add(across, sin, axis * cos), neg_mul_add(axis, cos_center, across * sin_center)};
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
