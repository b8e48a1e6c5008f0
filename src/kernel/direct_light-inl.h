// SPDX-License-Identifier: Apache-2.0
// Direct light: next-event estimation with shadow rays, and its weights.
#pragma once

#include <hwy/highway.h>

#include <algorithm>
#include <limits>

#include "kernel/deposit-inl.h"
#include "kernel/environment-inl.h"
#include "kernel/gather-inl.h"
#include "kernel/light-inl.h"
#include "kernel/opacity-inl.h"
#include "kernel/path_record.h"
#include "kernel/path_stream.h"
#include "kernel/record-inl.h"
#include "kernel/rod_light-inl.h"
#include "kernel/scatter-inl.h"
#include "kernel/surface-inl.h"
#include "kernel/surface_texture-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

// Weights of the power heuristic in one variable: x is the density of BSDF sampling divided by that of light sampling.
// The product of BSDF and cosine is albedo times the density, so a light sample contributes albedo * radiance * x, and
// nothing is divided by a density. With the heuristic's weights, no sample exceeds albedo * radiance. Plastic has two
// such products, of base and coat. Each has its own densities and weights, and one shadow ray serves both.
// Reference: veach1995.

/// The weight of albedo times radiance for light samples: x / (1 + x^2), and x if only lights are sampled.
template <class V>
HWY_INLINE V light_sample_factor(DirectLighting mode, V x) {
  return mode == DirectLighting::kLight ? x : 1 / (x + 1 / x);
}

/// The weight of light that a BSDF sample finds: 1 / (1 + 1 / x^2), and 0 if only lights are sampled.
///
/// `inverse`  1 / x; 0 where light sampling cannot find the light
template <class D, class V = hn::Vec<D>>
HWY_INLINE V bsdf_sample_weight(D d, DirectLighting mode, V inverse) {
  const V one = set(d, 1);
  if (mode == DirectLighting::kLight) return select(inverse > 0, 0, one);
  return 1 / mul_add(inverse, inverse, 1);
}

/// Radiance and light group of emitters, one per lane.
template <class D>
struct Emitted {
  Vec3<hn::Vec<D>> radiance;
  hn::Vec<IdTag<D>> group;
};

/// Emission of the spheres and rods in the lanes of `hit`; that of id 0 in the others.
///
/// Domain     scene.emission is not null
template <class D>
HWY_INLINE Emitted<D> emitted(D d, const SceneView& scene, hn::Vec<IdTag<D>> hits, hn::Mask<D> hit) {
  using Id = hn::TFromD<IdTag<D>>;
  const IdTag<D> du;
  HWY_ALIGN Id id[hn::MaxLanes(D())], group[hn::MaxLanes(D())];
  hn::Store(hn::IfThenElseZero(hn::RebindMask(du, hit), hits), du, id);
  hn::Vec<D> rgb[4];
  const auto emission = [&](std::size_t i) -> const Emission& { return scene.emission[scene.object_materials[id[i]]]; };
  gather4(
      d, [&](std::size_t i) { return emission(i).radiance; }, rgb);
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) group[i] = static_cast<Id>(emission(i).group);
  return {{rgb[0], rgb[1], rgb[2]}, hn::Load(du, group)};
}

/// True if vertices send shadow rays.
inline bool samples_lights(const SceneView& scene) {
  return scene.direct_lighting != DirectLighting::kBsdf &&
         (scene.lights.count > 0 || (scene.environment != nullptr && scene.environment->is_sampled));
}

/// The probability that light sampling chooses the environment instead of an emitter.
///
/// Which of the two contributes more at a vertex is unknown without shadow rays, so both are equally likely.
inline double environment_share(const SceneView& scene) {
  if (scene.environment == nullptr || !scene.environment->is_sampled) return 0;
  return scene.lights.count > 0 ? 0.5 : 1;
}

