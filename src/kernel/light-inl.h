// SPDX-License-Identifier: Apache-2.0
// Choice and sampling of emitters.
#pragma once

#include <hwy/highway.h>

#include <cmath>
#include <limits>

#include "kernel/cone-inl.h"
#include "kernel/gather-inl.h"
#include "kernel/intersect-inl.h"
#include "kernel/lights.h"
#include "kernel/scene_view.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

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

/// Points from which light is sampled, one per lane.
template <class D>
struct Vertex {
  using V = hn::Vec<D>;
  Vec3<V> origin, origin_low;            ///< the point, as in PacketRays
  Vec3<V> normal;                        ///< unit, on the side that is lit
  RayCone<V> cone{};                     ///< of rays to lights; only in scenes with ray cones
  const hn::TFromD<D>* times = nullptr;  ///< times of the paths; null: nothing moves
};

/// The normal at the origin of rays that leave spheres, on the side on which they leave.
template <class V>
HWY_INLINE Vec3<V> normal_along(const Vec3<V>& offset, const Vec3<V>& direction) {
  const auto unit = normalized(offset);
  return select(dot(direction, offset) < 0, negated(unit), unit);
}

/// The vector from a vertex to sphere centres.
template <class D>
HWY_INLINE Vec3<hn::Vec<D>> to_center(const Vertex<D>& at, const Vec3<hn::Vec<D>>& center) {
  return (center - at.origin) - at.origin_low;
}

/// A node's power in the lanes' precision. The powers of giant emitters exceed a float's range; treating them as equal
/// introduces no bias.
template <class T>
HWY_INLINE T power_of(const LightNode& node) {
  return static_cast<T>(std::fmin(node.power, static_cast<double>(std::numeric_limits<T>::max())));
}

/// Tree nodes, one per lane.
template <class D>
class LightNodes {
 public:
  void set(std::size_t lane, const SceneView& scene, LightRange range) {
    if (range.end - range.begin > 1) {
      node_[lane] = &scene.lights.nodes[Lights::middle(range)];
    } else {
      leaf_[lane] = light_leaf(scene, scene.lights.spheres[range.begin]);
      node_[lane] = &leaf_[lane];
    }
  }
  /// Initializes a lane whose importance is not used.
  void set_any(std::size_t lane, const SceneView& scene) { node_[lane] = scene.lights.nodes; }

  /// An estimate of the irradiance at the vertices: power / distance^2 times the largest cosine to the normal that a
  /// point of the bounding sphere can have. Zero only if the whole sphere is below the horizon or emits nothing.
  HWY_INLINE hn::Vec<D> importance(D d, const Vertex<D>& at) const {
    using T = hn::TFromD<D>;
    using V = hn::Vec<D>;
    V sphere[4];
    gather4(
        d, [&](std::size_t i) { return node_[i]->center; }, sphere);
    HWY_ALIGN T power[kMax];
    for (std::size_t i = 0; i < hn::Lanes(d); ++i) power[i] = power_of<T>(*node_[i]);
    const V radius = sphere[3];
    const Vec3<V> to = to_center<D>(at, {sphere[0], sphere[1], sphere[2]});
    const auto cone = subtended_cone(to, radius);
    const V cos_center = dot(to, at.normal) / cone.distance;
    const V sin_center = hn::Sqrt(max(neg_mul_add(cos_center, cos_center, 1), 0));
    // cos(max(angle to the centre - half apex angle, 0))
    const V nearest = select(cos_center > cone.cos, 1, mul_add(cos_center, cone.cos, sin_center * cone.sin));
    const auto outside = cone.distance > radius;
    const V cosine = select(outside, max(nearest, 0), 1);
    const V distance = max(cone.distance, radius);
    return hn::Load(d, power) * cosine / (distance * distance);
  }

 private:
  static constexpr std::size_t kMax = hn::MaxLanes(D());
  const LightNode* node_[kMax];
  LightNode leaf_[kMax];
};

/// Emitters that were chosen for vertices.
template <class D>
struct ChosenLights {
  hn::Vec<IdTag<D>> spheres;  ///< ids
  hn::Vec<D> probability;     ///< probability of the choice; 0: none was chosen
};

