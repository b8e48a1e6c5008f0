// SPDX-License-Identifier: Apache-2.0
// Shading of traced packets. Compiled once per instruction set.
#if defined(ORRERY_KERNEL_SHADE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_KERNEL_SHADE_INL_H_
#undef ORRERY_KERNEL_SHADE_INL_H_
#else
#define ORRERY_KERNEL_SHADE_INL_H_
#endif

#include <hwy/highway.h>

#include <cmath>
#include <limits>

#include "kernel/compaction-inl.h"
#include "kernel/cone-inl.h"
#include "kernel/direct_light-inl.h"
#include "kernel/path_stream.h"
#include "kernel/record-inl.h"
#include "kernel/render_tile.h"
#include "kernel/scatter-inl.h"
#include "kernel/surface-inl.h"
#include "kernel/surface_texture-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// Path state of a packet's rays other than their geometry, in the packet's lane order.
template <class T, class Id>
struct alignas(64) PathPayload {
  T throughput[3][kPacketSize];
  Id pixel[kPacketSize];
  Id sample[kPacketSize];
  Id history[kPacketSize];  ///< in loops that record paths; see record-inl.h
  Id path[kPacketSize];     ///< in lit loops: index within the batch
  T pdf[kPacketSize];       ///< in lit loops: see LitPathsOf
  T cone[3][kPacketSize];   ///< in extended loops: see PathStreamOf
};

/// The sum of a pixel of the tile.
HWY_INLINE PixelSum& sum_of(std::uint64_t pixel, const SceneView& scene, const Tile& tile) {
  const PixelPlace at = place_of(pixel, scene);
  return tile.sums[(at.y - tile.y) * tile.row_stride + (at.x - tile.x)];
}

/// Converts to units of 2^-60, like to_fixed_point().
///
/// Domain     |value| < 4
HWY_INLINE void store_fixed_point(hn::ScalableTag<double> d, hn::Vec<hn::ScalableTag<double>> value, std::int64_t* to) {
  const hn::RebindToSigned<decltype(d)> di;
  hn::Store(hn::ConvertTo(di, value * hn::Set(d, 0x1p60)), di, to);
}
HWY_INLINE void store_fixed_point(hn::ScalableTag<float> d, hn::Vec<hn::ScalableTag<float>> value, std::int64_t* to) {
  const hn::ScalableTag<double> wide;
  const hn::Half<decltype(d)> half;
  store_fixed_point(wide, hn::PromoteTo(wide, hn::LowerHalf(half, value)), to);
  store_fixed_point(wide, hn::PromoteTo(wide, hn::UpperHalf(half, value)), to + hn::Lanes(wide));
}