/// True if vertices choose between several lights.
inline bool chooses_light(const SceneView& scene) {
  return scene.lights.count > 1 || (scene.lights.count == 1 && environment_share(scene) > 0);
}

/// The radiance of the environment along rays with a sampled direction, with its weight.
///
/// `pdf`      density of the direction; infinite for delta materials
template <class D, class V = hn::Vec<D>>
HWY_NOINLINE Vec3<V> weighted_environment(D d, const SceneView& scene, Vec3<V> direction, V pdf) {
  const Environment& environment = *scene.environment;
  const auto at = environment_footprint(d, environment, direction);
  const auto radiance = radiance_of(d, environment, at);
  if (scene.direct_lighting == DirectLighting::kBsdf || !environment.is_sampled) return radiance;
  const V light_pdf = pdf_of(d, environment, at) * environment_share(scene);
  // Rounding may make both densities 0.
  const V inverse = hn::IfThenElseZero(light_pdf > 0, light_pdf / pdf);
  return radiance * bsdf_sample_weight(d, scene.direct_lighting, inverse);
}

/// The weight of emitters that rays with a sampled direction have hit.
///
/// `at`       where the rays start
/// `pdf`      density of the direction; infinite for delta materials
template <class D, class V = hn::Vec<D>>
HWY_NOINLINE V emitter_weight(D d, const SceneView& scene, const Vertex<D>& at, Vec3<V> direction,
                              hn::Vec<IdTag<D>> hits, V pdf) {
  using T = hn::TFromD<D>;
  const V one = set(d, 1);
  if (scene.direct_lighting == DirectLighting::kBsdf || scene.lights.count == 0) return one;
  const auto sphere = load_spheres(d, scene, hits, at.times);
  const auto cone = subtended_cone(to_center(at, sphere.center), sphere.radius);
  const V probability = choice_probability(d, scene, at, hits) * (1 - environment_share(scene));
  V inverse_pdf = hn::IfThenElseZero(cone.distance > sphere.radius, solid_angle(cone.one_minus_cos));
  if (!scene.rods.empty()) inverse_pdf = with_rods(d, scene, at, direction, hits, inverse_pdf);
  const auto can_sample = hn::And(hn::And(inverse_pdf > 0, probability > 0), pdf < std::numeric_limits<T>::infinity());
  const V inverse = hn::IfThenElseZero(can_sample, probability / (pdf * inverse_pdf));
  return bsdf_sample_weight(d, scene.direct_lighting, inverse);
}

/// Light samples, one per lane.
template <class D>
struct LightSample {
  using V = hn::Vec<D>;
  Vec3<V> direction;  ///< unit
  Vec3<V> reach;      ///< vector to the sampled point; any length for an environment
  V distance;         ///< maximum distance of an occluder, as a multiple of the length of `reach`
  V inverse_pdf;      ///< steradians, excluding the probability of choosing the light
  V probability;      ///< probability of choosing the light; 0: no light can be sampled
  Vec3<V> radiance;
  hn::Vec<IdTag<D>> target;  ///< id of the emitter, or kNone
  hn::Vec<IdTag<D>> group;   ///< light group
};