/// Descends the light tree at each vertex, to the leaf that `next` leads to.
///
/// `next`     called as next(share, inner, ranges, level): returns whether each lane continues to the left child, whose
///            fraction of the importance is `share`. `inner`: lanes that have not reached a leaf
/// Result     the probability of the path to the leaf
template <class D, class Next>
HWY_INLINE hn::Vec<D> descend(D d, const SceneView& scene, const Vertex<D>& at, LightRange (&range)[hn::MaxLanes(D())],
                              Next next) {
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  constexpr std::size_t kMax = hn::MaxLanes(D());
  const V one = set(d, 1);
  const Lights& lights = scene.lights;
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) range[i] = {0, lights.count};
  V probability = one;
  LightNodes<D> left, right;
  HWY_ALIGN T is_inner[kMax], goes_left[kMax];
  for (int level = 0;; ++level) {
    bool any = false;
    for (std::size_t i = 0; i < hn::Lanes(d); ++i) any = any || range[i].end - range[i].begin > 1;
    if (!any) return probability;
    for (std::size_t i = 0; i < hn::Lanes(d); ++i) {
      const bool inner = range[i].end - range[i].begin > 1;
      is_inner[i] = inner ? T(1) : T(0);
      if (inner) {
        const std::uint32_t m = Lights::middle(range[i]);
        left.set(i, scene, {range[i].begin, m});
        right.set(i, scene, {m, range[i].end});
      } else {
        left.set_any(i, scene);
        right.set_any(i, scene);
      }
    }
    const auto inner = hn::Load(d, is_inner) != 0;
    const V of_left = left.importance(d, at);
    const V whole = of_left + right.importance(d, at);
    const V share = hn::IfThenElseZero(whole > 0, of_left / whole);
    const auto go_left = next(share, inner, range, level);
    // If nothing is important, both probabilities are 0.
    const V other = hn::IfThenElseZero(whole > 0, 1 - share);
    probability = select(inner, probability * select(go_left, share, other), probability);
    hn::Store(hn::IfThenElseZero(go_left, one), d, goes_left);
    for (std::size_t i = 0; i < hn::Lanes(d); ++i) {
      if (range[i].end - range[i].begin <= 1) continue;
      const std::uint32_t m = Lights::middle(range[i]);
      range[i] = goes_left[i] != T(0) ? LightRange{range[i].begin, m} : LightRange{m, range[i].end};
    }
  }
}

/// Calls visit(i, importance) for each emitter of a short list. The importance is the unoccluded irradiance at the
/// vertices divided by pi: power / distance^2 times the cosine to the normal. If the emitter is partly below the
/// horizon, a parabola with continuous value and slope falls to zero at the point where all of it is below. Inside an
/// emitter, the cosine is 1.
template <class D, class Visit>
HWY_INLINE void for_each_light(D d, const SceneView& scene, const Vertex<D>& at, Visit visit) {
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  for (std::uint32_t i = 0; i < scene.lights.count; ++i) {
    const LightNode& node = scene.lights.nodes[i];
    const V radius = set(d, node.radius), radius2 = radius * radius;
    const Vec3<V> to = to_center<D>(at, set3(d, node.center));
    const V distance2 = dot(to, to);
    const V inverse2 = 1 / max(distance2, radius2);
    const V inverse = hn::Sqrt(inverse2);
    const V cosine = dot(to, at.normal) * inverse,
            sin = radius * inverse;  // cosine to the centre; sine of half the apex angle
    const V above = max(cosine + sin, 0);
    const V cut = above * above * (distance2 * inverse) * (0.25 / node.radius);
    const V visible = select(cosine < sin, cut, cosine);
    visit(i, (power_of<T>(node)) * inverse2 * select(distance2 > radius2, visible, 1));
  }
}

/// Things that were chosen from a list by importance.
template <class D>
struct ListChoice {
  hn::Vec<IdTag<D>> id;
  hn::Vec<D> importance;  ///< 0: none was chosen
  hn::Vec<D> before;      ///< sum of the importances before it
};

/// Chooses the last thing with non-zero importance for which the sum of the preceding ones does not exceed `target`.
///
/// `id_of`    id of the i-th
template <class D, class GetId, class V = hn::Vec<D>>
HWY_INLINE ListChoice<D> choose_from_list(D d, const V* importance, std::uint32_t count, V target, GetId id_of) {
  const IdTag<D> du;
  const V zero = hn::Zero(d);
  V before = zero;
  ListChoice<D> chosen{set(du, id_of(0)), zero, zero};
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto reached = hn::And(importance[i] > 0, before <= target);
    chosen.importance = select(reached, importance[i], chosen.importance);
    chosen.before = select(reached, before, chosen.before);
    chosen.id = select(hn::RebindMask(du, reached), id_of(i), chosen.id);
    before = before + importance[i];
  }
  return chosen;
}

