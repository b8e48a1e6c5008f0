// SPDX-License-Identifier: Apache-2.0
// Sampling of rods that emit.
//
// Half of a rod is a lamp of two parts, its body and the cap at its end, of which one is chosen. Rays that leave a
// vertex meet the infinite cylinder of the body at a horizontal distance that depends on their turn phi around the axis
// alone: with a fixed phi, the visible part of the body is an interval of directions, and uniform in the sine of the
// elevation psi over the plane perpendicular to the axis is uniform by solid angle, d omega = d phi d(sin psi). Hence
// no direction misses, and the density is known exactly. The cap is a part of the sphere at the end.
#pragma once

#include <hwy/highway.h>

#include "kernel/light-inl.h"
#include "kernel/rod-inl.h"
#include "kernel/scene_view.h"
#include "kernel/surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// A point of a lamp that was sampled from a vertex.
template <class D>
struct LampPoint {
  using V = hn::Vec<D>;
  hn::Mask<D> is_visible;  ///< from the vertex, if nothing is between; the other members are valid in these lanes
  Vec3<V> direction;       ///< unit, to the point
  Vec3<V> reach;           ///< from the vertex to the point
  Vec3<V> normal;          ///< unit
  Vec3<V> center;          ///< of the sphere, or of the one that has the rod's place
  V distance, radius;      ///< of this sphere
  V inverse_pdf;           ///< steradians
};

/// Halves of rods as they appear from vertices, one per lane.
template <class D>
class HalfRods {
  using V = hn::Vec<D>;

 public:
  /// `ids`      of the halves; in other lanes, the first rod
  HWY_INLINE HalfRods(D d, const SceneView& scene, const Vertex<D>& at, hn::Vec<IdTag<D>> ids) {
    const IdTag<D> du;
    const auto rod = load_rods(d, scene, ids, at.times);
    const auto half = hn::And(ids - set(du, scene.rods.first_id), set(du, 1U));
    const auto end = select(hn::RebindMask(d, half != 0), rod.b, rod.a);
    const auto from = to_center(at, (rod.a + rod.b) * set(d, 0.5));
    radius_ = rod.radius;
    to_end_ = to_center(at, end);
    const auto along = to_end_ - from;
    length_ = hn::Sqrt(dot(along, along));
    const auto has_body = length_ > 0;
    axis_ = masked(has_body, along * (1 / length_));
    low_ = dot(from, axis_);
    const auto across = neg_mul_add(axis_, low_, from);
    gap_ = hn::Sqrt(dot(across, across));
    across_ = across * (1 / gap_);
    beside_ = cross(axis_, across_);
    // Within the infinite cylinder, only the cap is visible.
    cap_chance_ = select(hn::And(has_body, gap_ > radius_), radius_ / (radius_ + length_), set(d, 1));
  }

  /// `u`, `v`   uniform in 0..1
  HWY_INLINE LampPoint<D> sample(D d, const Vertex<D>& at, V u, V v) const {
    const auto is_cap = v < cap_chance_;
    const V rest = select(is_cap, v / cap_chance_, (v - cap_chance_) / (1 - cap_chance_));
    // The cap.
    const auto cone = subtended_cone(to_end_, radius_);
    const auto cap = sample_visible_sphere(d, to_end_, cone, u, rest);
    const auto cap_is_visible = hn::And(cone.distance > radius_, dot(cap.normal, axis_) >= 0);
    // The body: uniform in the sine of phi, then in that of psi.
    const V side = u * 2 - 1;
    const auto ray = across_at(side * radius_);
    const V psi = mul_add(span(ray.distance), rest, sine(low_, ray.distance));
    const V height = ray.distance * psi / hn::Sqrt((1 - psi) * (1 + psi));
    const V z = min(max(height, low_), low_ + length_);
    const V x = ray.cos * ray.distance, y = ray.sin * ray.distance;
    const auto body = mul_add(across_, x, mul_add(beside_, y, axis_ * z));
    LampPoint<D> out;
    out.is_visible = hn::Or(hn::AndNot(is_cap, gap_ > radius_), hn::And(is_cap, cap_is_visible));
    out.reach = select(is_cap, mul_add(cap.normal, radius_, to_end_), body);
    out.direction = select(is_cap, cap.direction, normalized(body));
    out.normal = select(is_cap, cap.normal, mul_add(across_, x - gap_, beside_ * y) * (1 / radius_));
    const auto to_sphere = neg_mul_add(out.normal, radius_, out.reach);
    out.center = at.origin + to_sphere;
    out.distance = hn::Sqrt(dot(to_sphere, to_sphere));
    out.radius = radius_;
    out.inverse_pdf = select(is_cap, solid_angle(cone.one_minus_cos) / cap_chance_, body_inverse_pdf(ray));
    return out;
  }