/// Chooses an emitter for each vertex and samples a point that is visible from it.
///
/// `random`   two numbers for the point, two for the choice
template <class D, class V = hn::Vec<D>>
HWY_NOINLINE LightSample<D> sample_emitter(D d, const SceneView& scene, const Vertex<D>& at, const Four<V>& random) {
  const V one = set(d, 1);
  const auto chosen = choose_light(d, scene, at, random.v[2], random.v[3]);
  const auto light = load_spheres(d, scene, chosen.spheres, at.times);
  const auto to = to_center(at, light.center);
  const auto cone = subtended_cone(to, light.radius);
  const auto on_sphere = sample_visible_sphere(d, to, cone, random.v[0], random.v[1]);
  LampPoint<D> point{cone.distance > light.radius,
                     on_sphere.direction,
                     mul_add(on_sphere.normal, light.radius, to),
                     on_sphere.normal,
                     light.center,
                     cone.distance,
                     light.radius,
                     solid_angle(cone.one_minus_cos)};
  if (!scene.rods.empty()) point = with_rods(d, scene, at, chosen.spheres, point, random.v[0], random.v[1]);
  auto source = emitted(d, scene, chosen.spheres, hn::FirstN(d, hn::Lanes(d)));
  if (scene.textures != nullptr) {
    const V width2 = at.cone.width2_at(point.distance);
    source.radiance = textured_radiance(
        d, scene, chosen.spheres,
        {point.center, point.normal * point.radius, point.normal, width2 / (point.radius * point.radius)},
        source.radiance);
  }
  return {point.direction,
          point.reach,
          one,
          point.inverse_pdf,
          hn::IfThenElseZero(point.is_visible, chosen.probability),
          source.radiance,
          chosen.spheres,
          source.group};
}

/// Samples a direction towards the environment.
template <class D, class V = hn::Vec<D>>
HWY_NOINLINE LightSample<D> sample_background(D d, const Environment& environment, V u, V v) {
  using T = hn::TFromD<D>;
  const IdTag<D> du;
  const auto sample = sample_environment(d, environment, u, v);
  return {sample.direction, sample.direction, hn::Set(d, std::numeric_limits<T>::max()), sample.inverse_pdf, set(d, 1),
          sample.radiance,  set(du, kNone),   set(du, environment.light_group)};
}

/// Samples the environment or an emitter at each vertex.
template <class D, class V = hn::Vec<D>>
HWY_NOINLINE LightSample<D> sample_light(D d, const SceneView& scene, const Vertex<D>& at, const Four<V>& random) {
  const double share = environment_share(scene);
  if (share == 1) return sample_background(d, *scene.environment, random.v[0], random.v[1]);
  if (share == 0) return sample_emitter(d, scene, at, random);
  const V to_background = set(d, share), to_emitter = set(d, 1 - share);
  const auto is_background = random.v[2] < to_background;
  const V rest = hn::IfThenElseZero(hn::Not(is_background), (random.v[2] - to_background) / to_emitter);
  const auto sky = sample_background(d, *scene.environment, random.v[0], random.v[1]);
  const auto lamp = sample_emitter(d, scene, at, Four<V>{{random.v[0], random.v[1], rest, random.v[3]}});
  const auto ids = hn::RebindMask(IdTag<D>(), is_background);
  return {select(is_background, sky.direction, lamp.direction),
          select(is_background, sky.reach, lamp.reach),
          select(is_background, sky.distance, lamp.distance),
          select(is_background, sky.inverse_pdf, lamp.inverse_pdf),
          select(is_background, to_background, lamp.probability * to_emitter),
          select(is_background, sky.radiance, lamp.radiance),
          select(ids, sky.target, lamp.target),
          select(ids, sky.group, lamp.group)};
}

/// Fills a packet with `count` waiting rays from `first` on.
template <class D, class Waiting, class Packet>
HWY_INLINE void load_waiting_rays(D d, const SceneView& scene, const Waiting& rays, int first, int count,
                                  Packet& packet) {
  const IdTag<D> du;
  packet.count = count;
  for (int v = 0; v < count; v += static_cast<int>(hn::Lanes(d))) {
    const int i = first + v;
    store_rays(d, loadu3(d, rays.base, i), loadu3(d, rays.offset, i), loadu3(d, rays.direction, i),
               hn::LoadU(du, rays.self + i), packet, v);
    if constexpr (Packet::kIsShadow) {
      hn::Store(hn::LoadU(d, rays.distance + i), d, packet.distance + v);
      hn::Store(hn::LoadU(du, rays.target + i), du, packet.target + v);
    }
    if (scene.features.motion) hn::Store(hn::LoadU(d, rays.time + i), d, packet.time + v);
    if (scene.features.opacity) store_floats(d, hn::LoadU(d, rays.threshold + i), packet.threshold + v);
  }
}

