// SPDX-License-Identifier: Apache-2.0
// Sampling of shapes from uniform numbers. Compiled once per instruction set.
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
using namespace math::HWY_NAMESPACE;  // NOLINT(google-build-using-namespace): one room's lanes in another's text

/// A point on the unit sphere, uniform by area.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> sample_unit_sphere(D d, V u, V v) {
  using T = hn::TFromD<D>;
  const V one = hn::Set(d, T(1));
  const V radius = hn::Sqrt(u * (one - u)) * hn::Set(d, T(2));  // of the circle at height 1 - 2u
  const auto turn = sin_cos_turn(d, v);
  return {radius * turn.cos, radius * turn.sin, one - (u + u)};
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

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
