// SPDX-License-Identifier: Apache-2.0
// Ray cones for texture filtering.
#pragma once

#include <hwy/highway.h>

#include "kernel/camera-inl.h"
#include "kernel/scatter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// The cone of rays around a path's ray, one per lane: second moments of the rays' distance x from it, scene units, and
/// of their slope s to it.
///
/// Moments of independent causes (pixel, lens, rough surfaces) add up, and the moments are valid on both sides of a
/// focus.
///
/// Reference  docs/decisions/0031
template <class V>
struct RayCone {
  V width2;  ///< x^2
  V mixed;   ///< x s
  V slope2;  ///< s^2

  /// The squared width at a distance along the ray.
  HWY_INLINE V width2_at(V distance) const {
    return mul_add(distance, mul_add(distance, slope2, mixed + mixed), width2);
  }
  /// The cone of the same rays, measured from a point at a distance along the ray.
  HWY_INLINE RayCone advanced(V distance) const {
    return {width2_at(distance), mul_add(distance, slope2, mixed), slope2};
  }
};

/// Cones of camera rays. Where the ray is oblique to pixel or lens, the smaller axis of the footprint is the width.
///
/// `direction`  directions of the rays, unit
/// `width`      as a fraction of pixel and lens
template <class D, class V = hn::Vec<D>>
HWY_INLINE RayCone<V> camera_cone(D d, const SceneView& scene, const CameraVectors<V>& camera, const Vec3<V>& direction,
                                  double width) {
  const V fraction2 = set(d, width * width), zero = hn::Zero(d);
  const V forward2 = dot(camera.forward, camera.forward), along = dot(direction, camera.forward);
  const V cosine2 = along * along / forward2;
  const V pixel2 = min(dot(camera.right, camera.right), dot(camera.down, camera.down)) * fraction2 * cosine2;
  RayCone<V> cone{zero, zero, zero};
  const V inverse_distance = along / forward2;  // to the focus plane
  if (scene.features.lens) {
    // Rays through different points of the lens intersect in the focus plane.
    cone.width2 = dot(camera.lens_u, camera.lens_u) * 4 * fraction2 * cosine2;
    cone.mixed = -(cone.width2 * inverse_distance);
    cone.slope2 = cone.width2 * (inverse_distance * inverse_distance);
  }
  if (scene.camera.is_orthographic) {
    cone.width2 = cone.width2 + pixel2;
  } else {
    cone.slope2 = mul_add(pixel2, inverse_distance * inverse_distance, cone.slope2);
  }
  return cone;
}

/// The squared slope that a lobe adds. The lobe of fuzz 1 is that of a diffuse surface.
///
/// `width`      as a fraction of the lobe, whose angle is twice the fuzz
template <class D, class V = hn::Vec<D>>
HWY_INLINE V lobe_slope2(D d, const Surface<D>& at, double width) {
  const V slope = select(has_trait<&MaterialTraits::is_specular>(d, at), at.fuzz, 1) * (2 * width);
  return slope * slope;
}

/// Cones of rays that a sphere has scattered.
///
/// Reflection and refraction give the direction a d + b n, where d is the arriving direction, n the normal, and a is 1
/// for reflection and the ratio of indices for refraction. Rays at a distance x across the plane of incidence have a
/// normal that differs by x / radius, and the same b to first order. Within the plane, the slope grows faster; the
/// smaller axis is the cone's. The slope after a diffuse surface is that of its lobe.
///
/// `cone`       cones of the arriving rays, at the surface
/// `direction`  directions of the scattered rays, unit
/// `width`      as in lobe_slope2
template <class D, class V = hn::Vec<D>>
HWY_INLINE RayCone<V> scattered_cone(D d, const RayCone<V>& cone, const Surface<D>& at, V radius,
                                     const Vec3<V>& direction, double width) {
  const auto specular = has_trait<&MaterialTraits::is_specular>(d, at);
  const V cos_leaving = dot(direction, at.normal), cos_arriving = -dot(at.direction, at.normal);
  const V a = hn::IfThenElseZero(specular, select(cos_leaving < 0, at.eta, 1));
  const V b = hn::IfThenElseZero(specular, mul_add(a, cos_arriving, cos_leaving));
  const V bend = b / select(at.from_outside, radius, -radius);  // slope per distance
  const V bent = bend * cone.width2, kept = a * cone.mixed;
  return {cone.width2, kept + bent,
          mul_add(a * a, cone.slope2, mul_add(bend, bent + (kept + kept), lobe_slope2(d, at, width)))};
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
