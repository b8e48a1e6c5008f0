// SPDX-License-Identifier: Apache-2.0
// Shading of traced packets. Compiled once per instruction set.
#if defined(ORRERY_KERNEL_SHADE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_KERNEL_SHADE_INL_H_
#undef ORRERY_KERNEL_SHADE_INL_H_
#else
#define ORRERY_KERNEL_SHADE_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>
#include <limits>

#include "kernel/caustic_light-inl.h"
#include "kernel/caustic_partition-inl.h"
#include "kernel/compaction-inl.h"
#include "kernel/cone-inl.h"
#include "kernel/deposit-inl.h"
#include "kernel/direct_light-inl.h"
#include "kernel/opacity-inl.h"
#include "kernel/path_stream.h"
#include "kernel/record-inl.h"
#include "kernel/render_tile.h"
#include "kernel/scatter-inl.h"
#include "kernel/surface-inl.h"
#include "kernel/surface_texture-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// Compile-time options of an instance of the path loop.
struct Loop {
  Precision precision = Precision::kExact;
  /// Renders all features and fills the tile's records, events and guides; false: neither motion, lights, rods,
  /// opacity, textures, rough glass nor plastic, and the sums alone.
  bool full = false;
  bool plastic = false;  ///< scatters vectors in which a lane hit plastic; full loops have such a part
};

/// The features of a scene in this loop. In plain loops, those of full loops are false at compile time.
template <Loop kLoop>
HWY_INLINE Features features_of(const SceneView& scene) {
  Features features = scene.features;
  if (!kLoop.full)
    features.motion = features.lit = features.rich_materials = features.rods = features.opacity = features.caustics =
        false;
  return features;
}

/// Path state of a packet's rays other than their geometry, in the packet's lane order.
template <class T>
struct alignas(64) PathPayload {
  using Id = IdOf<T>;
  T throughput[3][kPacketSize];
  Id pixel[kPacketSize];
  Id sample[kPacketSize];
  Id history[kPacketSize];  ///< if the tile is recorded; see record-inl.h
  Id path[kPacketSize];     ///< in full loops: see LitPathsOf
  T pdf[kPacketSize];       ///< in full loops: see LitPathsOf
  T cone[3][kPacketSize];   ///< in full loops: see PathStreamOf
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> background(D d, const Background& sky, bool has_gradient, const Vec3<V>& direction) {
  const auto bottom = set3(d, sky.bottom);
  if (!has_gradient) return bottom;
  const V half = set(d, 0.5);
  const V a = mul_add(direction.y, half, half);
  const V one_minus_a = 1 - a;
  return mul_add(set3(d, sky.top), a, bottom * one_minus_a);
}

/// Russian roulette: ends paths with a probability that rises as their throughput falls and divides the throughput of
/// the others by their survival probability, which keeps the estimate unbiased.
///
/// Reference  arvo1990
template <class V>
HWY_INLINE auto survives_roulette(V u, Vec3<V>& throughput) {
  const V brightest = max(throughput);
  const V chance = min(brightest * kRouletteGain, 1);
  const auto stronger = 1 / chance;
  const auto survives = u < chance;
  throughput = {throughput.x * stronger, throughput.y * stronger, throughput.z * stronger};
  return survives;
}

/// Rays that were traced, one per lane, and the state of their paths.
template <class D>
struct Arrivals {
  using V = hn::Vec<D>;
  using Ids = hn::Vec<IdTag<D>>;
  hn::Mask<D> hit, missed;
  Rays<D> ray;
  Ids hits;                              ///< ids of spheres and halves of rods
  V distance;                            ///< of the hits
  const hn::TFromD<D>* times = nullptr;  ///< null: nothing moves
  Ids pixels, samples;
  Vec3<V> throughput;  ///< before the hit
  Ids history;         ///< only if the tile is recorded
  Ids paths;           ///< only in full loops: see LitPathsOf
  V pdf;               ///< only in full loops: see LitPathsOf
  RayCone<V> cone;     ///< at the hits; only in scenes with ray cones
};

/// Records first hits in scenes with rods; see Recorder::first_hit. Not inlined, so that the loop costs the same
/// without them.
///
/// `center`, `offset`  of the sphere that was hit, or of the one that has the rod's place
template <class D, class V = hn::Vec<D>>
HWY_NOINLINE void record_first_hit(D d, const SceneView& scene, const Tile& tile, hn::Vec<IdTag<D>> pixels,
                                   hn::Vec<IdTag<D>> samples, hn::Mask<D> hit, hn::Vec<IdTag<D>> hits, Vec3<V> center,
                                   Vec3<V> offset, Vec3<V> direction, const hn::TFromD<D>* times) {
  Recorder<D>(scene, tile, pixels, samples)
      .first_hit(d, hit, hits, recorded_offset(d, scene, hits, times, center, offset), direction, times);
}

template <class D, Loop kLoop>
int shade_plastic(const SceneView& scene, const Tile& tile, std::uint32_t depth, PathStreamOf<hn::TFromD<D>>& stream,
                  TileCounts& counts, const RayPacket<hn::TFromD<D>>& packet, const PathPayload<hn::TFromD<D>>& carried,
                  int v, int alive);

/// Shades traced packets of one depth.
template <class D, Loop kLoop>
class Shader {
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  using Ids = hn::Vec<IdTag<D>>;
  using Stream = PathStreamOf<T>;