  /// 1 / density of directions that hit the halves, steradians. The half that a ray hits is known from the id.
  HWY_INLINE V inverse_pdf(const Vec3<V>& direction) const {
    const V up = dot(direction, axis_), x = dot(direction, across_), y = dot(direction, beside_);
    const V level = hn::Sqrt(mul_add(x, x, y * y));
    const auto ray = across_at(max(min(gap_ * y / level, radius_), -radius_));
    const auto is_body = hn::And(gap_ > radius_, ray.distance * up < (low_ + length_) * level);
    const auto cone = subtended_cone(to_end_, radius_);
    return select(is_body, body_inverse_pdf(ray), solid_angle(cone.one_minus_cos) / cap_chance_);
  }

 private:
  /// Rays in the plane perpendicular to the axis.
  struct Across {
    V sin, cos;  ///< of phi
    V distance;  ///< to the body
  };

  /// The ray that passes the axis at this distance. (gap - radius) (gap + radius) does not cancel near the rod.
  HWY_INLINE Across across_at(V beside_axis) const {
    const V to_foot = hn::Sqrt((gap_ - beside_axis) * (gap_ + beside_axis));
    const V depth = hn::Sqrt(max((radius_ - beside_axis) * (radius_ + beside_axis), 0));
    return {beside_axis / gap_, to_foot / gap_, (gap_ - radius_) * (gap_ + radius_) / (to_foot + depth)};
  }

  static HWY_INLINE V sine(V z, V distance) { return z / hn::Sqrt(mul_add(z, z, distance * distance)); }

  /// The range of the sine of psi, without cancellation where the body is far away along its axis.
  HWY_INLINE V span(V distance) const {
    const V high = low_ + length_, square = distance * distance;
    const V to_low = hn::Sqrt(mul_add(low_, low_, square)), to_high = hn::Sqrt(mul_add(high, high, square));
    const V far = square * length_ * (low_ + high) / (to_low * to_high * mul_add(high, to_low, low_ * to_high));
    return select(low_ * high > 0, far, high / to_high - low_ / to_low);
  }

  HWY_INLINE V body_inverse_pdf(const Across& ray) const {
    return span(ray.distance) * 2 * radius_ / (gap_ * ray.cos * (1 - cap_chance_));
  }

  V radius_, length_;
  Vec3<V> to_end_;
  Vec3<V> axis_, across_, beside_;  ///< unit: to the end; perpendicular, from the vertex to the axis; their product
  V gap_;                           ///< distance of the axis
  V low_;                           ///< position of the middle along the axis, from the vertex's foot on it
  V cap_chance_;                    ///< probability of sampling the cap
};

/// Replaces the points of lamps in the lanes of rods. Not inlined.
///
/// `u`, `v`   as in HalfRods::sample
template <class D, class V = hn::Vec<D>>
HWY_NOINLINE LampPoint<D> with_rods(D d, const SceneView& scene, Vertex<D> at, hn::Vec<IdTag<D>> ids,
                                    LampPoint<D> point, V u, V v) {
  const auto lanes = is_rod(d, scene, ids);
  if (hn::AllFalse(d, lanes)) return point;
  const auto rod = HalfRods<D>(d, scene, at, ids).sample(d, at, u, v);
  return {hn::Or(hn::And(lanes, rod.is_visible), hn::AndNot(lanes, point.is_visible)),
          select(lanes, rod.direction, point.direction),
          select(lanes, rod.reach, point.reach),
          select(lanes, rod.normal, point.normal),
          select(lanes, rod.center, point.center),
          select(lanes, rod.distance, point.distance),
          select(lanes, rod.radius, point.radius),
          select(lanes, rod.inverse_pdf, point.inverse_pdf)};
}

/// Replaces 1 / density in the lanes whose rays have hit rods. Not inlined.
template <class D, class V = hn::Vec<D>>
HWY_NOINLINE V with_rods(D d, const SceneView& scene, Vertex<D> at, Vec3<V> direction, hn::Vec<IdTag<D>> hits,
                         V inverse_pdf) {
  const auto lanes = is_rod(d, scene, hits);
  if (hn::AllFalse(d, lanes)) return inverse_pdf;
  return select(lanes, HalfRods<D>(d, scene, at, hits).inverse_pdf(direction), inverse_pdf);
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
