// SPDX-License-Identifier: Apache-2.0
// First rays of paths. Compiled once per instruction set.
#if defined(ORRERY_KERNEL_CAMERA_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_KERNEL_CAMERA_INL_H_
#undef ORRERY_KERNEL_CAMERA_INL_H_
#else
#define ORRERY_KERNEL_CAMERA_INL_H_
#endif

#include <hwy/highway.h>

#include "kernel/random-inl.h"
#include "kernel/sample-inl.h"
#include "kernel/scene_view.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// A ray that leaves the camera's origin plus `offset`.
template <class V>
struct CameraRay {
  Vec3<V> offset;     ///< on the lens; zero for a pinhole
  Vec3<V> direction;  ///< unit
};

/// The ray of a path through its pixel.
///
/// Space      film coordinates in pixels from the film's middle
template <class D, class V = hn::Vec<D>>
HWY_INLINE CameraRay<V> camera_ray(D d, const Camera& camera, bool has_lens, V pixel_x, V pixel_y,
                                   const Four<V>& random) {
  using T = hn::TFromD<D>;
  const V x = pixel_x - hn::Set(d, static_cast<T>(camera.half_width)) + random.v[0];
  const V y = pixel_y - hn::Set(d, static_cast<T>(camera.half_height)) + random.v[1];
  const auto to_focus = mul_add(set3(d, camera.down), y, mul_add(set3(d, camera.right), x, set3(d, camera.forward)));
  if (!has_lens) return {{hn::Zero(d), hn::Zero(d), hn::Zero(d)}, normalized(d, to_focus)};
  const auto lens = sample_unit_disc(d, random.v[2], random.v[3]);
  const auto offset = mul_add(set3(d, camera.lens_u), lens.x, set3(d, camera.lens_v) * lens.y);
  return {offset, normalized(d, to_focus - offset)};
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
