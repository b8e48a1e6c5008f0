// SPDX-License-Identifier: Apache-2.0
// Spheres and materials of hits. Compiled once per instruction set.
#if defined(ORRERY_KERNEL_SURFACE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_KERNEL_SURFACE_INL_H_
#undef ORRERY_KERNEL_SURFACE_INL_H_
#else
#define ORRERY_KERNEL_SURFACE_INL_H_
#endif

#include <hwy/highway.h>

#include "kernel/gather-inl.h"
#include "kernel/gather_spheres-inl.h"
#include "kernel/intersect-inl.h"
#include "kernel/scatter-inl.h"
#include "kernel/scene_view.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// Scene data of a vector of hits.
template <class D>
struct Lookup {
  Spheres<D> sphere;
  Surface<D> surface;  ///< offset, normal and side are set later by reach_surface
  Vec3<hn::Vec<D>> albedo;
  hn::Vec<D> eta_outside, eta_inside, r0_outside, r0_inside;
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
  const auto time = hn::Load(d, times);
  return {mul_add(Vec3<hn::Vec<D>>{change[0], change[1], change[2]}, time, at_opening.center),
          mul_add(change[3], time, at_opening.radius)};
}

/// Stores ids from which spheres can be loaded: those of the hits, and the last sphere, which is compact if any is, in
/// lanes without a hit.
template <class D>
HWY_INLINE void store_loadable(D, const SceneView& scene, hn::Vec<IdTag<D>> hits, hn::TFromD<IdTag<D>>* id) {
  const IdTag<D> du;
  static_assert(kNoSphere == ~std::uint32_t{0});
  hn::Store(min(hits, static_cast<hn::TFromD<IdTag<D>>>(scene.sphere_count - 1)), du, id);
}

/// Loads the spheres of the hits; lanes without a hit get the last one.
template <class D>
HWY_INLINE Spheres<D> load_spheres(D d, const SceneView& scene, hn::Vec<IdTag<D>> hits, const hn::TFromD<D>* times) {
  HWY_ALIGN hn::TFromD<IdTag<D>> id[hn::MaxLanes(D())];
  store_loadable(d, scene, hits, id);
  return load_spheres(d, scene, id, times);
}

/// Loads spheres and materials of the hits; lanes without a hit get those of the last sphere.
///
/// `times`    times of the rays; null: nothing moves
template <class D>
HWY_INLINE Lookup<D> look_up(D d, const SceneView& scene, hn::Vec<IdTag<D>> hits, const hn::TFromD<D>* times) {
  using Id = hn::TFromD<IdTag<D>>;
  constexpr std::size_t kMax = hn::MaxLanes(D());
  const IdTag<D> du;
  HWY_ALIGN Id id[kMax], kind[kMax], fresnel[kMax];
  const Material* material[kMax];
  store_loadable(d, scene, hits, id);
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) {
    material[i] = &scene.materials[scene.sphere_materials[id[i]]];
    kind[i] = static_cast<Id>(material[i]->kind);
    fresnel[i] = static_cast<Id>(material[i]->fresnel);
  }
  hn::Vec<D> color[4], glass[4];
  gather4(
      d, [&](std::size_t i) { return material[i]->albedo; }, color);
  gather4(
      d, [&](std::size_t i) { return material[i]->eta; }, glass);
  Lookup<D> out;
  out.sphere = load_spheres(d, scene, id, times);
  out.albedo = {color[0], color[1], color[2]};
  out.surface.fuzz = color[3];
  out.eta_outside = glass[0];
  out.eta_inside = glass[1];
  out.r0_outside = glass[2];
  out.r0_inside = glass[3];
  out.surface.kind = hn::Load(du, kind);
  out.surface.fresnel = hn::Load(du, fresnel);
  return out;
}

/// Computes point, normal and side of every hit, and selects the material's constants for that side.
template <class D, Precision kPrecision>
HWY_INLINE Lookup<D> reach_surface(D d, const SceneView& scene, const Rays<D>& ray, hn::Vec<IdTag<D>> hits,
                                   hn::Vec<D> distance, const hn::TFromD<D>* times) {
  Lookup<D> at = look_up(d, scene, hits, times);
  Surface<D>& surface = at.surface;
  const auto is_self = hn::RebindMask(d, hits == ray.self);
  surface.direction = ray.direction;
  const auto point = hit_point<D, kPrecision>(ray, at.sphere, is_self, distance);
  surface.offset = point.offset;
  surface.from_outside = dot(ray.direction, surface.offset) < 0;
  surface.normal = select(surface.from_outside, point.outward, negated(point.outward));
  surface.eta = select(surface.from_outside, at.eta_outside, at.eta_inside);
  surface.r0 = select(surface.from_outside, at.r0_outside, at.r0_inside);
  return at;
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