/// Adds finished paths to their pixels. Bad samples are counted and excluded from the sums.
template <class D>
HWY_INLINE void deposit(D d, hn::Mask<D> lanes, const Vec3<hn::Vec<D>>& light, hn::Vec<IdTag<D>> pixels,
                        hn::Vec<IdTag<D>> samples, const SceneView& scene, const Tile& tile, TileCounts& counts) {
  using T = hn::TFromD<D>;
  HWY_ALIGN hn::TFromD<IdTag<D>> pixel[hn::MaxLanes(D())];
  hn::Store(pixels, IdTag<D>(), pixel);
  // Other instruction sets convert lanes one by one.
  if constexpr (HWY_TARGET <= HWY_AVX3 && hn::MaxLanes(D()) > 1) {
    // Compared one by one, since the maximum of a NaN and a number may be the number.
    const auto converts = [&](hn::Vec<D> v) { return hn::Abs(v) < hn::Set(d, T(4)); };
    const auto all_convert = hn::And(hn::And(converts(light.x), converts(light.y)), converts(light.z));
    if (scene.filter.negative_share == 0 && hn::AllFalse(d, hn::AndNot(all_convert, lanes))) {
      HWY_ALIGN std::int64_t rgb[3][hn::MaxLanes(D())];
      store_fixed_point(d, light.x, rgb[0]);
      store_fixed_point(d, light.y, rgb[1]);
      store_fixed_point(d, light.z, rgb[2]);
      const auto is_black = hn::Max(hn::Max(hn::Abs(light.x), hn::Abs(light.y)), hn::Abs(light.z)) == hn::Zero(d);
      each_lane(d, hn::AndNot(is_black, lanes), [&](int i) {
        PixelSum& sum = sum_of(pixel[i], scene, tile);
        for (int k = 0; k < 3; ++k) sum.rgb[k] += rgb[k][i];
      });
      return;
    }
  }
  HWY_ALIGN T rgb[3][hn::MaxLanes(D())];
  HWY_ALIGN hn::TFromD<IdTag<D>> sample[hn::MaxLanes(D())];
  hn::Store(light.x, d, rgb[0]);
  hn::Store(light.y, d, rgb[1]);
  hn::Store(light.z, d, rgb[2]);
  hn::Store(samples, IdTag<D>(), sample);
  each_lane(d, lanes, [&](int i) {
    if (rgb[0][i] == T(0) && rgb[1][i] == T(0) && rgb[2][i] == T(0)) return;
    PixelSum& sum = sum_of(pixel[i], scene, tile);
    const auto r = static_cast<double>(rgb[0][i]), g = static_cast<double>(rgb[1][i]),
               b = static_cast<double>(rgb[2][i]);
    const bool negative = scene.filter.negative_share != 0 && scene.filter.weight(sample[i], sample[i] + 1) < 0;
    if (!is_valid_sample(r, g, b)) {
      sum.weight -= negative ? -1 : 1;
      ++counts.bad_samples;
    } else if (negative) {
      sum.rgb[0] -= to_fixed_point(r);
      sum.rgb[1] -= to_fixed_point(g);
      sum.rgb[2] -= to_fixed_point(b);
    } else {
      sum.rgb[0] += to_fixed_point(r);
      sum.rgb[1] += to_fixed_point(g);
      sum.rgb[2] += to_fixed_point(b);
    }
  });
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> background(D d, const Background& sky, bool has_gradient, const Vec3<V>& direction) {
  using T = hn::TFromD<D>;
  const auto bottom = set3(d, sky.bottom);
  if (!has_gradient) return bottom;
  const V half = hn::Set(d, static_cast<T>(0.5));
  const V a = hn::MulAdd(direction.y, half, half);
  const V one_minus_a = hn::Set(d, T(1)) - a;
  return mul_add(set3(d, sky.top), a, bottom * one_minus_a);
}

/// Records nothing.
struct NullRecorder {
  template <class... Any>
  HWY_INLINE explicit NullRecorder(const Any&...) {}
};

/// Russian roulette: ends paths with a probability that rises as their throughput falls and divides the throughput of
/// the others by their survival probability, which keeps the estimate unbiased.
///
/// Reference  arvo1990
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> survives_roulette(D d, V u, Vec3<V>& throughput) {
  using T = hn::TFromD<D>;
  const V brightest = max(throughput);
  const V chance = hn::Min(brightest * hn::Set(d, static_cast<T>(kRouletteGain)), hn::Set(d, T(1)));
  const auto stronger = hn::Set(d, hn::TFromD<D>(1)) / chance;
  const auto survives = u < chance;
  throughput = {throughput.x * stronger, throughput.y * stronger, throughput.z * stronger};
  return survives;
}

/// Initializes the batch's paths first .. first + count in a lit loop.
template <class D, class Carried, class Lit>
HWY_INLINE void begin_lit(D d, int first, Carried& carried, Lit& lit) {
  using Id = hn::TFromD<IdTag<D>>;
  const IdTag<D> du;
  for (int v = 0; v < kPacketSize; v += static_cast<int>(hn::Lanes(d))) {
    const int i = first + v;
    hn::Store(hn::Iota(du, static_cast<Id>(i)), du, carried.path + v);
    hn::Store(hn::Load(du, carried.pixel + v), du, lit.pixel + i);
    hn::Store(hn::Load(du, carried.sample + v), du, lit.sample + i);
    for (auto& channel : lit.radiance) hn::Store(hn::Zero(d), d, channel + i);
  }
}

/// Deposits the radiance of the batch's paths.
template <class D, Loop kLoop, class Lit>
HWY_INLINE void deposit_batch(D d, int count, const SceneView& scene, const Tile& tile, const Lit& lit,
                              TileCounts& counts) {
  const IdTag<D> du;
  for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d))) {
    const auto active = hn::FirstN(d, static_cast<std::size_t>(count - i));
    const auto light = load3(d, lit.radiance[0] + i, lit.radiance[1] + i, lit.radiance[2] + i);
    const auto pixels = hn::Load(du, lit.pixel + i), samples = hn::Load(du, lit.sample + i);
    deposit(d, active, light, pixels, samples, scene, tile, counts);
    if constexpr (kLoop.records)
      if (tile.record_light) Recorder<D>(d, scene, tile, pixels, samples).light(d, active, light);
  }
}