/// The recorder of paths, by their indices within the batch; undefined in other lanes.
template <class D>
HWY_INLINE Recorder<D> recorder_of(D d, const SceneView& scene, const Tile& tile, const BatchOf<hn::TFromD<D>>& batch,
                                   hn::Mask<D> lanes, const hn::TFromD<IdTag<D>>* path) {
  using Id = hn::TFromD<IdTag<D>>;
  const IdTag<D> du;
  HWY_ALIGN Id pixel[hn::MaxLanes(D())] = {}, sample[hn::MaxLanes(D())] = {};
  each_lane(d, lanes, [&](int lane) {
    pixel[lane] = batch.pixel[path[lane]];
    sample[lane] = batch.sample[path[lane]];
  });
  return {scene, tile, hn::Load(du, pixel), hn::Load(du, sample)};
}

/// Adds the light of the unoccluded rays of a packet, the waiting ones from `first` on, to their paths.
template <class D, class Packet>
HWY_INLINE void add_unoccluded(D d, const SceneView& scene, const Tile& tile, const Packet& packet, int first,
                               PathsOf<hn::TFromD<D>>& to) {
  const IdTag<D> du;
  const auto& shadow = to.shadow;
  for (int v = 0; v < packet.count; v += static_cast<int>(hn::Lanes(d))) {
    const int i = first + v;
    const auto active = hn::FirstN(d, static_cast<std::size_t>(packet.count - v));
    const auto is_free = hn::RebindMask(d, hn::Load(du, packet.occluded + v) == 0);
    const auto lanes = hn::And(active, is_free);
    if (hn::AllFalse(d, lanes)) continue;
    const auto light = loadu3(d, shadow.value, i);
    const auto paths = hn::LoadU(du, shadow.path + i);
    gain(d, lanes, light, paths, to.batch);
    if (!tile.has_events()) continue;
    auto record = recorder_of(d, scene, tile, to.batch, lanes, shadow.path + i);
    const auto unscattered = Lobe::kEmission;
    const auto history = hn::LoadU(du, shadow.history + i), group = hn::LoadU(du, shadow.group + i);
    const auto in_coat = hn::And(lanes, hn::RebindMask(d, hn::And(history, set(du, kCoatBit)) != 0));
    if (hn::AllFalse(d, in_coat)) {
      record.event(d, lanes, light, history, group, unscattered);
    } else {
      const auto coat = masked(in_coat, loadu3(d, shadow.coat, i));
      record.event(d, lanes, light - coat, history, group, unscattered);
      record.event(d, in_coat, coat, hn::LoadU(du, shadow.coat_history + i), group, unscattered);
    }
  }
}

/// Traces the last batch of the waiting shadow rays.
template <class D>
HWY_INLINE void trace_shadow_batch(D d, const SceneView& scene, const Tracer& tracer, const Tile& tile,
                                   PathsOf<hn::TFromD<D>>& paths, TileCounts& counts) {
  auto& shadow = paths.shadow;
  const int batch = std::min(shadow.count, shadow.kBatch);
  shadow.count -= batch;
  counts.rays += static_cast<std::uint64_t>(batch);
  const auto each_packet = [&](auto what) {
    for (int i = 0; i * kPacketSize < batch; ++i) what(shadow.packets[i], i * kPacketSize);
  };
  each_packet([&](auto& packet, int begin) {
    load_waiting_rays(d, scene, shadow, shadow.count + begin, std::min(kPacketSize, batch - begin), packet);
  });
  occlude(tracer, shadow.packets, (batch + kPacketSize - 1) / kPacketSize);
  each_packet(
      [&](const auto& packet, int begin) { add_unoccluded(d, scene, tile, packet, shadow.count + begin, paths); });
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
