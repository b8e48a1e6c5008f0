// SPDX-License-Identifier: Apache-2.0
// Spheres, rods and materials of hits.
#pragma once

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>

#include "kernel/gather-inl.h"
#include "kernel/intersect-inl.h"
#include "kernel/rod-inl.h"
#include "kernel/scatter-inl.h"
#include "kernel/scene_view.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// Scene data of a vector of hits.
template <class D>
struct Lookup {
  Spheres<D> sphere;
  Surface<D> surface;
  Vec3<hn::Vec<D>> albedo;
};

/// Loads the spheres with these ids, one per lane.
///
/// `times`    times of the rays; null: nothing moves
template <class D>
HWY_INLINE Spheres<D> load_spheres(D d, const SceneView& scene, const hn::TFromD<IdTag<D>>* id,
                                   const hn::TFromD<D>* times) {
  hn::Vec<D> sphere[4];
  gather_spheres(
      d, scene.spheres, [&](std::size_t i) { return id[i]; }, sphere);
  const Spheres<D> at_opening{{sphere[0], sphere[1], sphere[2]}, sphere[3]};
  if (times == nullptr || scene.moving_count == 0) return at_opening;
  static constexpr Sphere kAtRest{0, 0, 0, 0};
  hn::Vec<D> change[4];
  gather4(
      d, [&](std::size_t i) { return &(id[i] < scene.moving_count ? scene.motion[id[i]] : kAtRest).x; }, change);
  return moved<D>(at_opening, {{change[0], change[1], change[2]}, change[3]}, hn::Load(d, times));
}

/// Stores ids below `count`: those of the hits, and the last one in lanes without a hit, whose sphere is compact if any
/// is. Lanes that hit rods get the last sphere if `count` is that of the spheres.
///
/// Domain     count > 0
template <class D>
HWY_INLINE void store_loadable(D, std::size_t count, hn::Vec<IdTag<D>> hits, hn::TFromD<IdTag<D>>* id) {
  const IdTag<D> du;
  static_assert(kNone == ~std::uint32_t{0});
  hn::Store(min(hits, static_cast<hn::TFromD<IdTag<D>>>(count - 1)), du, id);
}

/// Loads the spheres of the hits; lanes that hit none get the last one, or any if there are none.
template <class D>
HWY_INLINE Spheres<D> load_spheres(D d, const SceneView& scene, hn::Vec<IdTag<D>> hits, const hn::TFromD<D>* times) {
  HWY_ALIGN hn::TFromD<IdTag<D>> id[hn::MaxLanes(D())];
  store_loadable(d, std::max<std::size_t>(scene.sphere_count, 1), hits, id);
  return load_spheres(d, scene, id, times);
}

/// Lanes that hit rods.
template <class D>
HWY_INLINE hn::Mask<D> is_rod(D d, const SceneView& scene, hn::Vec<IdTag<D>> hits) {
  const auto is_sphere = hn::RebindMask(d, hits < scene.rods.first_id);
  return hn::Not(hn::Or(is_sphere, hn::RebindMask(d, hits == kNone)));
}

/// Loads the rods of the hits; lanes that hit no rod get the first one.
///
/// `times`    times of the rays; null: nothing moves
/// Domain     there are rods
template <class D>
HWY_INLINE Rods<D> load_rods(D d, const SceneView& scene, hn::Vec<IdTag<D>> hits, const hn::TFromD<D>* times) {
  const RodArray& rods = scene.rods;
  const IdTag<D> du;
  HWY_ALIGN hn::TFromD<IdTag<D>> index[hn::MaxLanes(D())];
  const auto ids = hits - set(du, rods.first_id);
  hn::Store(hn::IfThenElseZero(hn::RebindMask(du, is_rod(d, scene, hits)), hn::template ShiftRight<1>(ids)), du, index);
  const auto at_opening = gather_rods(d, rods, [&](std::size_t i) { return index[i]; });
  if (times == nullptr || !rods.any_moves()) return at_opening;
  Rod changes[hn::MaxLanes(D())];
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) changes[i] = rods.change(index[i]);
  const auto change = gather_plain_rods(d, [&](std::size_t i) -> const Rod& { return changes[i]; });
  return moved<D>(at_opening, change, hn::Load(d, times));
}

/// The points where rays have hit rods; undefined in other lanes.
template <class D, Precision kPrecision>
HWY_NOINLINE RodPoint<D> rod_hits(D d, const SceneView& scene, Rays<D> ray, hn::Vec<IdTag<D>> hits,
                                  const hn::TFromD<D>* times) {
  return rod_point<D, kPrecision>(d, ray, load_rods(d, scene, hits, times));
}