 public:
  HWY_INLINE Shader(const SceneView& scene, const Tile& tile, std::uint32_t depth, Stream& stream, TileCounts& counts)
      : scene_(scene),
        features_(features_of<kLoop>(scene)),
        tile_(tile),
        records_(kLoop.full && tile.is_recorded()),
        depth_(depth),
        stream_(stream),
        counts_(counts) {}

  /// Adds the radiance that reaches the camera along the packet's paths to their pixels (in full loops: to their sums
  /// in `stream.lit`) and appends the surviving paths to the stream.
  ///
  /// Result     number of paths in the stream; `alive` is their number before the call
  HWY_INLINE int shade(const RayPacket<T>& packet, const PathPayload<T>& carried, int alive) {
    const bool ends = scene_.shading == Shading::kPath && depth_ + 1 >= scene_.max_depth;
    for (int v = 0; v < packet.count; v += static_cast<int>(hn::Lanes(d))) {
      const Arrivals<D> at = arrive(packet, carried, v);
      if (!hn::AllFalse(d, at.missed)) leave(at);
      if (hn::AllFalse(d, at.hit)) continue;
      if (features_.lit) emit(at);
      if (ends && !(records_ && depth_ == 0)) continue;
      Lookup<D> look = surface(at);
      const Vec3<V> tinted = at.throughput * look.albedo;
      if (records_) record_surface(at, look, tinted);
      if (ends) continue;
      if (scene_.shading != Shading::kPath) {
        show(at, look);
        continue;
      }
      if constexpr (kLoop.full) {
        const auto plastic = is_kind(d, look.surface.kind, MaterialKind::kPlastic);
        if (features_.rich_materials && !hn::AllFalse(d, plastic)) {
          alive += shade_plastic<D, kLoop>(scene_, tile_, depth_, stream_, counts_, packet, carried, v, alive);
          continue;
        }
      }
      alive += scatter_and_light(at, look, tinted, alive);
    }
    return alive;
  }

  /// Samples lights and BSDFs at the hits of a vector in which a lane hit plastic; see shade_plastic().
  HWY_INLINE int sample_plastic_hits(const RayPacket<T>& packet, const PathPayload<T>& carried, int v, int alive) {
    const Arrivals<D> at = arrive(packet, carried, v);
    Lookup<D> look = surface(at);
    return scatter_and_light(at, look, at.throughput * look.albedo, alive);
  }

  /// Samples lights and BSDFs at hits; see scatter() and light().
  HWY_INLINE int scatter_and_light(const Arrivals<D>& at, Lookup<D>& look, const Vec3<V>& tinted, int alive) {
    if (features_.lit && samples_lights(scene_)) light(at, look, tinted);
    return scatter(at, look, tinted, alive);
  }

