// SPDX-License-Identifier: Apache-2.0
// Transport of caustics: rays by way of balls to a light, and paths that find such light themselves.
#pragma once

#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>

#include "kernel/caustic_sampling-inl.h"
#include "kernel/caustics.h"
#include "kernel/deposit-inl.h"
#include "kernel/environment-inl.h"
#include "kernel/gather-inl.h"
#include "kernel/path_stream.h"
#include "kernel/record-inl.h"
#include "kernel/scatter-inl.h"
#include "kernel/scene_view.h"
#include "kernel/surface-inl.h"

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

/// The states of paths after a surface has scattered them. Not inlined.
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

/// Follows caustic rays.
template <class D, Precision kPrecision>
class CausticRayTracer {
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  using Ids = hn::Vec<IdTag<D>>;

 public:
  HWY_INLINE CausticRayTracer(const SceneView& scene, const Tile& tile, PathsOf<T>& paths)
      : scene_(scene),
        tile_(tile),
        packet_(paths.caustic_rays.packet),
        batch_(paths.batch),
        rays_(paths.caustic_rays) {}

  /// Traces the last packet of the waiting rays. Those that have reached their light add it to their paths, and those
  /// that the ball reflects or transmits wait again.
  ///
  /// Result     number of rays traced
  HWY_INLINE int trace(const Tracer& tracer) {
    const int count = std::min(rays_.count, kPacketSize);
    const int first = rays_.count - count;
    load_waiting_rays(d, scene_, rays_, first, count, packet_);
    reset_hits(packet_);
    kernel::trace(tracer, packet_);
    // Rays that go on overwrite rays that have been read.
    rays_.count = first;
    for (int v = 0; v < count; v += static_cast<int>(hn::Lanes(d))) follow(first, v);
    return count;
  }

 private:
  static constexpr D d{};
  static constexpr IdTag<D> du{};

  HWY_INLINE void follow(int first, int v) {
    const int i = first + v;
    const auto active = hn::FirstN(d, static_cast<std::size_t>(packet_.count - v));
    const auto hits = hn::Load(du, packet_.hit + v);
    const auto events = hn::LoadU(du, rays_.events + i), light = hn::LoadU(du, rays_.light + i);
    const auto is_last = hn::RebindMask(d, events == 0);
    const auto ray = load_rays(d, packet_, v);
    auto arrived = hn::And(active, hn::And(is_last, hn::RebindMask(d, hits == light)));
    if (scene_.environment != nullptr && scene_.environment->has_sun) {
      const auto sees_sun = is_in_sun(d, *scene_.environment, ray.direction);
      arrived = hn::And(arrived, hn::Or(sees_sun, hn::RebindMask(d, light != kSun)));
    }
    if (!hn::AllFalse(d, arrived)) arrive(i, arrived);
    const auto at_void = hn::And(events, set(du, kAtVoid)) != 0;
    const auto expected = select(at_void, hn::LoadU(du, rays_.inner + i), hn::LoadU(du, rays_.ball + i));
    const auto scattered = hn::And(hn::AndNot(is_last, active), hn::RebindMask(d, hits == expected));
    if (!hn::AllFalse(d, scattered)) scatter(i, v, ray, hits, events, scattered);
  }

  /// Adds light to paths.
  HWY_INLINE void arrive(int i, hn::Mask<D> lanes) {
    const auto value = loadu3(d, rays_.value, i);
    gain(d, lanes, value, hn::LoadU(du, rays_.path + i), batch_);
    if (!tile_.has_events()) return;
    recorder_of(d, scene_, tile_, batch_, lanes, rays_.path + i)
        .event(d, lanes, value, hn::LoadU(du, rays_.history + i), hn::LoadU(du, rays_.group + i), Lobe::kEmission);
  }

  /// Applies the next event of each chain.
  HWY_INLINE void scatter(int i, int v, const Rays<D>& ray, Ids hits, Ids events, hn::Mask<D> lanes) {
    const T* const times = scene_.features.motion ? packet_.time + v : nullptr;
    const auto look = reach_surface<D, kPrecision>(d, scene_, ray, hits, hn::Load(d, packet_.distance + v), times);
    const Surface<D>& surface = look.surface;
    // Rays reach a sphere from inside if they have left it, or if its refraction is the last event.
    const auto leaves = hn::RebindMask(d, events == hn::Set(du, kTransmit));
    const auto is_within = hn::Or(hn::RebindMask(d, hits == ray.self), leaves);
    const auto is_on_side = hn::Xor(surface.from_outside, is_within);
    const auto reflects = hn::RebindMask(d, hn::And(events, set(du, kReflect)) != 0);
    const auto glass = refraction(d, surface);
    const V reflected_part = select(glass.is_total, 1, glass.reflectance);
    V part = select(reflects, reflected_part, 1 - reflected_part);
    auto is_glass = has_trait<&MaterialTraits::transmits>(d, surface);
    if (scene_.features.rich_materials) {
      const auto is_coat = is_kind(d, surface.kind, MaterialKind::kPlastic);
      part = select(is_coat, coat_share(surface), part);
      is_glass = hn::Or(is_glass, is_coat);
    }
    auto value = loadu3(d, rays_.value, i);
    value = select(is_glass, value * part, value * look.albedo);
    const auto direction = select(reflects, reflected(surface), glass.direction);
    const auto goes_on = hn::And(hn::And(lanes, is_on_side), hn::Or(hn::Not(is_glass), part > 0));
    const int to = rays_.count;
    const Compactor<D> compactor(d, goes_on);
    const auto keep = [&](auto& array) { compactor.store_ids(d, hn::LoadU(du, array + i), array + to); };
    compactor.store3(d, look.sphere.center, rays_.base, to);
    compactor.store3(d, surface.offset, rays_.offset, to);
    compactor.store3(d, direction, rays_.direction, to);
    compactor.store3(d, value, rays_.value, to);
    compactor.store_ids(d, hits, rays_.self + to);
    compactor.store_ids(d, hn::ShiftRight<kCausticEventBits>(events), rays_.events + to);
    if (scene_.features.motion) compactor.store(d, hn::LoadU(d, rays_.time + i), rays_.time + to);
    if (scene_.features.opacity) compactor.store(d, hn::LoadU(d, rays_.threshold + i), rays_.threshold + to);
    keep(rays_.ball);
    keep(rays_.inner);
    keep(rays_.light);
    keep(rays_.path);
    if (tile_.has_events()) {
      keep(rays_.history);
      keep(rays_.group);
    }
    rays_.count += compactor.count();
  }

  const SceneView& scene_;
  const Tile& tile_;
  RayPacket<T>& packet_;
  BatchOf<T>& batch_;
  CausticRaysOf<T>& rays_;
};

/// Traces caustic rays until fewer than `waiting` wait. Not inlined.
template <class D, Precision kPrecision>
HWY_NOINLINE void trace_caustic_rays(const SceneView& scene, const Tracer& tracer, const Tile& tile,
                                     PathsOf<hn::TFromD<D>>& paths, int waiting, TileCounts& counts) {
  CausticRayTracer<D, kPrecision> rays(scene, tile, paths);
  while (paths.caustic_rays.count >= waiting) counts.rays += static_cast<std::uint64_t>(rays.trace(tracer));
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
