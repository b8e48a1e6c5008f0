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

#include "kernel/compaction.h"
#include "kernel/gather-inl.h"
#include "kernel/intersect-inl.h"
#include "kernel/path_stream.h"
#include "kernel/record-inl.h"
#include "kernel/render_tile.h"
#include "kernel/scatter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// Path state of a packet's rays besides their geometry, in the packet's lane order.
template <class T, class Id>
struct alignas(64) PathPayload {
  T base[3][kPacketSize];
  T throughput[3][kPacketSize];
  Id pixel[kPacketSize];
  Id sample[kPacketSize];
  Id history[kPacketSize];     ///< in loops that record paths; see record-inl.h
  T radiance[3][kPacketSize];  ///< in loops that collect light along the path
};

/// What an instance of the path loop is compiled for.
struct Loop {
  Precision precision = Precision::kExact;
  bool records = false;   ///< fills the tile's records
  bool moves = false;     ///< camera or spheres move
  bool collects = false;  ///< paths gain light at their vertices, not only where they leave the scene
};

/// Adds finished paths to their pixels. Bad samples are counted and excluded from the sums.
template <class D>
HWY_INLINE void add_light(D d, hn::Mask<D> lanes, const Vec3<hn::Vec<D>>& light, hn::Vec<IdTag<D>> pixels,
                          hn::Vec<IdTag<D>> samples, const SceneView& scene, const Tile& tile, TileCounts& counts) {
  using T = hn::TFromD<D>;
  HWY_ALIGN T rgb[3][hn::MaxLanes(D())];
  HWY_ALIGN hn::TFromD<IdTag<D>> pixel[hn::MaxLanes(D())], sample[hn::MaxLanes(D())];
  HWY_ALIGN T in[hn::MaxLanes(D())];
  hn::Store(light.x, d, rgb[0]);
  hn::Store(light.y, d, rgb[1]);
  hn::Store(light.z, d, rgb[2]);
  hn::Store(pixels, IdTag<D>(), pixel);
  hn::Store(samples, IdTag<D>(), sample);
  hn::Store(hn::IfThenElseZero(lanes, hn::Set(d, T(1))), d, in);
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) {
    if (in[i] == T(0)) continue;
    const PixelPlace at = place_of(pixel[i], scene);
    PixelSum& sum = tile.sums[(at.y - tile.y) * tile.row_stride + (at.x - tile.x)];
    const auto r = static_cast<double>(rgb[0][i]), g = static_cast<double>(rgb[1][i]),
               b = static_cast<double>(rgb[2][i]);
    const bool negative = scene.filter.negative_share != 0 && scene.filter.weight(sample[i], sample[i] + 1) < 0;
    if (!is_good_sample(r, g, b)) {
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
  }
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

/// Emitted radiance of the hit spheres, one per lane.
///
/// Domain     scene.emission is not null
template <class D>
HWY_INLINE Vec3<hn::Vec<D>> emitted(D d, const SceneView& scene, hn::Vec<IdTag<D>> hits, hn::Mask<D> hit) {
  using Id = hn::TFromD<IdTag<D>>;
  const IdTag<D> du;
  HWY_ALIGN Id id[hn::MaxLanes(D())];
  hn::Store(hn::IfThenElseZero(hn::RebindMask(du, hit), hits), du, id);
  hn::Vec<D> rgb[4];
  gather4(
      d, [&](std::size_t i) { return scene.emission[scene.sphere_materials[id[i]]].radiance; }, rgb);
  return {rgb[0], rgb[1], rgb[2]};
}

/// Scene data of a vector of hits.
template <class D>
struct Lookup {
  Spheres<D> sphere;
  Surface<D> surface;  ///< offset, normal and side are set by reach_surface
  Vec3<hn::Vec<D>> albedo;
  hn::Vec<D> eta_outside, eta_inside, r0_outside, r0_inside;
};

/// Loads spheres and materials of the hits; lanes without a hit get those of sphere 0.
///
/// `times`    of the rays; read only where kMoves
template <class D, bool kMoves>
HWY_INLINE Lookup<D> look_up(D d, const SceneView& scene, hn::Vec<IdTag<D>> hits, const hn::TFromD<D>* times) {
  using Id = hn::TFromD<IdTag<D>>;
  constexpr std::size_t kMax = hn::MaxLanes(D());
  const IdTag<D> du;
  HWY_ALIGN Id id[kMax], kind[kMax], fresnel[kMax];
  const Material* material[kMax];
  hn::Store(hn::IfThenZeroElse(hits == hn::Set(du, static_cast<Id>(kNoSphere)), hits), du, id);
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) {
    material[i] = &scene.materials[scene.sphere_materials[id[i]]];
    kind[i] = static_cast<Id>(material[i]->kind);
    fresnel[i] = static_cast<Id>(material[i]->fresnel);
  }
  hn::Vec<D> sphere[4], color[4], glass[4];
  gather4(
      d, [&](std::size_t i) { return &scene.spheres[id[i]].x; }, sphere);
  gather4(
      d, [&](std::size_t i) { return material[i]->albedo; }, color);
  gather4(
      d, [&](std::size_t i) { return material[i]->eta; }, glass);
  Lookup<D> out;
  out.sphere = {{sphere[0], sphere[1], sphere[2]}, sphere[3]};
  if (kMoves && scene.moving_count > 0) {
    static constexpr Sphere kAtRest{0, 0, 0, 0};
    hn::Vec<D> change[4];
    gather4(
        d, [&](std::size_t i) { return &(id[i] < scene.moving_count ? scene.motion[id[i]] : kAtRest).x; }, change);
    const auto time = hn::Load(d, times);
    out.sphere = {mul_add(Vec3<hn::Vec<D>>{change[0], change[1], change[2]}, time, out.sphere.center),
                  hn::MulAdd(change[3], time, out.sphere.radius)};
  }
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
template <class D, Precision kPrecision, bool kMoves>
HWY_INLINE Lookup<D> reach_surface(D d, const SceneView& scene, const Rays<D>& ray, hn::Vec<IdTag<D>> hits,
                                   hn::Vec<D> distance, const hn::TFromD<D>* times) {
  Lookup<D> at = look_up<D, kMoves>(d, scene, hits, times);
  Surface<D>& surface = at.surface;
  const auto is_self = hn::RebindMask(d, hits == ray.self);
  surface.direction = ray.direction;
  const auto point = hit_point<D, kPrecision>(d, ray, at.sphere, is_self, distance);
  surface.offset = point.offset;
  surface.from_outside = dot(ray.direction, surface.offset) < hn::Zero(d);
  surface.normal = select(surface.from_outside, point.outward, negated(point.outward));
  surface.eta = hn::IfThenElse(surface.from_outside, at.eta_outside, at.eta_inside);
  surface.r0 = hn::IfThenElse(surface.from_outside, at.r0_outside, at.r0_inside);
  return at;
}

/// Stores selected lanes of vectors contiguously. May overwrite a whole vector from the destination on.
///
/// The permutation is looked up once for all vectors. Highway's CompressStore looks it up each time, and GCC copies its
/// table to the stack to do so, which took a quarter of the time.
template <class D>
class Compactor {
 public:
  HWY_INLINE Compactor(D d, hn::Mask<D> mask) : mask_(mask), count_(static_cast<int>(hn::CountTrue(d, mask))) {
    if constexpr (kUsesTable) {
      std::uint8_t bits[8] = {};
      hn::StoreMaskBits(d, mask, bits);
      order_ = hn::Load(IdTag<D>(), kCompaction<hn::TFromD<IdTag<D>>, hn::MaxLanes(D())>[bits[0]].data());
    }
  }
  HWY_INLINE int count() const { return count_; }

  HWY_INLINE void store(D d, hn::Vec<D> v, hn::TFromD<D>* to) const {
    if constexpr (hn::MaxLanes(D()) == 1) {
      hn::StoreU(v, d, to);
    } else if constexpr (kUsesTable) {
      hn::StoreU(hn::TableLookupLanes(v, hn::IndicesFromVec(d, order_)), d, to);
    } else {
      hn::CompressStore(v, mask_, d, to);
    }
  }
  HWY_INLINE void store_ids(D d, hn::Vec<IdTag<D>> v, hn::TFromD<IdTag<D>>* to) const {
    store(d, hn::BitCast(d, v), reinterpret_cast<hn::TFromD<D>*>(to));
  }
  template <class Array>
  HWY_INLINE void store3(D d, const Vec3<hn::Vec<D>>& v, Array& to, int at) const {
    store(d, v.x, to[0] + at);
    store(d, v.y, to[1] + at);
    store(d, v.z, to[2] + at);
  }

 private:
  // AVX-512 has an instruction for it.
  static constexpr bool kUsesTable = hn::MaxLanes(D()) > 1 && HWY_TARGET > HWY_AVX3;
  hn::Mask<D> mask_;
  int count_;
  hn::Vec<IdTag<D>> order_{};
};

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
  const V brightest = hn::Max(throughput.x, hn::Max(throughput.y, throughput.z));
  const V chance = hn::Min(brightest * hn::Set(d, static_cast<T>(kRouletteGain)), hn::Set(d, T(1)));
  const auto stronger = hn::Set(d, hn::TFromD<D>(1)) / chance;
  const auto survives = u < chance;
  throughput = {throughput.x * stronger, throughput.y * stronger, throughput.z * stronger};
  return survives;
}