 private:
  static constexpr D d{};
  static constexpr IdTag<D> du{};

  /// Loads a vector of rays and paths.
  HWY_INLINE Arrivals<D> arrive(const RayPacket<T>& packet, const PathPayload<T>& carried, int v) const {
    Arrivals<D> at;
    const auto active = hn::FirstN(d, static_cast<std::size_t>(packet.count - v));
    at.hits = hn::Load(du, packet.hit + v);
    at.hit = hn::AndNot(hn::RebindMask(d, at.hits == kNone), active);
    at.missed = hn::AndNot(at.hit, active);
    at.ray = load_rays(d, packet, v);
    at.distance = hn::Load(d, packet.distance + v);
    if (features_.motion) at.times = packet.time + v;
    at.pixels = hn::Load(du, carried.pixel + v);
    at.samples = hn::Load(du, carried.sample + v);
    at.throughput = load3(d, carried.throughput, v);
    if (records_) {
      at.history = hn::Load(du, carried.history + v);
      if (depth_ == 0) recorder(at).begin(d, active, at.missed);
    }
    if (kLoop.full) {
      at.paths = hn::Load(du, carried.path + v);
      at.pdf = hn::Load(d, carried.pdf + v);
    }
    at.cone = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    if (has_cones()) {
      const auto moments = load3(d, carried.cone, v);
      at.cone = RayCone<V>{moments.x, moments.y, moments.z}.advanced(at.distance);
    }
    return at;
  }

  /// Adds the radiance of the background to paths that leave the scene.
  HWY_INLINE void leave(const Arrivals<D>& at) {
    if (depth_ == 0 && !scene_.background_visible) return;
    Vec3<V> radiance;
    Ids groups = hn::Zero(du);
    if (depth_ == 0 && scene_.has_backdrop) {
      radiance = set3(d, scene_.backdrop);
    } else if (features_.lit && scene_.environment != nullptr) {
      radiance = depth_ == 0 ? environment_radiance(d, *scene_.environment, at.ray.direction)
                             : weighted_environment(d, scene_, at.ray.direction, at.pdf);
      if (features_.caustics)
        radiance = without_sampled_sun(d, scene_, radiance, at.ray.direction, at.missed, chain_of(at), at.ray.self);
      groups = set(du, scene_.environment->light_group);
    } else {
      radiance = background(d, scene_.background, features_.gradient, at.ray.direction);
    }
    const Vec3<V> light = radiance * at.throughput;
    add(at, at.missed, light, groups, Lobe::kBackground);
    if (records_) {
      const V zero = hn::Zero(d);
      recorder(at).guide(d, hn::And(at.missed, guided(at)), {min(light.x, 1), min(light.y, 1), min(light.z, 1)},
                         {zero, zero, zero});
    }
  }

  /// Adds the radiance that the spheres at the hits emit.
  HWY_INLINE void emit(const Arrivals<D>& at) {
    if (scene_.emission == nullptr || scene_.shading != Shading::kPath) return;
    auto source = emitted(d, scene_, at.hits, at.hit);
    const auto dark = hn::And(hn::And(source.radiance.x == 0, source.radiance.y == 0), source.radiance.z == 0);
    auto shines = hn::AndNot(dark, at.hit);
    if (hn::AllFalse(d, shines)) return;
    if (features_.caustics)
      shines = hn::AndNot(is_sampled_caustic(d, scene_, shines, chain_of(at), at.ray.self, at.hits), shines);
    if (features_.rich_materials && scene_.textures != nullptr)
      source.radiance = textured_radiance<D, kLoop.precision>(d, scene_, at.ray, at.hits, shines, at.distance,
                                                              at.cone.width2, at.times, source.radiance);
    if (depth_ > 0) {
      const Vertex<D> origin{
          at.ray.origin, at.ray.origin_low, normal_along(at.ray.offset, at.ray.direction), {}, at.times};
      source.radiance = source.radiance * emitter_weight(d, scene_, origin, at.hits, at.pdf);
    }
    add(at, shines, source.radiance * at.throughput, source.group, Lobe::kEmission);
  }

