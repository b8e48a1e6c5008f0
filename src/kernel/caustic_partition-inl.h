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

// CausticState: what a path has passed since its last diffuse vertex. Light that it finds at the end of a sampled chain
// was sampled at that vertex and counts zero. The ball is the sphere that the ray leaves, so that the path need not
// store it.
inline constexpr unsigned kOther = 0;        ///< the camera, another lobe, or another sequence of events
inline constexpr unsigned kFromDiffuse = 1;  ///< nothing
inline constexpr unsigned kInside = 2;       ///< inside a ball, since it was refracted into it
inline constexpr unsigned kInsideTwice = 3;  ///< inside a ball, reflected once
inline constexpr unsigned kCompleted = 4;    ///< a chain that is sampled, if the ball and the light are a pair
inline constexpr unsigned kInVoid = 5;       ///< inside the void of a hollow ball
inline constexpr unsigned kFromVoid = 6;     ///< in the glass of a hollow ball, after the void

/// Lanes whose lobe is diffuse; their light by way of balls is sampled.
template <class D>
HWY_INLINE hn::Mask<D> is_diffuse(D d, const Surface<D>& at) {
  return hn::Or(is_kind(d, at.kind, MaterialKind::kLambertian),
                hn::Or(is_kind(d, at.kind, MaterialKind::kHemisphere), is_kind(d, at.kind, MaterialKind::kPlastic)));
}

/// Lanes in which a relation holds between two ids.
template <class D, class Holds>
HWY_INLINE hn::Mask<D> related(D d, hn::Mask<D> lanes, hn::Vec<IdTag<D>> first, hn::Vec<IdTag<D>> second, Holds holds) {
  using T = hn::TFromD<D>;
  HWY_ALIGN hn::TFromD<IdTag<D>> a[hn::MaxLanes(D())], b[hn::MaxLanes(D())];
  HWY_ALIGN T found[hn::MaxLanes(D())] = {};
  hn::Store(first, IdTag<D>(), a);
  hn::Store(second, IdTag<D>(), b);
  each_lane(d, lanes, [&](int i) {
    found[i] = holds(static_cast<std::uint32_t>(a[i]), static_cast<std::uint32_t>(b[i])) ? T(1) : T(0);
  });
  return hn::Load(d, found) != 0;
}

/// Lanes in which an id is that of a hollow ball and the other that of its inner sphere.
template <class D>
HWY_NOINLINE hn::Mask<D> are_hollow(D d, const Caustics& caustics, hn::Mask<D> lanes, hn::Vec<IdTag<D>> balls,
                                    hn::Vec<IdTag<D>> inner) {
  return related(d, lanes, balls, inner, [&](std::uint32_t a, std::uint32_t b) { return caustics.is_hollow(a, b); });
}

/// The states of paths before a hit, and the objects of the hit.
template <class D>
struct CausticHit {
  hn::Vec<IdTag<D>> state;
  hn::Vec<IdTag<D>> self;  ///< object that the ray has left
  hn::Vec<IdTag<D>> hit;
};

/// The states of paths after a surface has scattered them. The surface is passed by value: a reference to it would keep
/// it in memory in scenes without caustics too.
///
/// `diffuse`  lanes in which a diffuse lobe has scattered
template <class D>
HWY_NOINLINE hn::Vec<IdTag<D>> continued_state(D d, const Caustics& caustics, CausticHit<D> before, Surface<D> at,
                                               Vec3<hn::Vec<D>> direction, hn::Mask<D> diffuse) {
  const IdTag<D> du;
  const auto sharp = hn::And(is_delta(d, at), at.fuzz == 0), is_self = hn::RebindMask(d, before.self == before.hit);
  const auto was = [&](unsigned state) { return hn::And(sharp, hn::RebindMask(d, before.state == state)); };
  const auto transmits = is_transmitted(d, at, direction), reflects = hn::Not(transmits);
  const auto enters = hn::And(was(kFromDiffuse), at.from_outside);
  const auto within = hn::And(is_self, hn::Or(was(kInside), was(kInsideTwice)));
  const auto from_glass = hn::AndNot(at.from_outside, was(kFromDiffuse));
  const auto completes = hn::Or(hn::And(enters, reflects), hn::And(hn::Or(within, from_glass), transmits));
  auto out = hn::Zero(du);
  const auto put = [&](hn::Mask<D> lanes, unsigned state) {
    out = select(hn::RebindMask(du, lanes), set(du, state), out);
  };
  put(completes, kCompleted);
  put(hn::And(enters, transmits), kInside);
  put(hn::And(hn::And(within, reflects), was(kInside)), kInsideTwice);
  if (caustics.has_hollow) {
    const auto to_void = hn::And(hn::AndNot(is_self, was(kInside)), at.from_outside);
    const auto to_ball = hn::AndNot(at.from_outside, hn::AndNot(is_self, was(kFromVoid)));
    const auto at_void = are_hollow(d, caustics, to_void, before.self, before.hit);
    const auto at_ball = are_hollow(d, caustics, to_ball, before.hit, before.self);
    put(hn::And(at_void, transmits), kInVoid);
    put(hn::Or(hn::And(at_void, reflects), hn::And(hn::And(is_self, was(kInVoid)), transmits)), kFromVoid);
    put(hn::And(at_ball, transmits), kCompleted);
  }
  put(diffuse, kFromDiffuse);
  return out;
}

/// Lanes in which ball and light are a pair.
///
/// `lights`   ids of emitters, or kSun
template <class D>
HWY_NOINLINE hn::Mask<D> are_paired(D d, const Caustics& caustics, hn::Mask<D> lanes, hn::Vec<IdTag<D>> balls,
                                    hn::Vec<IdTag<D>> lights) {
  return related(d, lanes, balls, lights, [&](std::uint32_t a, std::uint32_t b) { return caustics.has(a, b); });
}

/// Lanes whose paths have completed a sampled chain to these lights.
template <class D>
HWY_INLINE hn::Mask<D> is_sampled_caustic(D d, const SceneView& scene, hn::Mask<D> lanes, hn::Vec<IdTag<D>> state,
                                          hn::Vec<IdTag<D>> balls, hn::Vec<IdTag<D>> lights) {
  const auto completed = hn::And(lanes, hn::RebindMask(d, state == kCompleted));
  if (hn::AllFalse(d, completed)) return completed;
  return are_paired(d, scene.caustics, completed, balls, lights);
}

/// Removes the sun from the environment's radiance in lanes whose paths have completed a sampled chain to it.
template <class D, class V = hn::Vec<D>>
HWY_NOINLINE Vec3<V> without_sampled_sun(D d, const SceneView& scene, Vec3<V> radiance, Vec3<V> direction,
                                         hn::Mask<D> missed, hn::Vec<IdTag<D>> state, hn::Vec<IdTag<D>> balls) {
  const Environment& environment = *scene.environment;
  if (!environment.has_sun) return radiance;
  const auto in_sun = hn::And(missed, is_in_sun(d, environment, direction));
  const auto sampled = is_sampled_caustic(d, scene, in_sun, state, balls, set(IdTag<D>(), kSun));
  if (hn::AllFalse(d, sampled)) return radiance;
  auto at = environment_footprint(d, environment, direction);
  at.is_in_sun = hn::AndNot(sampled, at.is_in_sun);
  return select(sampled, radiance_of(d, environment, at), radiance);
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
