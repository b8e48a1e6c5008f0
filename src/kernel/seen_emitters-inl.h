// SPDX-License-Identifier: Apache-2.0
// Emitters that the camera sees, also in balls: rays to them, and camera rays that they are taken out of.
#pragma once

#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>

#include "kernel/camera-inl.h"
#include "kernel/caustic_sampling-inl.h"
#include "kernel/caustic_transport-inl.h"
#include "kernel/direct_light-inl.h"
#include "kernel/gather-inl.h"
#include "kernel/path_stream.h"
#include "kernel/record-inl.h"
#include "kernel/sampler-inl.h"
#include "kernel/scene_view.h"
#include "kernel/seen_emitter_sample.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// How paths have reached a light.
template <class D>
struct WayToLight {
  hn::Vec<IdTag<D>> state;  ///< CausticState; only if features.caustics
  hn::Vec<IdTag<D>> self;   ///< what the rays have left
  hn::Vec<IdTag<D>> pixels;
  hn::Mask<D> is_straight;  ///< from the camera, or reflected once by a surface that is delta
};

/// Those of the lanes whose light was sampled at a diffuse vertex or at the camera, so that it counts zero. Not
/// inlined.
///
/// `lights`   ids of emitters, or kSun
template <class D>
HWY_NOINLINE hn::Mask<D> are_sampled(D d, const SceneView& scene, hn::Mask<D> lanes, WayToLight<D> at,
                                     hn::Vec<IdTag<D>> lights) {
  auto out = hn::FirstN(d, 0);
  if (scene.features.caustics) out = is_sampled_caustic(d, scene, lanes, at.state, at.self, lights);
  if (scene.seen_emitters.begins == nullptr) return out;
  HWY_ALIGN hn::TFromD<IdTag<D>> pixel[hn::MaxLanes(D())], ball[hn::MaxLanes(D())], emitter[hn::MaxLanes(D())];
  HWY_ALIGN hn::TFromD<D> found[hn::MaxLanes(D())] = {};
  hn::Store(at.pixels, IdTag<D>(), pixel);
  hn::Store(at.self, IdTag<D>(), ball);
  hn::Store(lights, IdTag<D>(), emitter);
  each_lane(d, hn::And(lanes, at.is_straight), [&](int i) {
    const Sight sight{static_cast<std::uint32_t>(ball[i]), static_cast<std::uint32_t>(emitter[i])};
    found[i] = scene.seen_emitters.has(place_of(pixel[i], scene), sight) ? 1 : 0;
  });
  return hn::Or(out, hn::Load(d, found) != 0);
}

/// Removes the sun from the environment's radiance in lanes in which it was sampled. Not inlined.
template <class D, class V = hn::Vec<D>>
HWY_NOINLINE Vec3<V> without_sampled_sun(D d, const SceneView& scene, Vec3<V> radiance, Vec3<V> direction,
                                         hn::Mask<D> missed, WayToLight<D> from) {
  const Environment& environment = *scene.environment;
  if (!environment.has_sun) return radiance;
  const auto in_sun = hn::And(missed, is_in_sun(d, environment, direction));
  const auto sampled = are_sampled(d, scene, in_sun, from, set(IdTag<D>(), kSun));
  if (hn::AllFalse(d, sampled)) return radiance;
  auto at = environment_footprint(d, environment, direction);
  at.is_in_sun = hn::AndNot(sampled, at.is_in_sun);
  return select(sampled, radiance_of(d, environment, at), radiance);
}

/// Samples an emitter for each path of a batch whose pixel has any, and adds its light.
template <class D, Precision kPrecision>
class SeenEmitterSampler {
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;

 public:
  SeenEmitterSampler(const SceneView& scene, const Tracer& tracer, const Tile& tile, PathsOf<T>& paths,
                     TileCounts& counts)
      : scene_(scene), tracer_(tracer), tile_(tile), paths_(paths), counts_(counts) {}