  /// Finds points, normals and materials of the hits.
  HWY_INLINE Lookup<D> surface(const Arrivals<D>& at) const {
    auto look = features_.rods
                    ? reach_surface_or_rod<D, kLoop.precision>(d, scene_, at.ray, at.hits, at.distance, at.times)
                    : reach_surface<D, kLoop.precision>(d, scene_, at.ray, at.hits, at.distance, at.times);
    if (features_.rich_materials && scene_.textures != nullptr) {
      const auto textured =
          textured_surface<D, kLoop.precision>(d, scene_, at.ray, at.hits, at.hit, at.distance, at.cone.width2, look);
      look.albedo = textured.albedo;
      look.surface.fuzz = textured.fuzz;
    }
    return look;
  }

  /// Records first hits and guides.
  ///
  /// `tinted`   throughput times albedo
  HWY_INLINE void record_surface(const Arrivals<D>& at, const Lookup<D>& look, const Vec3<V>& tinted) const {
    auto record = recorder(at);
    if (depth_ == 0) {
      if (features_.rods)
        record_first_hit(d, scene_, tile_, at.pixels, at.samples, at.hit, at.hits, look.sphere.center,
                         look.surface.offset, at.ray.direction, at.times);
      else
        record.first_hit(d, at.hit, at.hits, look.surface.offset, at.ray.direction, at.times);
      if (features_.rich_materials) record.albedo(d, at.hit, look.albedo);
      record.inverse_depth(d, at.hit, at.distance);
    }
    record.guide(d, hn::AndNot(is_delta(d, look.surface), hn::And(at.hit, guided(at))), tinted, look.surface.normal);
  }

  /// Ends paths at the hits with the colour of a shading other than kPath.
  HWY_INLINE void show(const Arrivals<D>& at, const Lookup<D>& look) {
    const V half = set(d, 0.5);
    const bool flat = scene_.shading == Shading::kFlat;
    add(at, at.hit, flat ? look.albedo : mul_add(look.surface.normal, half, {half, half, half}), hn::Zero(du),
        Lobe::kBackground);
  }

  /// The hits as points from which light is sampled.
  HWY_INLINE Vertex<D> vertex_at(const Arrivals<D>& at, const Lookup<D>& look) const {
    const Vec3<V>&center = look.sphere.center, &offset = look.surface.offset;
    const auto origin = center + offset;
    const auto unit = normalized(offset);
    return {origin, sum_error(center, offset, origin), select(look.surface.from_outside, unit, negated(unit)), at.cone,
            at.times};
  }

  /// Appends chosen hits to those that wait for light.
  ///
  /// `key`      of the rays that leave them
  template <class Waiting>
  HWY_INLINE void wait(const Compactor<D>& chosen, const Arrivals<D>& at, const Lookup<D>& look, const Vec3<V>& value,
                       Ids RayKeys<IdTag<D>>::*key, Waiting& waiting) const {
    const int n = waiting.count;
    chosen.store3(d, look.sphere.center, waiting.base, n);
    chosen.store3(d, look.surface.offset, waiting.offset, n);
    chosen.store3(d, value, waiting.value, n);
    if (features_.motion) chosen.store(d, hn::Load(d, at.times), waiting.time + n);
    if (features_.opacity) {
      const auto keys = keys_at_vertex(du, scene_.sampler.seed, at.pixels, at.samples, depth_ + 1);
      chosen.store_ids(d, keys.*key, waiting.key + n);
    }
    chosen.store_ids(d, at.hits, waiting.self + n);
    chosen.store_ids(d, index_of(at), waiting.path + n);
    waiting.count += chosen.count();
  }