/// The vector from the centre of a sphere, or from end a of a rod, to a hit point; see PathRecord.
///
/// `center`, `offset`  of the sphere that was hit, or of the one that has the rod's place
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> recorded_offset(D d, const SceneView& scene, hn::Vec<IdTag<D>> hits, const hn::TFromD<D>* times,
                                   const Vec3<V>& center, const Vec3<V>& offset) {
  const auto rod = load_rods(d, scene, hits, times);
  return select(is_rod(d, scene, hits), (center - rod.a) + offset, offset);
}

/// Replaces spheres and points in the lanes that hit rods.
///
/// Result     these lanes
template <class D, Precision kPrecision>
HWY_INLINE hn::Mask<D> reach_rods(D d, const SceneView& scene, const Rays<D>& ray, hn::Vec<IdTag<D>> hits,
                                  const hn::TFromD<D>* times, Spheres<D>& sphere, HitPoint<hn::Vec<D>>& point) {
  const auto lanes = is_rod(d, scene, hits);
  if (hn::AllFalse(d, lanes)) return lanes;
  const auto rod = rod_hits<D, kPrecision>(d, scene, ray, hits, times);
  sphere = {select(lanes, rod.sphere.center, sphere.center), select(lanes, rod.sphere.radius, sphere.radius)};
  point = {select(lanes, rod.point.offset, point.offset), select(lanes, rod.point.outward, point.outward)};
  return lanes;
}

/// Loads spheres and materials of the hits, and computes point, normal and side of each, which selects the material's
/// constants.
///
/// `kHasRods`  false: all hits are spheres
/// `times`     times of the rays; null: nothing moves
template <class D, Precision kPrecision, bool kHasRods = false>
HWY_INLINE Lookup<D> reach_surface(D d, const SceneView& scene, const Rays<D>& ray, hn::Vec<IdTag<D>> hits,
                                   hn::Vec<D> distance, const hn::TFromD<D>* times) {
  // Load the materials; lanes without a hit get that of the last object.
  using Id = hn::TFromD<IdTag<D>>;
  constexpr std::size_t kMax = hn::MaxLanes(D());
  const IdTag<D> du;
  HWY_ALIGN Id id[kMax], kind[kMax], fresnel[kMax];
  const Material* material[kMax];
  store_loadable(d, scene.sphere_count + (kHasRods ? 2 * scene.rods.count : 0), hits, id);
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) {
    material[i] = &scene.materials[scene.object_materials[id[i]]];
    kind[i] = static_cast<Id>(material[i]->kind);
    fresnel[i] = static_cast<Id>(material[i]->fresnel);
  }
  hn::Vec<D> color[4], glass[4];
  gather4(
      d, [&](std::size_t i) { return material[i]->albedo; }, color);
  gather4(
      d, [&](std::size_t i) { return material[i]->eta; }, glass);
  // Load the spheres; lanes that hit none get the last one.
  if (kHasRods) store_loadable(d, std::max<std::size_t>(scene.sphere_count, 1), hits, id);
  Lookup<D> at;
  at.sphere = load_spheres(d, scene, id, times);
  at.albedo = {color[0], color[1], color[2]};

  // Find the points.
  Surface<D>& surface = at.surface;
  const auto is_self = hn::RebindMask(d, hits == ray.self);
  surface.direction = ray.direction;
  auto point = hit_point<D, kPrecision>(ray, at.sphere, is_self, distance);
  surface.from_outside = dot(ray.direction, point.offset) < 0;
  if constexpr (kHasRods) {
    // Rods are hit from outside only; where a ray grazes one, the sign is that of a rounding error.
    const auto is_entry = reach_rods<D, kPrecision>(d, scene, ray, hits, times, at.sphere, point);
    surface.from_outside = hn::Or(is_entry, surface.from_outside);
  }
  surface.offset = point.offset;
  surface.normal = select(surface.from_outside, point.outward, negated(point.outward));
  surface.fuzz = color[3];
  surface.eta = select(surface.from_outside, glass[0], glass[1]);
  surface.r0 = select(surface.from_outside, glass[2], glass[3]);
  surface.kind = hn::Load(du, kind);
  surface.fresnel = hn::Load(du, fresnel);
  return at;
}

/// The same in scenes with rods. Not inlined.
template <class D, Precision kPrecision>
HWY_NOINLINE Lookup<D> reach_surface_or_rod(D d, const SceneView& scene, Rays<D> ray, hn::Vec<IdTag<D>> hits,
                                            hn::Vec<D> distance, const hn::TFromD<D>* times) {
  return reach_surface<D, kPrecision, true>(d, scene, ray, hits, distance, times);
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
