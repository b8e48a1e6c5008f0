// SPDX-License-Identifier: Apache-2.0
// Emitters that the camera sees: rays to them, and camera rays that they are taken out of.
#if defined(ORRERY_KERNEL_SEEN_EMITTERS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_KERNEL_SEEN_EMITTERS_INL_H_
#undef ORRERY_KERNEL_SEEN_EMITTERS_INL_H_
#else
#define ORRERY_KERNEL_SEEN_EMITTERS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "kernel/camera-inl.h"
#include "kernel/direct_light-inl.h"
#include "kernel/gather-inl.h"
#include "kernel/path_stream.h"
#include "kernel/sampler-inl.h"
#include "kernel/scene_view.h"
#include "kernel/seen_emitter_sample.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// Those of the lanes whose paths are of pixels that sample the emitters that were hit. Not inlined.
template <class D>
HWY_NOINLINE hn::Mask<D> are_sampled(D d, const SceneView& scene, hn::Mask<D> lanes, hn::Vec<IdTag<D>> pixels,
                                     hn::Vec<IdTag<D>> hits) {
  HWY_ALIGN hn::TFromD<IdTag<D>> pixel[hn::MaxLanes(D())], hit[hn::MaxLanes(D())];
  HWY_ALIGN hn::TFromD<D> found[hn::MaxLanes(D())] = {};
  hn::Store(pixels, IdTag<D>(), pixel);
  hn::Store(hits, IdTag<D>(), hit);
  each_lane(d, lanes, [&](int i) { found[i] = scene.seen_emitters.has(place_of(pixel[i], scene), hit[i]) ? 1 : 0; });
  return hn::Load(d, found) != 0;
}

/// Samples an emitter for each path of a batch whose pixel has any, and adds its light. Not inlined.
template <class D>
HWY_NOINLINE void add_seen_emitters(D d, const SceneView& scene, const Tracer& tracer, const Tile& tile,
                                    PathsOf<hn::TFromD<D>>& paths, int count, TileCounts& counts) {
  using T = hn::TFromD<D>;
  const IdTag<D> du;
  const auto& batch = paths.batch;
  auto& shadow = paths.shadow;
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(D()));
  HWY_ALIGN T film[2][kLanes], lens[2][kLanes], other[2][kLanes], disc[2][kLanes], choice[kLanes], time[kLanes],
      threshold[kLanes];
  for (int v = 0; v < count; v += kLanes) {
    const int lanes = std::min(kLanes, count - v);
    const auto emitters = [&](int i) { return scene.seen_emitters.at(place_of(batch.pixel[v + i], scene)); };
    bool any = false;
    for (int i = 0; i < lanes; ++i) any = any || !emitters(i).empty();
    if (!any) continue;
    const auto pixels = hn::Load(du, batch.pixel + v), samples = hn::Load(du, batch.sample + v);
    const auto random = random_at_vertex(d, scene.sampler, pixels, samples, 0, scene.features.lens);
    const auto second = second_random_at_vertex(d, scene.sampler, pixels, samples, 0, true);
    const auto path = numbers_of_path(d, scene.sampler, pixels, samples);
    const auto on_lens = sample_unit_disc(d, random.v[2], random.v[3]);
    const auto on_disc = sample_unit_disc(d, second.v[0], second.v[1]);
    hn::Store(random.v[0], d, film[0]);
    hn::Store(random.v[1], d, film[1]);
    hn::Store(on_lens.x, d, lens[0]);
    hn::Store(on_lens.y, d, lens[1]);
    hn::Store(second.v[0], d, other[0]);
    hn::Store(second.v[1], d, other[1]);
    hn::Store(on_disc.x, d, disc[0]);
    hn::Store(on_disc.y, d, disc[1]);
    hn::Store(second.v[2], d, choice);
    hn::Store(path.time, d, time);
    hn::Store(path.threshold, d, threshold);
    for (int i = 0; i < lanes; ++i) {
      const auto all = emitters(i);
      if (all.empty()) continue;
      const PixelPlace place = place_of(batch.pixel[v + i], scene);
      const double pixel[2] = {place.x + 0.5 - scene.camera.half_width, place.y + 0.5 - scene.camera.half_height};
      SeenEmitterNumbers numbers;
      for (int k = 0; k < 2; ++k) {
        numbers.film[k] = static_cast<double>(film[k][i]);
        numbers.lens[k] = static_cast<double>(lens[k][i]);
        numbers.other[k] = static_cast<double>(other[k][i]);
        numbers.disc[k] = static_cast<double>(disc[k][i]);
      }
      numbers.choice = static_cast<double>(choice[i]);
      const SeenEmitterSample sample = sample_seen_emitter(scene, all, pixel, numbers);
      if (!(sample.weight > 0)) continue;
      const Emission& emission = scene.emission[scene.object_materials[sample.id]];
      const double offset[3] = {sample.offset.x, sample.offset.y, sample.offset.z},
                   reach[3] = {sample.reach.x, sample.reach.y, sample.reach.z},
                   origin[3] = {scene.camera.origin.x, scene.camera.origin.y, scene.camera.origin.z};
      const int n = shadow.count++;
      for (int k = 0; k < 3; ++k) {
        shadow.base[k][n] = static_cast<T>(origin[k]);
        shadow.offset[k][n] = static_cast<T>(offset[k]);
        shadow.direction[k][n] = static_cast<T>(reach[k]);
        shadow.value[k][n] = static_cast<T>(emission.radiance[k] * sample.weight);
      }
      shadow.distance[n] = 1;
      shadow.time[n] = time[i];
      shadow.threshold[n] = threshold[i];
      shadow.self[n] = kCamera;
      shadow.target[n] = sample.id;
      shadow.path[n] = static_cast<IdOf<T>>(v + i);
      shadow.history[n] = 0;
      shadow.group[n] = static_cast<IdOf<T>>(emission.group);
      if (shadow.count == shadow.kBatch) trace_shadow_batch(d, scene, tracer, tile, paths, counts);
    }
  }
  if (shadow.count > 0) trace_shadow_batch(d, scene, tracer, tile, paths, counts);
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