  /// Samples a light at each vertex whose material is neither delta nor an emitter and appends shadow rays to the
  /// shadow stream.
  HWY_INLINE void light(const Arrivals<D>& at, const Lookup<D>& look, const Vec3<V>& tinted) {
    const Surface<D>& surface = look.surface;
    const auto scatters = hn::AndNot(is_kind(d, surface.kind, MaterialKind::kEmitter), has_pdf(at, look));
    if (hn::AllFalse(d, scatters)) return;
    const auto random =
        second_random_at_vertex(d, scene_.sampler, at.pixels, at.samples, depth_ + 1, chooses_light(scene_));
    Vertex<D> vertex = vertex_at(at, look);
    if (has_cones()) vertex.cone = {at.cone.width2, hn::Zero(d), lobe_slope2(d, surface, scene_.cone_width)};
    const auto sample = sample_light(d, scene_, vertex, random);
    const V pdf = pdf_bsdf<kLoop.plastic>(d, features_, surface, sample.direction);
    const V factor = light_sample_factor(scene_.direct_lighting, pdf * sample.inverse_pdf / sample.probability);
    auto lanes = hn::And(scatters, hn::And(sample.probability > 0, factor > 0));
    Vec3<V> arriving = sample.radiance * tinted * factor;
    Vec3<V> coat = arriving;
    auto in_coat = lanes;
    if constexpr (kLoop.plastic) {
      const V coat_factor = light_sample_factor(
          scene_.direct_lighting, pdf_coat(surface, sample.direction) * sample.inverse_pdf / sample.probability);
      in_coat = hn::And(hn::And(scatters, is_kind(d, surface.kind, MaterialKind::kPlastic)),
                        hn::And(sample.probability > 0, coat_factor > 0));
      coat = masked(in_coat, sample.radiance * at.throughput * coat_factor);
      arriving = arriving + coat;
      lanes = hn::Or(lanes, in_coat);
    }
    if (hn::AllFalse(d, lanes)) return;

    auto& shadow = stream_.lit.shadow;
    const int n = shadow.count;
    const Compactor<D> compactor(d, lanes);
    wait(compactor, at, look, arriving, &RayKeys<IdTag<D>>::shadow, shadow);
    compactor.store3(d, sample.reach, shadow.direction, n);
    compactor.store(d, sample.distance, shadow.distance + n);
    compactor.store_ids(d, sample.target, shadow.target + n);
    if (tile_.has_events()) {
      Ids history = history_after(at, surface, surface.normal);
      if constexpr (kLoop.plastic) {
        compactor.store3(d, coat, shadow.coat, n);
        Surface<D> lobe = surface;
        lobe.kind = lobe_kinds(surface, in_coat);
        compactor.store_ids(d, history_after(at, lobe, surface.normal), shadow.coat_history + n);
        history = hn::Or(history, hn::IfThenElseZero(hn::RebindMask(du, in_coat), set(du, kCoatBit)));
      }
      compactor.store_ids(d, history, shadow.history + n);
      compactor.store_ids(d, sample.group, shadow.group + n);
    }
  }

