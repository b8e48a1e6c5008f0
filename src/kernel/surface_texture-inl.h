// SPDX-License-Identifier: Apache-2.0
// Textures of materials at hits and at light samples.
#pragma once

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#include "kernel/surface-inl.h"
#include "kernel/texture-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// Texture indices of the materials of spheres, one per lane.
template <class D>
struct TextureIndices {
  static constexpr std::size_t kMax = hn::MaxLanes(D());
  std::uint32_t albedo[kMax], fuzz[kMax], radiance[kMax];
  bool has_albedo = false, has_fuzz = false, has_radiance = false;

  /// Loads the texture indices of the spheres in `lanes`; other lanes have none.
  ///
  /// Domain     scene.textures is not null
  HWY_INLINE TextureIndices(D d, const SceneView& scene, hn::Vec<IdTag<D>> spheres, hn::Mask<D> lanes) {
    using T = hn::TFromD<D>;
    HWY_ALIGN hn::TFromD<IdTag<D>> id[kMax];
    HWY_ALIGN T is_set[kMax];
    hn::Store(spheres, IdTag<D>(), id);
    hn::Store(hn::IfThenElseZero(lanes, set(d, 1)), d, is_set);
    for (std::size_t i = 0; i < hn::Lanes(d); ++i) {
      const MaterialTextures of =
          is_set[i] != T(0) ? scene.material_textures[scene.object_materials[id[i]]] : MaterialTextures{};
      albedo[i] = of.albedo;
      fuzz[i] = of.fuzz;
      radiance[i] = of.radiance;
      has_albedo = has_albedo || of.albedo != kNone;
      has_fuzz = has_fuzz || of.fuzz != kNone;
      has_radiance = has_radiance || of.radiance != kNone;
    }
  }
};

/// Constants of materials that textures may replace.
template <class V>
struct Textured {
  Vec3<V> albedo;
  V fuzz;
};

/// Albedo and fuzz at hits: the values of their textures, or the material's constants.
///
/// `hit`      lanes with a hit
/// `width2`   squared width of the ray cones at the hits
///
/// This and other large functions are not inlined, so that the loops of a precision share one copy. They take what they
/// read by value: a reference would keep the caller's variables in memory.
template <class D, Precision kPrecision, class V = hn::Vec<D>>
HWY_NOINLINE Textured<V> textured_surface(D d, const SceneView& scene, Rays<D> ray, hn::Vec<IdTag<D>> hits,
                                          hn::Mask<D> hit, V distance, V width2, Lookup<D> at) {
  const TextureIndices<D> index(d, scene, hits, hit);
  const Surface<D>& surface = at.surface;
  Textured<V> out{at.albedo, surface.fuzz};
  if (!index.has_albedo && !index.has_fuzz) return out;
  const auto outward = select(surface.from_outside, surface.normal, negated(surface.normal));
  const auto point = texture_point<D, kPrecision>(d, ray, at.sphere, surface.offset, outward, distance,
                                                  width2 / (at.sphere.radius * at.sphere.radius));
  if (index.has_albedo) out.albedo = replaced_by_textures(d, scene.textures, index.albedo, point, out.albedo);
  if (index.has_fuzz)
    out.fuzz = replaced_by_textures(d, scene.textures, index.fuzz, point, {out.fuzz, out.fuzz, out.fuzz}).x;
  return out;
}

/// Emitted radiance at sampled points of emitters: the value of the texture, or `radiance` without one.
template <class D, class V = hn::Vec<D>>
HWY_NOINLINE Vec3<V> textured_radiance(D d, const SceneView& scene, hn::Vec<IdTag<D>> spheres,
                                       const TexturePoint<D>& point, const Vec3<V>& radiance) {
  const TextureIndices<D> index(d, scene, spheres, hn::FirstN(d, hn::Lanes(d)));
  if (!index.has_radiance) return radiance;
  return replaced_by_textures(d, scene.textures, index.radiance, point, radiance);
}

/// Emitted radiance at hits of emitters: the value of the texture, or `radiance` without one.
///
/// `lanes`    hits of emitters
/// `width2`   squared width of the ray cones at the hits
/// `times`    times of the rays; null: nothing moves
template <class D, Precision kPrecision, class V = hn::Vec<D>>
HWY_NOINLINE Vec3<V> textured_radiance(D d, const SceneView& scene, Rays<D> ray, hn::Vec<IdTag<D>> hits,
                                       hn::Mask<D> lanes, V distance, V width2, const hn::TFromD<D>* times,
                                       Vec3<V> radiance) {
  const TextureIndices<D> index(d, scene, hits, lanes);
  if (!index.has_radiance) return radiance;
  Spheres<D> sphere{};
  HitPoint<V> at{};
  if (scene.sphere_count > 0) {
    sphere = load_spheres(d, scene, hits, times);
    at = hit_point<D, kPrecision>(ray, sphere, hn::RebindMask(d, hits == ray.self), distance);
  }
  if (!scene.rods.empty()) reach_rods<D, kPrecision>(d, scene, ray, hits, times, sphere, at);
  const auto point = texture_point<D, kPrecision>(d, ray, sphere, at.offset, at.outward, distance,
                                                  width2 / (sphere.radius * sphere.radius));
  return replaced_by_textures(d, scene.textures, index.radiance, point, radiance);
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