/// Shades a traced packet: adds the radiance that reaches the camera along its paths to their pixels (to their sums in
/// `stream.lit` in lit loops) and appends the surviving paths to the stream.
///
/// Result     number of paths in the stream; `alive` is their number before the call
template <class D, Loop kLoop, class Stream, class Carried>
HWY_INLINE int shade(D d, const SceneView& scene, const Tile& tile, std::uint32_t depth, const Carried& carried,
                     Stream& stream, int alive, TileCounts& counts) {
  constexpr Precision kPrecision = kLoop.precision;
  constexpr bool kRecords = kLoop.records, kMoves = kLoop.moves;
  const IdTag<D> du;
  using T = hn::TFromD<D>;
  using Id = hn::TFromD<IdTag<D>>;
  const auto& packet = stream.packet;
  const int step = static_cast<int>(hn::Lanes(d));
  for (int v = 0; v < packet.count; v += step) {
    const auto active = hn::FirstN(d, static_cast<std::size_t>(packet.count - v));
    const auto hits = hn::Load(du, packet.hit + v);
    const auto hit = hn::AndNot(hn::RebindMask(d, hits == hn::Set(du, static_cast<Id>(kNoSphere))), active);
    const auto missed = hn::AndNot(hit, active);
    const auto ray = load_rays(d, packet, v);
    const auto pixels = hn::Load(du, carried.pixel + v);
    const auto samples = hn::Load(du, carried.sample + v);
    auto throughput = load3(d, carried.throughput[0] + v, carried.throughput[1] + v, carried.throughput[2] + v);
    [[maybe_unused]] hn::Vec<IdTag<D>> history;
    [[maybe_unused]] hn::Mask<D> guided;
    [[maybe_unused]] std::conditional_t<kRecords, Recorder<D>, NullRecorder> record(d, scene, tile, pixels, samples);
    [[maybe_unused]] hn::Vec<IdTag<D>> paths;
    if constexpr (kLoop.lit) paths = hn::Load(du, carried.path + v);
    if constexpr (kRecords) {
      history = hn::Load(du, carried.history + v);
      const auto only_delta = hn::Set(du, static_cast<Id>(kOnlyDeltaBit));
      guided = hn::RebindMask(d, hn::And(history, only_delta) == only_delta);
      if (depth == 0) record.begin(d, active, missed);
    }
    // Radiance that arrives along the path, and the light group of its source. The path ends unless the loop is lit.
    const auto add_radiance = [&](hn::Mask<D> lanes, const Vec3<hn::Vec<D>>& light,
                                  [[maybe_unused]] hn::Vec<IdTag<D>> groups, [[maybe_unused]] Lobe unscattered) {
      if constexpr (kRecords)
        if (tile.record_light) record.event(d, lanes, light, history, groups, unscattered);
      if constexpr (kLoop.lit) {
        gain(d, lanes, light, paths, stream.lit);
      } else {
        deposit(d, lanes, light, pixels, samples, scene, tile, counts);
        if constexpr (kRecords)
          if (tile.record_light) record.light(d, lanes, light);
      }
    };
    if (!hn::AllFalse(d, missed)) {
      if (depth > 0 || scene.background_visible) {
        Vec3<hn::Vec<D>> light;
        auto groups = hn::Zero(du);
        if (depth == 0 && scene.has_backdrop) {
          light = set3(d, scene.backdrop);
        } else if (kLoop.lit && scene.environment != nullptr) {
          light = depth == 0 ? environment_radiance(d, *scene.environment, ray.direction)
                             : weighted_environment(d, scene, ray.direction, hn::Load(d, carried.pdf + v));
          groups = hn::Set(du, static_cast<Id>(scene.environment->light_group));
        } else {
          light = background(d, scene.background, scene.features.sky, ray.direction);
        }
        light = light * throughput;
        add_radiance(missed, light, groups, Lobe::kBackground);
        if constexpr (kRecords) {
          const auto one = hn::Set(d, T(1)), zero = hn::Zero(d);
          record.guide(d, hn::And(missed, guided),
                       {hn::Min(light.x, one), hn::Min(light.y, one), hn::Min(light.z, one)}, {zero, zero, zero});
        }
      }
    }
    if (hn::AllFalse(d, hit)) continue;
    // At the hits.
    [[maybe_unused]] std::conditional_t<kLoop.extended, RayCone<hn::Vec<D>>, NoCone> cone{};
    if constexpr (kLoop.extended)
      if (scene.cone_width > 0) {
        const auto moments = load3(d, carried.cone[0] + v, carried.cone[1] + v, carried.cone[2] + v);
        cone = RayCone<hn::Vec<D>>{moments.x, moments.y, moments.z}.advanced(hn::Load(d, packet.distance + v));
      }

    if constexpr (kLoop.lit) {
      if (scene.emission != nullptr && scene.shading == Shading::kPath) {
        auto source = emitted(d, scene, hits, hit);
        const auto zero = hn::Zero(d);
        const auto dark =
            hn::And(hn::And(source.radiance.x == zero, source.radiance.y == zero), source.radiance.z == zero);
        const auto shines = hn::AndNot(dark, hit);
        if (!hn::AllFalse(d, shines)) {
          if constexpr (kLoop.extended)
            if (scene.textures != nullptr)
              source.radiance = textured_radiance<D, kPrecision, kMoves>(d, scene, ray, hits, shines,
                                                                         hn::Load(d, packet.distance + v), cone.width2,
                                                                         packet.time + v, source.radiance);
          if (depth > 0)
            source.radiance = source.radiance * emitter_weight<D, kMoves>(d, scene, ray, hits, packet.time + v,
                                                                          hn::Load(d, carried.pdf + v));
          add_radiance(shines, source.radiance * throughput, source.group, Lobe::kEmission);
        }
      }
    }
    const bool ends = scene.shading == Shading::kPath && depth + 1 >= scene.max_depth;
    if (ends && !(kRecords && depth == 0)) continue;
    auto at =
        reach_surface<D, kPrecision, kMoves>(d, scene, ray, hits, hn::Load(d, packet.distance + v), packet.time + v);
    if constexpr (kLoop.extended)
      if (scene.textures != nullptr)
        apply_textures<D, kPrecision>(d, scene, ray, hits, hit, hn::Load(d, packet.distance + v), cone.width2, at);
    const Vec3<hn::Vec<D>> tinted = throughput * at.albedo;
    if constexpr (kRecords) {
      if (depth == 0) {
        record.first_hit(d, hit, hits, at.surface.offset, ray.direction,
                         kMoves && scene.features.motion ? packet.time + v : nullptr);
        if constexpr (kLoop.extended) record.albedo(d, hit, at.albedo);
        record.inverse_depth(d, hit, hn::Load(d, packet.distance + v));
      }
      record.guide(d, hn::AndNot(is_delta(d, at.surface), hn::And(hit, guided)), tinted, at.surface.normal);
      if (ends) continue;
    }
    if (scene.shading != Shading::kPath) {
      const auto half = hn::Set(d, static_cast<T>(0.5));
      add_radiance(hit,
                   scene.shading == Shading::kFlat ? at.albedo : mul_add(at.surface.normal, half, {half, half, half}),
                   hn::Zero(du), Lobe::kBackground);
      continue;
    }
    const bool plays_roulette = depth + 1 >= scene.roulette_depth;
    const auto random = random_at_vertex(d, scene.sampler, pixels, samples, depth + 1, plays_roulette);
    const auto scattered = sample_bsdf<kLoop.extended>(d, scene.features, at.surface, random);
    throughput = tinted;
    auto survives = hn::And(hit, scattered.alive);
    [[maybe_unused]] hn::Mask<D> has_pdf;
    if constexpr (kLoop.lit) {
      survives = hn::AndNot(is_kind(d, at.surface.kind, MaterialKind::kEmitter), survives);
      has_pdf = hn::AndNot(is_delta(d, at.surface), hit);
      if (samples_lights(scene)) {
        const auto connects = hn::AndNot(is_kind(d, at.surface.kind, MaterialKind::kEmitter), has_pdf);
        if (!hn::AllFalse(d, connects)) {
          const auto random_light =
              second_random_at_vertex(d, scene.sampler, pixels, samples, depth + 1, chooses_light(scene));
          hn::Vec<IdTag<D>> reflected{};
          if constexpr (kRecords)
            reflected = continued(d, history, at.surface, at.surface.normal, depth, tile.events != nullptr);
          auto to_light = cone;
          if constexpr (kLoop.extended)
            to_light = {cone.width2, hn::Zero(d), lobe_slope2(d, at.surface, scene.cone_width)};
          connect<D, kLoop>(d, scene, at.surface, at.sphere.center, tinted, to_light, connects, hits, paths, reflected,
                            random_light, packet.time + v, stream.lit);
        }
      }
    }
    if (plays_roulette) survives = hn::And(survives, survives_roulette(d, random.v[2], throughput));
    const Compactor<D> compactor(d, survives);
    compactor.store3(d, at.sphere.center, stream.base, alive);
    compactor.store3(d, at.surface.offset, stream.offset, alive);
    compactor.store3(d, scattered.direction, stream.direction, alive);
    compactor.store3(d, throughput, stream.throughput, alive);
    compactor.store_ids(d, hits, stream.self + alive);
    compactor.store_ids(d, pixels, stream.pixel + alive);
    compactor.store_ids(d, samples, stream.sample + alive);
    if constexpr (kLoop.lit) {
      const auto delta = hn::Set(d, std::numeric_limits<T>::infinity());
      const auto pdf = pdf_bsdf(d, scene.features, at.surface, scattered.direction);
      compactor.store(d, hn::IfThenElse(has_pdf, pdf, delta), stream.lit.pdf + alive);
      compactor.store_ids(d, paths, stream.lit.path + alive);
    }
    if constexpr (kLoop.extended)
      if (scene.cone_width > 0) {
        cone = scattered_cone(d, cone, at.surface, at.sphere.radius, scattered.direction, scene.cone_width);
        compactor.store3(d, Vec3<hn::Vec<D>>{cone.width2, cone.mixed, cone.slope2}, stream.cone, alive);
      }
    if constexpr (kRecords)
      compactor.store_ids(d, continued(d, history, at.surface, scattered.direction, depth, tile.events != nullptr),
                          stream.history + alive);
    alive += compactor.count();
  }
  return alive;
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
