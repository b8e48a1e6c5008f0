// SPDX-License-Identifier: Apache-2.0
// Points at which textures are evaluated. Compiled once per instruction set.
#if defined(ORRERY_KERNEL_TEXTURE_POINT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_KERNEL_TEXTURE_POINT_INL_H_
#undef ORRERY_KERNEL_TEXTURE_POINT_INL_H_
#else
#define ORRERY_KERNEL_TEXTURE_POINT_INL_H_
#endif

#include <hwy/highway.h>

#include "kernel/intersect-inl.h"
#include "kernel/precision.h"
#include "math/functions-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// Points on spheres, one per lane.
template <class D>
struct TexturePoint {
  Vec3<hn::Vec<D>> base, rest;  ///< their sum is the point in world space
  Vec3<hn::Vec<D>> outward;     ///< unit, from the sphere's centre
  hn::Vec<D> footprint2;        ///< squared width of the ray cone, seen from the sphere's centre, radians^2
};

/// The distance to the nearer intersection of a ray's line with a sphere whose surface is close to the ray's origin
/// compared with its radius.
///
/// |o - c|^2 - r^2 is summed with its rounding errors, and the quadratic's root is divided into it, so that the error
/// is relative to the distance, not to the radius.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V refined_distance(D d, const Rays<D>& ray, const Spheres<D>& sphere, V distance) {
  const V zero = hn::Zero(d);
  const auto from_center = ray.origin - sphere.center;
  const auto lost = difference_error(ray.origin, sphere.center, from_center) + ray.origin_low;
  V sum = zero, error = zero;
  const auto add = [&](V square, V square_lost) {
    const V total = sum + square;
    error = error + (difference_error(sum, hn::Neg(square), total) + square_lost);
    sum = total;
  };
  const auto add_square = [&](V a) {
    const V square = a * a;
    add(square, math::HWY_NAMESPACE::product_error(d, a, a, square));
  };
  const V radius2 = sphere.radius * sphere.radius;
  add(hn::Neg(radius2), hn::Neg(math::HWY_NAMESPACE::product_error(d, sphere.radius, sphere.radius, radius2)));
  add_square(from_center.x);
  add_square(from_center.y);
  add_square(from_center.z);
  const V mixed = dot(from_center, lost);
  const V excess = sum + (error + (mixed + mixed));  // |o - c|^2 - r^2
  const V middle = dot(from_center, ray.direction) + dot(lost, ray.direction);
  const V half = hn::Sqrt(hn::Max(hn::MulSub(middle, middle, excess), zero));
  const V far = hn::Neg(middle + hn::CopySign(half, middle));
  const V near = excess / far;
  // False for NaN.
  return hn::IfThenElse(hn::Abs(near - distance) < hn::Abs(far - distance), near, distance);
}

/// The points at which textures are evaluated for hits.
///
/// On a sphere that is small or far from the ray's origin, the point is the centre plus an offset. On a sphere that is
/// large compared with its distance, it is the ray's origin plus a vector: rounding errors of the offset would be
/// visible where a ground coincides with faces of checker cells.
///
/// `offset`, `outward`  see HitPoint
/// `footprint2`         see TexturePoint
/// Precision  docs/numerics.md, test KernelTexture.CellsOfCheckersAtAllRadii
template <class D, Precision kPrecision, class V = hn::Vec<D>>
HWY_INLINE TexturePoint<D> texture_point(D d, const Rays<D>& ray, const Spheres<D>& sphere, const Vec3<V>& offset,
                                         const Vec3<V>& outward, V distance, V footprint2) {
  if constexpr (kPrecision == Precision::kBook) return {ray.origin, ray.direction * distance, outward, footprint2};
  const auto reach = [&](const Vec3<V>& a) { return max<V>({hn::Abs(a.x), hn::Abs(a.y), hn::Abs(a.z)}); };
  const auto by_ray = distance + reach(ray.origin) < sphere.radius + reach(sphere.center);
  if (hn::AllFalse(d, by_ray)) return {sphere.center, offset, outward, footprint2};
  const V refined = refined_distance(d, ray, sphere, distance);
  return {select(by_ray, ray.origin, sphere.center),
          select(by_ray, mul_add(ray.direction, refined, ray.origin_low), offset), outward, footprint2};
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
