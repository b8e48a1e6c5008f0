// SPDX-License-Identifier: Apache-2.0
// Camera rays.
#pragma once

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "kernel/sampler-inl.h"
#include "kernel/scene_view.h"
#include "math/functions-inl.h"
#include "math/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

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

/// A ray from the camera's origin plus `offset`.
template <class V>
struct CameraRay {
  Vec3<V> offset;     ///< offset on the lens, plus that on the film of an orthographic camera; zero for a pinhole
  Vec3<V> direction;  ///< unit
};

/// Importance sampling of the pixel filter: warps the first two random numbers to the path's position in the pixel,
/// which spans 0..1 on each axis.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void filter_place(D d, const PixelFilter& filter, Four<V>& random) {
  using T = hn::TFromD<D>;
  HWY_ALIGN T u[hn::MaxLanes(D())];
  for (V* const along : {&random.v[0], &random.v[1]}) {
    hn::Store(*along, d, u);
    for (std::size_t i = 0; i < hn::Lanes(d); ++i) {
      const double from_center = static_cast<double>(u[i]) - 0.5, at = std::abs(2 * from_center) * PixelFilter::kSteps;
      const auto step = std::min(static_cast<int>(at), PixelFilter::kSteps - 1);
      const double *const low = filter.places + step, place = *low + (low[1] - *low) * (at - step);
      u[i] = static_cast<T>(0.5 + std::copysign(place, from_center));
    }
    *along = hn::Load(d, u);
  }
}

/// The vectors of kernel::Camera, one camera per lane.
template <class V>
struct CameraVectors {
  Vec3<V> origin, forward, right, down, lens_u, lens_v;
};

/// The cameras at times within the shutter.
///
/// `times`    one per lane; null: nothing moves
template <class D, class V = hn::Vec<D>>
HWY_INLINE CameraVectors<V> camera_vectors(D d, const SceneView& scene, const hn::TFromD<D>* times) {
  const auto at = [&](math::Vec3d Camera::*vector) {
    const auto at_opening = set3(d, scene.camera.*vector);
    return times == nullptr ? at_opening
                            : mul_add(set3(d, scene.camera_motion.*vector), hn::Load(d, times), at_opening);
  };
  return {at(&Camera::origin), at(&Camera::forward), at(&Camera::right),
          at(&Camera::down),   at(&Camera::lens_u),  at(&Camera::lens_v)};
}

/// Camera rays through pixels, one per lane.
///
/// Space      pixel_x, pixel_y are pixels of the frame, relative to the rendered window
template <class D, class V = hn::Vec<D>>
HWY_INLINE CameraRay<V> camera_ray(D d, const SceneView& scene, const CameraVectors<V>& camera, V pixel_x, V pixel_y,
                                   const Four<V>& random) {
  const V x = pixel_x - scene.camera.half_width + random.v[0];
  const V y = pixel_y - scene.camera.half_height + random.v[1];
  if (scene.camera.is_orthographic) {
    const auto film = mul_add(camera.down, y, camera.right * x);
    if (!scene.features.lens) return {film, normalized(camera.forward)};
    const auto lens = sample_unit_disc(d, random.v[2], random.v[3]);
    const auto on_lens = mul_add(camera.lens_u, lens.x, camera.lens_v * lens.y);
    return {film + on_lens, normalized(camera.forward - on_lens)};
  }
  const auto to_focus = mul_add(camera.down, y, mul_add(camera.right, x, camera.forward));
  if (!scene.features.lens) return {{hn::Zero(d), hn::Zero(d), hn::Zero(d)}, normalized(to_focus)};
  const auto lens = sample_unit_disc(d, random.v[2], random.v[3]);
  const auto offset = mul_add(camera.lens_u, lens.x, camera.lens_v * lens.y);
  return {offset, normalized(to_focus - offset)};
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