  /// Chooses a ball at diffuse vertices and appends those that are sampled to the waiting vertices.
  HWY_INLINE void caustics(const Arrivals<D>& at, const Lookup<D>& look, const Vec3<V>& tinted) {
    const Surface<D>& surface = look.surface;
    const auto diffuse = hn::And(at.hit, is_diffuse(d, surface));
    if (sampled_events(scene_, depth_) < 1 || hn::AllFalse(d, diffuse)) return;
    const auto random = second_random_at_vertex(d, scene_.sampler, at.pixels, at.samples, depth_ + 1, true);
    const auto chosen = choose_ball(d, scene_.caustics, vertex_at(at, look), random.v[2]);
    Vec3<V> value = tinted;
    if constexpr (kLoop.plastic)
      value = select(is_kind(d, surface.kind, MaterialKind::kPlastic), value * (1 - coat_share(surface)), value);
    const V chance = caustic_chance(scene_.caustics, chosen.importance, max(value));
    const auto lanes = hn::And(hn::And(diffuse, chosen.probability > 0), random.v[3] < chance);
    if (hn::AllFalse(d, lanes)) return;
    auto& waiting = stream_.lit.vertices;
    const int n = waiting.count;
    const V one = set(d, 1);
    const Compactor<D> compactor(d, lanes);
    wait(compactor, at, look, value * (1 / (chance * chosen.probability)), &RayKeys<IdTag<D>>::chain, waiting);
    compactor.store(d, random.v[0], waiting.random[0] + n);
    compactor.store(d, random.v[1], waiting.random[1] + n);
    compactor.store(d, chosen.rest, waiting.random[2] + n);
    compactor.store(d, random.v[3] / chance, waiting.random[3] + n);
    compactor.store(d, select(surface.from_outside, one, -one), waiting.side + n);
    compactor.store(d, hn::IfThenElseZero(is_kind(d, surface.kind, MaterialKind::kHemisphere), one),
                    waiting.uniform + n);
    compactor.store_ids(d, chosen.index, waiting.ball + n);
    if (tile_.has_events()) {
      // The light has the lobe of this vertex and is indirect, like that of a path which finds it.
      const auto history = history_after(at, surface, surface.normal);
      compactor.store_ids(d, hn::Or(history, set(du, kIndirectBit)), waiting.history + n);
    }
  }

  /// Samples the BSDF, appends the surviving paths to the stream, and samples caustics: in one function, because
  /// another branch on a feature slows scenes without it.
  ///
  /// Result     their number
  HWY_INLINE int scatter(const Arrivals<D>& at, Lookup<D>& look, const Vec3<V>& tinted, int alive) {
    const Surface<D>& surface = look.surface;
    const bool plays_roulette = depth_ + 1 >= scene_.roulette_depth;
    const auto random = random_at_vertex(d, scene_.sampler, at.pixels, at.samples, depth_ + 1, plays_roulette);
    const auto scattered = sample_bsdf<kLoop.plastic>(d, features_, surface, random);
    Vec3<V> throughput = tinted;
    if constexpr (kLoop.plastic) throughput = select(scattered.in_coat, at.throughput, tinted);
    auto survives = hn::And(at.hit, scattered.alive);
    if (features_.lit) survives = hn::AndNot(is_kind(d, surface.kind, MaterialKind::kEmitter), survives);
    if (plays_roulette) survives = hn::And(survives, survives_roulette(random.v[2], throughput));
    const Compactor<D> compactor(d, survives);
    compactor.store3(d, look.sphere.center, stream_.base, alive);
    compactor.store3(d, surface.offset, stream_.offset, alive);
    compactor.store3(d, scattered.direction, stream_.direction, alive);
    compactor.store3(d, throughput, stream_.throughput, alive);
    compactor.store_ids(d, at.hits, stream_.self + alive);
    compactor.store_ids(d, at.pixels, stream_.pixel + alive);
    compactor.store_ids(d, at.samples, stream_.sample + alive);
    if (kLoop.full) {
      Ids paths = at.paths;
      if (features_.caustics) {
        caustics(at, look, tinted);
        const auto diffuse = hn::AndNot(scattered.in_coat, is_diffuse(d, surface));
        const Ids chain = continued_chain(d, scene_.caustics, {chain_of(at), at.ray.self, at.hits}, surface,
                                          scattered.direction, diffuse);
        paths = hn::Or(index_of(at), hn::ShiftLeft<kPathBits>(chain));
      }
      compactor.store_ids(d, paths, stream_.lit.path + alive);
    }
    if (features_.lit) {
      const V delta = hn::Set(d, std::numeric_limits<T>::infinity());
      V pdf = select(has_pdf(at, look), pdf_bsdf<kLoop.plastic>(d, features_, surface, scattered.direction), delta);
      if constexpr (kLoop.plastic) {
        const V coat = select(surface.fuzz < kSharpCoat, delta, pdf_coat(surface, scattered.direction));
        pdf = select(scattered.in_coat, coat, pdf);
      }
      compactor.store(d, pdf, stream_.lit.pdf + alive);
    }
    if constexpr (kLoop.plastic) look.surface.kind = lobe_kinds(surface, scattered.in_coat);
    if (has_cones()) {
      const auto cone = scattered_cone(d, at.cone, surface, look.sphere.radius, scattered.direction, scene_.cone_width);
      compactor.store3(d, Vec3<V>{cone.width2, cone.mixed, cone.slope2}, stream_.cone, alive);
    }
    if (records_) {
      Ids history = history_after(at, surface, scattered.direction);
      // The guide of plastic is its surface, even if the coat is delta.
      if constexpr (kLoop.plastic)
        history =
            hn::AndNot(hn::IfThenElseZero(hn::RebindMask(du, scattered.in_coat), set(du, kOnlyDeltaBit)), history);
      compactor.store_ids(d, history, stream_.history + alive);
    }
    return compactor.count();
  }