/// Chooses from a short list of emitters by importance.
template <class D, class V = hn::Vec<D>>
HWY_INLINE ChosenLights<D> choose_from_few(D d, const SceneView& scene, const Vertex<D>& at, V u) {
  V of_light[Lights::kFew];
  V whole = hn::Zero(d);
  for_each_light(d, scene, at, [&](std::uint32_t i, V value) {
    of_light[i] = value;
    whole = whole + value;
  });
  const auto chosen = choose_from_list(d, of_light, scene.lights.count, u * whole,
                                       [&](std::uint32_t i) { return scene.lights.spheres[i]; });
  return {chosen.id, hn::IfThenElseZero(whole > 0, chosen.importance / whole)};
}

/// Number of levels of the light tree per random number, since each choice consumes bits.
inline constexpr int kLevelsPerNumber = 8;

/// Chooses an emitter for each vertex by importance: directly if there are few emitters, else through the light tree.
///
/// `u`, `fresh`  uniform in 0..1; `fresh` is used after kLevelsPerNumber levels
/// Domain        scene.lights.count > 0
/// Reference     estevez2018
template <class D, class V = hn::Vec<D>>
HWY_INLINE ChosenLights<D> choose_light(D d, const SceneView& scene, const Vertex<D>& at, V u, V fresh) {
  using Id = hn::TFromD<IdTag<D>>;
  constexpr std::size_t kMax = hn::MaxLanes(D());
  const V one = set(d, 1);
  if (scene.lights.count == 1) return {hn::Set(IdTag<D>(), static_cast<Id>(scene.lights.spheres[0])), one};
  if (scene.lights.few()) return choose_from_few(d, scene, at, u);
  LightRange range[kMax];
  const V probability = descend(d, scene, at, range, [&](V share, hn::Mask<D> inner, const auto&, int level) {
    if (level == kLevelsPerNumber) u = fresh;
    const auto go_left = u < share;
    const V rescaled = select(go_left, u / share, (u - share) / (1 - share));
    u = select(inner, rescaled, u);
    return go_left;
  });
  HWY_ALIGN Id ids[kMax];
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) ids[i] = static_cast<Id>(scene.lights.spheres[range[i].begin]);
  return {hn::Load(IdTag<D>(), ids), probability};
}

/// The probability with which choose_light chooses given emitters. Undefined in lanes whose sphere is not a leaf of the
/// tree.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V choice_probability(D d, const SceneView& scene, const Vertex<D>& at, hn::Vec<IdTag<D>> spheres) {
  using T = hn::TFromD<D>;
  using Id = hn::TFromD<IdTag<D>>;
  constexpr std::size_t kMax = hn::MaxLanes(D());
  if (scene.lights.count == 1) return set(d, 1);
  if (scene.lights.few()) {
    V whole = hn::Zero(d), chosen = hn::Zero(d);
    for_each_light(d, scene, at, [&](std::uint32_t i, V value) {
      const auto is_it = spheres == hn::Set(IdTag<D>(), static_cast<Id>(scene.lights.spheres[i]));
      chosen = select(hn::RebindMask(d, is_it), value, chosen);
      whole = whole + value;
    });
    return hn::IfThenElseZero(whole > 0, chosen / whole);
  }
  HWY_ALIGN Id ids[kMax];
  HWY_ALIGN T goes_left[kMax];
  hn::Store(spheres, IdTag<D>(), ids);
  std::uint32_t leaf[kMax];
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) leaf[i] = scene.lights.leaf(static_cast<std::uint32_t>(ids[i]));
  LightRange range[kMax];
  return descend(d, scene, at, range, [&](V, hn::Mask<D>, const auto& ranges, int) {
    for (std::size_t i = 0; i < hn::Lanes(d); ++i) goes_left[i] = leaf[i] < Lights::middle(ranges[i]) ? T(1) : T(0);
    return hn::Load(d, goes_left) != 0;
  });
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
