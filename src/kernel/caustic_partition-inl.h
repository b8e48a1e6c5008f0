// SPDX-License-Identifier: Apache-2.0
// Which paths find light that was sampled at their last diffuse vertex. Compiled once per instruction set.
#if defined(ORRERY_KERNEL_CAUSTIC_PARTITION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_KERNEL_CAUSTIC_PARTITION_INL_H_
#undef ORRERY_KERNEL_CAUSTIC_PARTITION_INL_H_
#else
#define ORRERY_KERNEL_CAUSTIC_PARTITION_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "kernel/caustics.h"
#include "kernel/compaction-inl.h"
#include "kernel/environment-inl.h"
#include "kernel/scatter-inl.h"
#include "kernel/scene_view.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

// What a path has passed since its last diffuse vertex. Light that it finds at the end of a sampled chain was sampled
// at that vertex and counts zero. The ball is the sphere that the ray leaves, so that the path need not store it.
inline constexpr unsigned kNoChain = 0;      ///< the camera, another lobe, or another sequence of events
inline constexpr unsigned kFromDiffuse = 1;  ///< nothing
inline constexpr unsigned kInside = 2;       ///< inside a ball, since it was refracted into it
inline constexpr unsigned kInsideTwice = 3;  ///< inside a ball, reflected once
inline constexpr unsigned kCompleted = 4;    ///< a chain that is sampled, if the ball and the light are a pair

/// Lanes whose lobe is diffuse; their light by way of balls is sampled.
template <class D>
HWY_INLINE hn::Mask<D> is_diffuse(D d, const Surface<D>& at) {
  return hn::Or(is_kind(d, at.kind, MaterialKind::kLambertian),
                hn::Or(is_kind(d, at.kind, MaterialKind::kHemisphere), is_kind(d, at.kind, MaterialKind::kPlastic)));
}

/// The chain of paths after a surface has scattered them. The surface is passed by value: a reference to it would keep
/// it in memory in scenes without caustics too.
///
/// `chain`    before
/// `is_self`  the surface is that of the sphere that the ray has left
/// `diffuse`  lanes in which a diffuse lobe has scattered
template <class D>
HWY_NOINLINE hn::Vec<IdTag<D>> continued_chain(D d, hn::Vec<IdTag<D>> chain, Surface<D> at, Vec3<hn::Vec<D>> direction,
                                               hn::Mask<D> is_self, hn::Mask<D> diffuse) {
  const IdTag<D> du;
  const auto was = [&](unsigned state) { return hn::RebindMask(d, chain == state); };
  const auto sharp = hn::And(is_delta(d, at), at.fuzz == 0);
  const auto transmits = is_transmitted(d, at, direction), reflects = hn::Not(transmits);
  const auto enters = hn::And(hn::And(sharp, was(kFromDiffuse)), at.from_outside);
  const auto within = hn::And(hn::And(sharp, is_self), hn::Or(was(kInside), was(kInsideTwice)));
  const auto completes = hn::Or(hn::And(enters, reflects), hn::And(within, transmits));
  auto out = hn::Zero(du);
  const auto put = [&](hn::Mask<D> lanes, unsigned state) {
    out = select(hn::RebindMask(du, lanes), set(du, state), out);
  };
  put(completes, kCompleted);
  put(hn::And(enters, transmits), kInside);
  put(hn::And(hn::And(within, reflects), was(kInside)), kInsideTwice);
  put(diffuse, kFromDiffuse);
  return out;
}

/// Lanes in which ball and light are a pair.
///
/// `lights`   ids of emitters; kNoSphere: the sun
template <class D>
HWY_NOINLINE hn::Mask<D> are_paired(D d, const Caustics& caustics, hn::Mask<D> lanes, hn::Vec<IdTag<D>> balls,
                                    hn::Vec<IdTag<D>> lights) {
  using T = hn::TFromD<D>;
  HWY_ALIGN hn::TFromD<IdTag<D>> ball[hn::MaxLanes(D())], light[hn::MaxLanes(D())];
  HWY_ALIGN T found[hn::MaxLanes(D())] = {};
  hn::Store(balls, IdTag<D>(), ball);
  hn::Store(lights, IdTag<D>(), light);
  each_lane(d, lanes, [&](int i) {
    const auto sphere = static_cast<std::uint32_t>(ball[i]), to = static_cast<std::uint32_t>(light[i]);
    found[i] = caustics.has(sphere, to) ? T(1) : T(0);
  });
  return hn::Load(d, found) != 0;
}

/// Lanes whose paths have completed a sampled chain to these lights.
template <class D>
HWY_INLINE hn::Mask<D> is_sampled_caustic(D d, const SceneView& scene, hn::Mask<D> lanes, hn::Vec<IdTag<D>> chain,
                                          hn::Vec<IdTag<D>> balls, hn::Vec<IdTag<D>> lights) {
  const auto completed = hn::And(lanes, hn::RebindMask(d, chain == kCompleted));
  if (hn::AllFalse(d, completed)) return completed;
  return are_paired(d, scene.caustics, completed, balls, lights);
}

/// Removes the sun from the environment's radiance in lanes whose paths have completed a sampled chain to it.
template <class D, class V = hn::Vec<D>>
HWY_NOINLINE Vec3<V> without_sampled_sun(D d, const SceneView& scene, Vec3<V> radiance, Vec3<V> direction,
                                         hn::Mask<D> missed, hn::Vec<IdTag<D>> chain, hn::Vec<IdTag<D>> balls) {
  const Environment& environment = *scene.environment;
  if (!environment.has_sun) return radiance;
  const auto in_sun = hn::And(missed, is_in_sun(d, environment, direction));
  const auto sampled = is_sampled_caustic(d, scene, in_sun, chain, balls, set(IdTag<D>(), kNoSphere));
  if (hn::AllFalse(d, sampled)) return radiance;
  auto at = environment_footprint(d, environment, direction);
  at.is_in_sun = hn::AndNot(sampled, at.is_in_sun);
  return select(sampled, radiance_of(d, environment, at), radiance);
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