  /// Adds radiance that arrives along paths. They end, unless the loop is full.
  ///
  /// `groups`   light groups of the sources
  HWY_INLINE void add(const Arrivals<D>& at, hn::Mask<D> lanes, const Vec3<V>& light, Ids groups, Lobe unscattered) {
    if (kLoop.full) {
      recorder(at).event(d, lanes, light, at.history, groups, unscattered);
      gain(d, lanes, light, index_of(at), stream_.lit);
    } else {
      deposit(d, lanes, light, at.pixels, at.samples, scene_, tile_, counts_);
    }
  }

  HWY_INLINE Recorder<D> recorder(const Arrivals<D>& at) const { return {scene_, tile_, at.pixels, at.samples}; }
  /// Paths that only delta materials have scattered: their next surface or background is their guide.
  HWY_INLINE hn::Mask<D> guided(const Arrivals<D>& at) const {
    const auto only_delta = set(du, kOnlyDeltaBit);
    return hn::RebindMask(d, hn::And(at.history, only_delta) == only_delta);
  }
  HWY_INLINE Ids history_after(const Arrivals<D>& at, const Surface<D>& surface, const Vec3<V>& direction) const {
    return continued(d, at.history, surface, direction, depth_, tile_.events != nullptr);
  }
  /// Kinds of materials that scatter like the lobes: the coat of plastic, in some lanes, like metal.
  static HWY_INLINE Ids lobe_kinds(const Surface<D>& surface, hn::Mask<D> in_coat) {
    return select(hn::RebindMask(du, in_coat), set(du, MaterialKind::kMetal), surface.kind);
  }
  static HWY_INLINE Ids index_of(const Arrivals<D>& at) { return hn::And(at.paths, set(du, (1U << kPathBits) - 1)); }
  static HWY_INLINE Ids chain_of(const Arrivals<D>& at) { return hn::ShiftRight<kPathBits>(at.paths); }
  HWY_INLINE bool has_cones() const { return features_.rich_materials && scene_.cone_width > 0; }
  HWY_INLINE hn::Mask<D> has_pdf(const Arrivals<D>& at, const Lookup<D>& look) const {
    return hn::AndNot(is_delta(d, look.surface), at.hit);
  }

  const SceneView& scene_;
  const Features features_;
  const Tile& tile_;
  const bool records_;
  const std::uint32_t depth_;
  Stream& stream_;
  TileCounts& counts_;
};

/// Samples lights and BSDFs at hits of which some are on plastic. Neither inlined nor passed what the loop has computed
/// of them, so that the loop costs the same without plastic.
///
/// `v`        the vector's first lane in the packet
/// Result     number of paths appended to the stream
template <class D, Loop kLoop>
HWY_NOINLINE int shade_plastic(const SceneView& scene, const Tile& tile, std::uint32_t depth,
                               PathStreamOf<hn::TFromD<D>>& stream, TileCounts& counts,
                               const RayPacket<hn::TFromD<D>>& packet, const PathPayload<hn::TFromD<D>>& carried, int v,
                               int alive) {
  constexpr Loop kPlastic{kLoop.precision, kLoop.full, true};
  return Shader<D, kPlastic>(scene, tile, depth, stream, counts).sample_plastic_hits(packet, carried, v, alive);
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