  /// Not inlined.
  HWY_NOINLINE void sample(int count) {
    for (int v = 0; v < count; v += kLanes) {
      const int lanes = std::min(kLanes, count - v);
      bool any = false;
      for (int i = 0; i < lanes; ++i) any = any || !emitters(v + i).empty();
      if (!any) continue;
      draw(v);
      HWY_ALIGN T in_ball[kLanes] = {};
      for (int i = 0; i < lanes; ++i) {
        const auto all = emitters(v + i);
        if (all.empty()) continue;
        chosen_[i] = choose_seen_emitter(all, static_cast<double>(choice_[i]));
        if (chosen_[i].emitter.ball == kCamera)
          see(v + i, i);
        else
          in_ball[i] = 1;
      }
      reflect(v, hn::Load(d, in_ball) != 0);
      trace_caustic_rays<D, kPrecision>(scene_, tracer_, tile_, paths_, kPacketSize, counts_);
    }
    if (paths_.shadow.count > 0) trace_shadow_batch(d, scene_, tracer_, tile_, paths_, counts_);
    trace_caustic_rays<D, kPrecision>(scene_, tracer_, tile_, paths_, 1, counts_);
  }

 private:
  static constexpr D d{};
  static constexpr IdTag<D> du{};
  static constexpr int kLanes = static_cast<int>(hn::MaxLanes(D()));

  /// Of a path, by its index within the batch.
  std::span<const SeenEmitter> emitters(int path) const {
    return scene_.seen_emitters.at(place_of(paths_.batch.pixel[path], scene_));
  }

  /// Stores the random numbers of a vector of paths.
  void draw(int v) {
    const auto pixels = hn::Load(du, paths_.batch.pixel + v), samples = hn::Load(du, paths_.batch.sample + v);
    const auto random = random_at_vertex(d, scene_.sampler, pixels, samples, 0, scene_.features.lens);
    const auto second = second_random_at_vertex(d, scene_.sampler, pixels, samples, 0, true);
    const auto path = numbers_of_path(d, scene_.sampler, pixels, samples);
    const auto on_lens = sample_unit_disc(d, random.v[2], random.v[3]);
    const auto on_disc = sample_unit_disc(d, second.v[0], second.v[1]);
    for (int k = 0; k < 2; ++k) {
      hn::Store(random.v[k], d, film_[k]);
      hn::Store(second.v[k], d, other_[k]);
    }
    hn::Store(on_lens.x, d, lens_[0]);
    hn::Store(on_lens.y, d, lens_[1]);
    hn::Store(on_disc.x, d, disc_[0]);
    hn::Store(on_disc.y, d, disc_[1]);
    hn::Store(second.v[2], d, choice_);
    hn::Store(second.v[3], d, piece_);
    hn::Store(path.time, d, time_);
    hn::Store(path.threshold, d, threshold_);
  }

  /// Samples a ray to an emitter.
  void see(int path, int lane) {
    double pixel[2];
    center_of_pixel(path, pixel);
    SeenEmitterNumbers numbers;
    for (int k = 0; k < 2; ++k) {
      numbers.film[k] = static_cast<double>(film_[k][lane]);
      numbers.lens[k] = static_cast<double>(lens_[k][lane]);
      numbers.other[k] = static_cast<double>(other_[k][lane]);
      numbers.disc[k] = static_cast<double>(disc_[k][lane]);
    }
    const SeenEmitter& emitter = chosen_[lane].emitter;
    const SeenEmitterSample sample = sample_seen_emitter(scene_, emitter, pixel, numbers);
    if (!(sample.weight > 0)) return;
    auto& shadow = paths_.shadow;
    const int n = wait(path, lane, sample, 0, shadow);
    shadow.distance[n] = 1;
    shadow.target[n] = emitter.id;
    if (shadow.count == shadow.kBatch) trace_shadow_batch(d, scene_, tracer_, tile_, paths_, counts_);
  }

