// SPDX-License-Identifier: Apache-2.0
// Rays of a single-precision BVH. Compiled once per instruction set.
#if defined(ORRERY_ACCEL_BOX_RAY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_ACCEL_BOX_RAY_INL_H_
#undef ORRERY_ACCEL_BOX_RAY_INL_H_
#else
#define ORRERY_ACCEL_BOX_RAY_INL_H_
#endif

#include <hwy/highway.h>

#include "accel/box_frame.h"
#include "kernel/intersect-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::accel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
namespace k = kernel::HWY_NAMESPACE;

/// Rays in box space, advanced to the sphere that encloses all boxes.
template <class D>
struct BoxRays {
  math::HWY_NAMESPACE::Vec3<hn::Vec<D>> origin;
  hn::Vec<D> start;     ///< distance by which each ray was advanced, box space
  hn::Mask<D> reaches;  ///< false: the ray misses all boxes
};

/// Transforms rays to box space. Rays from far away would lose their float precision to the distance, so they are first
/// advanced, in the packet's precision, to the sphere that encloses all boxes.
///
/// Domain     unit directions
template <class D>
HWY_INLINE BoxRays<D> to_box_space(D d, const k::Rays<D>& ray, const BoxFrame& frame) {
  using T = hn::TFromD<D>;
  using namespace math::HWY_NAMESPACE;  // NOLINT(google-build-using-namespace)
  const auto scale = hn::Set(d, static_cast<T>(frame.scale));
  const auto middle = set3(d, frame.middle);
  const auto away = ray.origin - middle;
  const auto away_low = difference_error(ray.origin, middle, away) + ray.origin_low;
  const auto origin = away * scale;
  const auto low = away_low * scale;
  const auto zero = hn::Zero(d);
  const auto all = zero == zero;
  const auto reach = hn::Set(d, static_cast<T>(frame.reach));
  const auto outside = dot(origin, origin) > reach * reach;
  if (hn::AllFalse(d, outside)) return {origin + low, zero, all};

  const auto closest = hn::Neg(dot(origin, ray.direction));
  const auto passing = mul_add(ray.direction, closest, origin) + low;
  // The margin covers the rounding of `passing` for a ray from 1e12 reaches away, in single precision from 1e6.
  const auto nearest_square = reach * reach * hn::Set(d, static_cast<T>(sizeof(T) == 8 ? 1.001 : 1.1));
  const auto misses = hn::Or(dot(passing, passing) > nearest_square, closest < zero);
  const auto start = hn::IfThenElseZero(outside, hn::Max(closest - reach, zero));
  return {mul_add(ray.direction, start, origin) + low, start, hn::Not(hn::And(outside, misses))};
}

}  // namespace orrery::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