/// Shades a traced packet: adds the radiance of paths that end to their pixels and appends the others to the stream.
///
/// Result     number of paths in the stream, `alive` before the call
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
    [[maybe_unused]] Vec3<hn::Vec<D>> radiance;
    if constexpr (kLoop.collects)
      radiance = load3(d, carried.radiance[0] + v, carried.radiance[1] + v, carried.radiance[2] + v);
    if constexpr (kRecords) {
      history = hn::Load(du, carried.history + v);
      const auto only_delta = hn::Set(du, static_cast<Id>(kOnlyDeltaBit));
      guided = hn::RebindMask(d, hn::And(history, only_delta) == only_delta);
      if (depth == 0) record.begin(d, active);
    }
    // Deposits a path's total radiance, once, so that a bad value costs the path its weight once.
    const auto end = [&](hn::Mask<D> lanes, const Vec3<hn::Vec<D>>& light) {
      add_light(d, lanes, light, pixels, samples, scene, tile, counts);
      if constexpr (kRecords)
        if (tile.record_light) record.light(d, lanes, light);
    };
    const auto gain = [&](hn::Mask<D> lanes, const Vec3<hn::Vec<D>>& light) {
      if constexpr (kRecords)
        if (tile.record_light) record.event(d, lanes, light, history);
      if constexpr (kLoop.collects) radiance = select(lanes, radiance + light, radiance);
    };
    const auto gain_and_end = [&](hn::Mask<D> lanes, const Vec3<hn::Vec<D>>& light) {
      gain(lanes, light);
      if constexpr (kLoop.collects) {
        end(lanes, radiance);
      } else {
        end(lanes, light);
      }
    };
    if (!hn::AllFalse(d, missed)) {
      if (depth > 0 || scene.background_visible) {
        const auto sky = background(d, scene.background, scene.features.sky, ray.direction);
        const Vec3<hn::Vec<D>> light = {sky.x * throughput.x, sky.y * throughput.y, sky.z * throughput.z};
        gain_and_end(missed, light);
        if constexpr (kRecords) {
          const auto one = hn::Set(d, T(1)), zero = hn::Zero(d);
          if (tile.record_guides)
            record.guide(d, hn::And(missed, guided),
                         {hn::Min(light.x, one), hn::Min(light.y, one), hn::Min(light.z, one)}, {zero, zero, zero});
        }
      }
    }
    if (hn::AllFalse(d, hit)) continue;

    if constexpr (kLoop.collects) {
      if (scene.emission != nullptr && scene.shading == Shading::kPath) {
        const auto glow = emitted(d, scene, hits, hit);
        gain(hit, {glow.x * throughput.x, glow.y * throughput.y, glow.z * throughput.z});
      }
    }
    const bool ends = scene.shading == Shading::kPath && depth + 1 >= scene.max_depth;
    if constexpr (kLoop.collects)
      if (ends) end(hit, radiance);
    if (ends && !(kRecords && depth == 0)) continue;
    const auto at =
        reach_surface<D, kPrecision, kMoves>(d, scene, ray, hits, hn::Load(d, packet.distance + v), packet.time + v);
    const Vec3<hn::Vec<D>> tinted = {throughput.x * at.albedo.x, throughput.y * at.albedo.y,
                                     throughput.z * at.albedo.z};
    if constexpr (kRecords) {
      if (depth == 0)
        record.first_hit(d, hit, hits, at.surface.offset, ray.direction, kMoves ? packet.time + v : nullptr);
      if (tile.record_guides)
        record.guide(d, hn::AndNot(is_delta(d, at.surface), hn::And(hit, guided)), tinted, at.surface.normal);
      if (ends) continue;
    }
    if (scene.shading != Shading::kPath) {
      const auto half = hn::Set(d, static_cast<T>(0.5));
      gain_and_end(hit,
                   scene.shading == Shading::kFlat ? at.albedo : mul_add(at.surface.normal, half, {half, half, half}));
      continue;
    }
    const bool plays_roulette = depth + 1 >= scene.roulette_depth;
    const auto random = random_at_vertex(d, scene.sampler, pixels, samples, depth + 1, plays_roulette);
    const auto scattered = sample_bsdf(d, scene.features, at.surface, random);
    throughput = tinted;
    auto goes_on = hn::And(hit, scattered.alive);
    if (plays_roulette) goes_on = hn::And(goes_on, survives_roulette(d, random.v[2], throughput));
    if constexpr (kLoop.collects) end(hn::AndNot(goes_on, hit), radiance);
    const Compactor<D> compactor(d, goes_on);
    compactor.store3(d, at.sphere.center, stream.base, alive);
    compactor.store3(d, at.surface.offset, stream.offset, alive);
    compactor.store3(d, scattered.direction, stream.direction, alive);
    compactor.store3(d, throughput, stream.throughput, alive);
    compactor.store_ids(d, hits, stream.self + alive);
    compactor.store_ids(d, pixels, stream.pixel + alive);
    compactor.store_ids(d, samples, stream.sample + alive);
    if constexpr (kLoop.collects) compactor.store3(d, radiance, stream.radiance, alive);
    if constexpr (kRecords)
      compactor.store_ids(d, continued(d, history, at.surface, scattered.direction, depth), stream.history + alive);
    alive += compactor.count();
  }
  return alive;
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
