// SPDX-License-Identifier: Apache-2.0
// Vectors of SIMD lanes.
#pragma once

#include <hwy/highway.h>

#include <cstddef>

#include "math/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::math::HWY_NAMESPACE {

/// Three-component vectors, one per lane of V.
template <class V>
struct Vec3 {
  V x, y, z;
};

template <class V>
HWY_INLINE Vec3<V> operator+(const Vec3<V>& a, const Vec3<V>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class V>
HWY_INLINE Vec3<V> operator-(const Vec3<V>& a, const Vec3<V>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class V>
HWY_INLINE Vec3<V> operator*(const Vec3<V>& a, V s) {
  return {a.x * s, a.y * s, a.z * s};
}
/// Returns the component-wise product.
template <class V>
HWY_INLINE Vec3<V> operator*(const Vec3<V>& a, const Vec3<V>& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
/// Returns the largest component.
template <class V>
HWY_INLINE V max(const Vec3<V>& a) {
  return max(a.x, max(a.y, a.z));
}
template <class V>
HWY_INLINE V dot(const Vec3<V>& a, const Vec3<V>& b) {
  return mul_add(a.z, b.z, mul_add(a.y, b.y, a.x * b.x));
}
/// Returns a s + b; each component is rounded once, except without fused multiply-add (SSE4).
template <class V>
HWY_INLINE Vec3<V> mul_add(const Vec3<V>& a, V s, const Vec3<V>& b) {
  return {mul_add(a.x, s, b.x), mul_add(a.y, s, b.y), mul_add(a.z, s, b.z)};
}
/// Returns b - a s; rounded as by mul_add().
template <class V>
HWY_INLINE Vec3<V> neg_mul_add(const Vec3<V>& a, V s, const Vec3<V>& b) {
  return {neg_mul_add(a.x, s, b.x), neg_mul_add(a.y, s, b.y), neg_mul_add(a.z, s, b.z)};
}
template <class V>
HWY_INLINE Vec3<V> negated(const Vec3<V>& a) {
  return {-a.x, -a.y, -a.z};
}
template <class M, class V>
HWY_INLINE Vec3<V> select(M mask, const Vec3<V>& yes, const Vec3<V>& no) {
  return {select(mask, yes.x, no.x), select(mask, yes.y, no.y), select(mask, yes.z, no.z)};
}
/// Returns the vectors of some lanes, and zero in the others.
template <class M, class V>
HWY_INLINE Vec3<V> masked(M mask, const Vec3<V>& v) {
  return {hn::IfThenElseZero(mask, v.x), hn::IfThenElseZero(mask, v.y), hn::IfThenElseZero(mask, v.z)};
}
/// Returns unit vectors; NaN in lanes whose vector is zero. Callers rely on comparisons with NaN being false.
template <class V>
HWY_INLINE Vec3<V> normalized(const Vec3<V>& a) {
  return a * (1 / hn::Sqrt(dot(a, a)));
}
template <class D, class T>
HWY_INLINE Vec3<hn::Vec<D>> load3(D d, const T* x, const T* y, const T* z) {
  return {hn::Load(d, x), hn::Load(d, y), hn::Load(d, z)};
}
template <class D, class T, std::size_t kSize>
HWY_INLINE Vec3<hn::Vec<D>> load3(D d, const T (&from)[3][kSize], int at) {
  return load3(d, from[0] + at, from[1] + at, from[2] + at);
}
/// Loads from any index; load3() and store3() need that of a whole vector.
template <class D, class T, std::size_t kSize>
HWY_INLINE Vec3<hn::Vec<D>> loadu3(D d, const T (&from)[3][kSize], int at) {
  return {hn::LoadU(d, from[0] + at), hn::LoadU(d, from[1] + at), hn::LoadU(d, from[2] + at)};
}
template <class D, class T, std::size_t kSize>
HWY_INLINE void store3(D d, const Vec3<hn::Vec<D>>& v, T (&to)[3][kSize], int at) {
  hn::Store(v.x, d, to[0] + at);
  hn::Store(v.y, d, to[1] + at);
  hn::Store(v.z, d, to[2] + at);
}
template <class D, class T>
HWY_INLINE Vec3<hn::Vec<D>> set3(D d, const T* v) {
  return {set(d, v[0]), set(d, v[1]), set(d, v[2])};
}
template <class D, class V>
requires requires(const V& v) { v.x + v.y + v.z; }
HWY_INLINE Vec3<hn::Vec<D>> set3(D d, const V& v) { return {set(d, v.x), set(d, v.y), set(d, v.z)}; }

/// Returns the rounding error of a - b rounded to `difference`: difference + result equals a - b exactly.
///
/// Reference  knuth1997, two-sum
template <class V>
HWY_INLINE V difference_error(V a, V b, V difference) {
  const V b_virtual = difference - a;
  return (a - (difference - b_virtual)) - (b + b_virtual);
}
template <class V>
HWY_INLINE Vec3<V> difference_error(const Vec3<V>& a, const Vec3<V>& b, const Vec3<V>& difference) {
  return {difference_error(a.x, b.x, difference.x), difference_error(a.y, b.y, difference.y),
          difference_error(a.z, b.z, difference.z)};
}
/// Returns the rounding error of a + b rounded to `sum`.
template <class V>
HWY_INLINE Vec3<V> sum_error(const Vec3<V>& a, const Vec3<V>& b, const Vec3<V>& sum) {
  return difference_error(a, negated(b), sum);
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

}  // namespace orrery::math::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