  /// Samples rays to the images of emitters in balls, from points of the lens, as at diffuse vertices.
  void reflect(int v, hn::Mask<D> in_ball) {
    const auto first = hn::FindFirstTrue(d, in_ball);
    if (first < 0) return;
    CausticChoice<D> pairs;
    for (int i = 0; i < kLanes; ++i) pairs.inner[i] = kNone;
    const auto set_pair = [&](int to, const SeenEmitter& from) {
      pairs.ball[to] = from.ball;
      pairs.light[to] = from.id;
    };
    for (int i = 0; i < kLanes; ++i) set_pair(i, chosen_[first].emitter);  // in other lanes any pair will do
    each_lane(d, in_ball, [&](int i) { set_pair(i, chosen_[i].emitter); });
    const auto offset = mul_add(set3(d, scene_.camera.lens_u), hn::Load(d, lens_[0]),
                                set3(d, scene_.camera.lens_v) * hn::Load(d, lens_[1]));
    const auto base = set3(d, scene_.camera.origin), origin = base + offset;
    const Vertex<D> at{origin, sum_error(base, offset, origin), offset};
    const auto sample = sample_caustic(d, load_pairs(d, scene_, at, pairs), 1, in_ball, hn::Load(d, other_[0]),
                                       hn::Load(d, other_[1]), hn::Load(d, piece_));
    HWY_ALIGN T inverse_pdf[kLanes], start[3][kLanes], direction[3][kLanes];
    hn::Store(sample.inverse_pdf, d, inverse_pdf);
    store3(d, offset, start, 0);
    store3(d, sample.direction, direction, 0);
    each_lane(d, hn::And(in_ball, sample.inverse_pdf > 0), [&](int i) {
      const auto vector = [i](const T(&from)[3][kLanes]) {
        return math::Vec3d{static_cast<double>(from[0][i]), static_cast<double>(from[1][i]),
                           static_cast<double>(from[2][i])};
      };
      double pixel[2];
      center_of_pixel(v + i, pixel);
      SeenEmitterSample ray{vector(start), vector(direction)};
      ray.weight = static_cast<double>(inverse_pdf[i]) * camera_ray_density(scene_, pixel, ray.offset, ray.reach);
      if (!(ray.weight > 0)) return;
      auto& rays = paths_.caustic_rays;
      const int n = wait(v + i, i, ray, kSpecular, rays);
      rays.events[n] = kCausticEvents[kReflection];
      rays.ball[n] = chosen_[i].emitter.ball;
      rays.inner[n] = kNone;
      rays.light[n] = chosen_[i].emitter.id;
    });
  }

  void center_of_pixel(int path, double (&to)[2]) const {
    const PixelPlace place = place_of(paths_.batch.pixel[path], scene_);
    to[0] = place.x + 0.5 - scene_.camera.half_width;
    to[1] = place.y + 0.5 - scene_.camera.half_height;
  }

  /// Appends a ray from the camera.
  ///
  /// Result     its index
  template <class Waiting>
  int wait(int path, int lane, const SeenEmitterSample& sample, unsigned history, Waiting& rays) const {
    const auto& [emitter, probability] = chosen_[lane];
    Emission emission;
    if (emitter.id == kSun) {
      math::set(emission.radiance, scene_.environment->sun_radiance);
      emission.group = scene_.environment->light_group;
    } else {
      emission = scene_.emission[scene_.object_materials[emitter.id]];
    }
    const math::Vec3d& origin = scene_.camera.origin;
    const double base[3] = {origin.x, origin.y, origin.z},
                 offset[3] = {sample.offset.x, sample.offset.y, sample.offset.z},
                 reach[3] = {sample.reach.x, sample.reach.y, sample.reach.z};
    const int n = rays.count++;
    for (int k = 0; k < 3; ++k) {
      rays.base[k][n] = static_cast<T>(base[k]);
      rays.offset[k][n] = static_cast<T>(offset[k]);
      rays.direction[k][n] = static_cast<T>(reach[k]);
      rays.value[k][n] = static_cast<T>(emission.radiance[k] * (sample.weight / probability));
    }
    rays.time[n] = time_[lane];
    rays.threshold[n] = threshold_[lane];
    rays.self[n] = kCamera;
    rays.path[n] = static_cast<IdOf<T>>(path);
    rays.history[n] = history;
    rays.group[n] = static_cast<IdOf<T>>(emission.group);
    return n;
  }

  const SceneView& scene_;
  const Tracer& tracer_;
  const Tile& tile_;
  PathsOf<T>& paths_;
  TileCounts& counts_;
  // Of the paths of a vector:
  HWY_ALIGN T film_[2][kLanes], lens_[2][kLanes], other_[2][kLanes], disc_[2][kLanes], choice_[kLanes], piece_[kLanes],
      time_[kLanes], threshold_[kLanes];
  SeenEmitterChoice chosen_[kLanes];
};

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
