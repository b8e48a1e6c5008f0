// SPDX-License-Identifier: Apache-2.0
// What happens to a path at a vertex: the steps of the path loop, in order.
#pragma once

#include <hwy/highway.h>

#include <cstdint>
#include <limits>

#include "kernel/caustic_sampling-inl.h"
#include "kernel/caustic_transport-inl.h"
#include "kernel/cone-inl.h"
#include "kernel/deposit-inl.h"
#include "kernel/direct_light-inl.h"
#include "kernel/gather-inl.h"
#include "kernel/opacity-inl.h"
#include "kernel/path_stream.h"
#include "kernel/record-inl.h"
#include "kernel/render_tile.h"
#include "kernel/scatter-inl.h"
#include "kernel/seen_emitters-inl.h"
#include "kernel/surface-inl.h"
#include "kernel/surface_texture-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// Compile-time options of an instance of the path loop.
struct Loop {
  Precision precision = Precision::kExact;
  /// Renders all features and fills the tile's records, events and guides; false: neither motion, lights, rods, other
  /// gradients, opacity, textures, rough glass, plastic nor depth cue, and the sums alone.
  bool full = false;
};

/// The features of a scene in this loop. In plain loops, those of full loops are false at compile time.
template <Loop kLoop>
HWY_INLINE Features features_of(const SceneView& scene) {
  Features features = scene.features;
  if (!kLoop.full)
    features.tilted = features.motion = features.lit = features.rich_materials = features.rods = features.opacity =
        features.caustics = features.depth_cue = false;
  return features;
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> background(D d, const Background& sky, const Features& features, const Vec3<V>& direction) {
  const auto bottom = set3(d, sky.bottom);
  if (!features.gradient) return bottom;
  const V half = set(d, 0.5);
  const V height = features.tilted ? dot(set3(d, sky.up), direction) : direction.y;
  const V a = mul_add(height, half, half);
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
  Ids hits;                              ///< objects
  V distance;                            ///< of the hits
  const hn::TFromD<D>* times = nullptr;  ///< null: nothing moves
  const float* thresholds = nullptr;     ///< as in PacketRays
  Ids pixels, samples;
  Vec3<V> throughput;  ///< before the hit
  // Of paths that leave the scene and, with a depth cue, of those that see the background through their first hit.
  hn::Mask<D> see_background;
  Vec3<V> background_throughput;
  Ids history;      ///< only if the tile is recorded
  Ids paths;        ///< as in PathStreamOf
  V pdf;            ///< as in PathStreamOf
  RayCone<V> cone;  ///< at the hits; only in scenes with ray cones
};

/// Records first hits in scenes with rods; see Recorder::first_hit. Not inlined.
///
/// `center`, `offset`  of the sphere that was hit, or of the one that has the rod's place
template <class D, class V = hn::Vec<D>>
HWY_NOINLINE void record_first_hit(D d, const SceneView& scene, const Tile& tile, hn::Vec<IdTag<D>> pixels,
                                   hn::Vec<IdTag<D>> samples, hn::Mask<D> hit, hn::Vec<IdTag<D>> hits, Vec3<V> center,
                                   Vec3<V> offset, Vec3<V> direction, const hn::TFromD<D>* times) {
  Recorder<D>(scene, tile, pixels, samples)
      .first_hit(d, hit, hits, recorded_offset(d, scene, hits, times, center, offset), direction, times);
}

/// Shades the traced packets of one depth.
template <class D, Loop kLoop>
class Shader {
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  using Ids = hn::Vec<IdTag<D>>;

 public:
  HWY_INLINE Shader(const SceneView& scene, const Tile& tile, std::uint32_t depth, PathsOf<T>& paths)
      : scene_(scene), tile_(tile), depth_(depth), paths_(paths), stream_(paths.stream) {}

  /// Adds the radiance that a packet's rays have found to their paths, samples light and directions at the hits, and
  /// moves the surviving paths to position `alive` of the stream.
  ///
  /// `first`    position in the stream of the packet's first path
  /// Result     the position behind the survivors
  HWY_INLINE int shade(const RayPacket<T>& packet, int first, int alive) {
    const bool ends = scene_.shading == Shading::kPath && depth_ + 1 >= scene_.max_depth;
    for (int v = 0; v < packet.count; v += static_cast<int>(hn::Lanes(d))) {
      const Arrivals<D> at = arrive(packet, first, v);
      if (!hn::AllFalse(d, at.see_background)) leave(at);
      if (hn::AllFalse(d, at.hit)) continue;
      if (features().lit) emit(at);
      if (ends && !(records() && depth_ == 0)) continue;
      Lookup<D> look = surface(at);
      const Vec3<V> tinted = at.throughput * look.albedo;
      if (records()) record_surface(at, look, tinted);
      if (ends) continue;
      if (scene_.shading != Shading::kPath) {
        show(at, look);
        continue;
      }
      if (features().lit && samples_lights(scene_)) light(at, look, tinted);
      if (features().caustics) caustics(at, look, tinted);
      alive += scatter(at, look, tinted, alive);
    }
    return alive;
  }

 private:
  static constexpr D d{};
  static constexpr IdTag<D> du{};

  // Functions, so that what a plain loop lacks is false at compile time.
  HWY_INLINE Features features() const { return features_of<kLoop>(scene_); }
  HWY_INLINE bool records() const { return kLoop.full && tile_.is_recorded(); }

  /// Loads a vector of rays and their paths.
  HWY_INLINE Arrivals<D> arrive(const RayPacket<T>& packet, int first, int v) const {
    const int i = first + v;
    Arrivals<D> at;
    const auto active = hn::FirstN(d, static_cast<std::size_t>(packet.count - v));
    at.hits = hn::Load(du, packet.hit + v);
    at.hit = hn::AndNot(hn::RebindMask(d, at.hits == kNone), active);
    at.missed = hn::AndNot(at.hit, active);
    at.ray = load_rays(d, packet, v);
    at.distance = hn::Load(d, packet.distance + v);
    if (features().motion) at.times = packet.time + v;
    if (features().opacity) at.thresholds = packet.threshold + v;
    at.pixels = hn::Load(du, stream_.pixel + i);
    at.samples = hn::Load(du, stream_.sample + i);
    at.paths = hn::Load(du, stream_.path + i);
    at.throughput = load3(d, stream_.throughput, i);
    at.see_background = at.missed;
    at.background_throughput = at.throughput;
    if (features().depth_cue && depth_ == 0) fade(at);
    if (kLoop.full && tile_.covered != nullptr && depth_ == 0) cover(at, i);
    if (records()) {
      at.history = hn::Load(du, stream_.history + i);
      if (depth_ == 0) recorder(at).no_hit(d, at.missed);
    }
    if (features().lit) at.pdf = hn::Load(d, stream_.pdf + i);
    at.cone = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    if (has_cones()) {
      const auto moments = load3(d, stream_.cone, i);
      at.cone = RayCone<V>{moments.x, moments.y, moments.z}.advanced(at.distance);
    }
    return at;
  }

  HWY_INLINE hn::Mask<D> on_page(const Arrivals<D>& at) const {
    return hn::RebindMask(d, at.hits == set(du, scene_.page));
  }

  /// Stores the coverage of paths.
  ///
  /// `i`        position in the stream, which is the index within the batch at first hits
  HWY_INLINE void cover(const Arrivals<D>& at, int i) const {
    V coverage = hn::IfThenElseZero(at.hit, at.throughput.x);  // 1 less what the depth cue takes
    if (scene_.page != kNone) coverage = select(on_page(at), -coverage, coverage);
    hn::Store(coverage, d, paths_.batch.coverage + i);
  }

  /// Divides the throughput of first hits between them and the background.
  HWY_INLINE void fade(Arrivals<D>& at) const {
    const auto share_of = [&](const DepthCue& cue) {
      const V depth = at.distance * dot(set3(d, cue.slope), at.ray.direction);
      return hn::IfThenElseZero(at.hit, max(min(depth - cue.offset, set(d, cue.strength)), hn::Zero(d)));
    };
    V share = share_of(scene_.depth_cue);
    if (scene_.page != kNone) share = select(on_page(at), share_of(scene_.page_fade), share);
    at.see_background = hn::Or(at.missed, share > 0);
    at.background_throughput = at.throughput * select(at.missed, set(d, 1), share);
    at.throughput = at.throughput * (1 - share);
  }

  /// Adds the radiance of the background to paths that see it.
  HWY_INLINE void leave(const Arrivals<D>& at) {
    if (depth_ == 0 && !scene_.background_visible) return;
    Vec3<V> radiance;
    Ids groups = hn::Zero(du);
    if (depth_ == 0 && scene_.has_backdrop) {
      radiance = set3(d, scene_.backdrop);
    } else if (features().lit && scene_.environment != nullptr) {
      radiance = depth_ == 0 ? environment_radiance(d, *scene_.environment, at.ray.direction)
                             : weighted_environment(d, scene_, at.ray.direction, at.pdf);
      if (samples_images())
        radiance = without_sampled_sun(d, scene_, radiance, at.ray.direction, at.see_background, way_of(at));
      groups = set(du, scene_.environment->light_group);
    } else {
      radiance = background(d, scene_.background, features(), at.ray.direction);
    }
    const Vec3<V> light = radiance * at.background_throughput;
    add(at, at.see_background, light, groups, Lobe::kBackground);
    if (records()) {
      const V zero = hn::Zero(d);
      recorder(at).guide(d, hn::And(at.see_background, guided(at)), {min(light.x, 1), min(light.y, 1), min(light.z, 1)},
                         {zero, zero, zero});
    }
  }

  /// Whether images of lights in balls, or emitters that the camera sees, are sampled, so that paths that find them
  /// gain nothing.
  HWY_INLINE bool samples_images() const { return features().caustics || scene_.seen_emitters.begins != nullptr; }

  HWY_INLINE WayToLight<D> way_of(const Arrivals<D>& at) const {
    const auto all = hn::FirstN(d, hn::Lanes(d));
    const auto straight = depth_ == 0 ? all : depth_ == 1 ? hn::IsInf(at.pdf) : hn::Not(all);
    return {features().caustics ? caustic_state_of(at) : hn::Zero(du), at.ray.self, at.pixels, straight};
  }

  /// Adds the radiance that the objects at the hits emit.
  HWY_INLINE void emit(const Arrivals<D>& at) {
    if (scene_.emission == nullptr || scene_.shading != Shading::kPath) return;
    auto source = emitted(d, scene_, at.hits, at.hit);
    const auto dark = hn::And(hn::And(source.radiance.x == 0, source.radiance.y == 0), source.radiance.z == 0);
    auto shines = hn::AndNot(dark, at.hit);
    if (hn::AllFalse(d, shines)) return;
    if (samples_images()) shines = hn::AndNot(are_sampled(d, scene_, shines, way_of(at), at.hits), shines);
    if (features().rich_materials && scene_.textures != nullptr)
      source.radiance = textured_radiance<D, kLoop.precision>(d, scene_, at.ray, at.hits, shines, at.distance,
                                                              at.cone.width2, at.times, source.radiance);
    if (depth_ > 0) {
      const Vertex<D> origin{
          at.ray.origin, at.ray.origin_low, normal_along(at.ray.offset, at.ray.direction), {}, at.times};
      source.radiance = source.radiance * emitter_weight(d, scene_, origin, at.ray.direction, at.hits, at.pdf);
    }
    add(at, shines, source.radiance * at.throughput, source.group, Lobe::kEmission);
  }

  /// Finds points, normals and materials of the hits.
  HWY_INLINE Lookup<D> surface(const Arrivals<D>& at) const {
    auto look = features().rods
                    ? reach_surface_or_rod<D, kLoop.precision>(d, scene_, at.ray, at.hits, at.distance, at.times)
                    : reach_surface<D, kLoop.precision>(d, scene_, at.ray, at.hits, at.distance, at.times);
    if (features().rich_materials && scene_.textures != nullptr) {
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
      if (features().rods)
        record_first_hit(d, scene_, tile_, at.pixels, at.samples, at.hit, at.hits, look.sphere.center,
                         look.surface.offset, at.ray.direction, at.times);
      else
        record.first_hit(d, at.hit, at.hits, look.surface.offset, at.ray.direction, at.times);
      if (features().rich_materials) record.albedo(d, at.hit, look.albedo);
      record.inverse_depth(d, at.hit, at.distance);
    }
    record.guide(d, hn::AndNot(is_delta(d, look.surface), hn::And(at.hit, guided(at))), tinted, look.surface.normal);
  }

  /// Ends paths at the hits with the colour of a shading other than kPath.
  HWY_INLINE void show(const Arrivals<D>& at, const Lookup<D>& look) {
    const V half = set(d, 0.5);
    const bool flat = scene_.shading == Shading::kFlat;
    Vec3<V> color = flat ? look.albedo : mul_add(look.surface.normal, half, {half, half, half});
    if (features().depth_cue) color = color * at.throughput;
    add(at, at.hit, color, hn::Zero(du), Lobe::kBackground);
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
  template <class Waiting>
  HWY_INLINE void wait(const Compactor<D>& chosen, const Arrivals<D>& at, const Lookup<D>& look, const Vec3<V>& value,
                       Waiting& waiting) const {
    const int n = waiting.count;
    chosen.store3(d, look.sphere.center, waiting.base, n);
    chosen.store3(d, look.surface.offset, waiting.offset, n);
    chosen.store3(d, value, waiting.value, n);
    if (features().motion) chosen.store(d, hn::Load(d, at.times), waiting.time + n);
    if (features().opacity) chosen.store(d, load_floats(d, at.thresholds), waiting.threshold + n);
    chosen.store_ids(d, at.hits, waiting.self + n);
    chosen.store_ids(d, index_of(at), waiting.path + n);
    waiting.count += chosen.count();
  }

  /// Samples a light at each vertex whose material is neither delta nor an emitter and appends shadow rays to the
  /// shadow stream.
  HWY_INLINE void light(const Arrivals<D>& at, const Lookup<D>& look, const Vec3<V>& tinted) {
    const Surface<D>& surface = look.surface;
    const auto scatters =
        hn::AndNot(hn::Or(has_trait<&MaterialTraits::absorbs>(d, surface), is_delta(d, surface)), at.hit);
    if (hn::AllFalse(d, scatters)) return;

    // Sample a light.
    const auto random =
        second_random_at_vertex(d, scene_.sampler, at.pixels, at.samples, depth_ + 1, chooses_light(scene_));
    Vertex<D> vertex = vertex_at(at, look);
    if (has_cones()) vertex.cone = {at.cone.width2, hn::Zero(d), lobe_slope2(d, surface, scene_.cone_width)};
    const auto sample = sample_light(d, scene_, vertex, random);
    // Two lobes of plastic have a weight each, and share the shadow ray.
    const V pdf = pdf_bsdf(d, features(), surface, sample.direction);
    const V factor = light_sample_factor(scene_.direct_lighting, pdf * sample.inverse_pdf / sample.probability);
    auto may_arrive = hn::And(scatters, sample.probability > 0);
    if (features().opacity) {
      const auto lamps = hn::RebindMask(d, sample.target != set(du, kNone));
      const auto visible = visible_objects(d, at.thresholds, sample.target, lamps, scene_.opacity);
      may_arrive = hn::And(may_arrive, hn::Or(hn::Not(lamps), visible));
    }
    auto lanes = hn::And(may_arrive, factor > 0);
    Vec3<V> arriving = sample.radiance * tinted * factor, coat = arriving;
    auto in_coat = hn::And(may_arrive, has_coat(surface));
    if (features().rich_materials && !hn::AllFalse(d, in_coat)) {
      const V coat_factor = light_sample_factor(
          scene_.direct_lighting, pdf_coat(surface, sample.direction) * sample.inverse_pdf / sample.probability);
      in_coat = hn::And(in_coat, coat_factor > 0);
      coat = masked(in_coat, sample.radiance * at.throughput * coat_factor);
      arriving = arriving + coat;
      lanes = hn::Or(lanes, in_coat);
    }
    if (hn::AllFalse(d, lanes)) return;

    // Append rays.
    auto& shadow = paths_.shadow;
    const int n = shadow.count;
    const Compactor<D> compactor(d, lanes);
    wait(compactor, at, look, arriving, shadow);
    compactor.store3(d, sample.reach, shadow.direction, n);
    compactor.store(d, sample.distance, shadow.distance + n);
    compactor.store_ids(d, sample.target, shadow.target + n);
    if (!tile_.has_events()) return;
    Ids history = history_after(at, surface, surface.normal);
    if (features().rich_materials) {
      compactor.store3(d, coat, shadow.coat, n);
      Surface<D> lobe = surface;
      lobe.kind = lobe_kinds(surface, in_coat);
      compactor.store_ids(d, history_after(at, lobe, surface.normal), shadow.coat_history + n);
      history = hn::Or(history, hn::IfThenElseZero(hn::RebindMask(du, in_coat), set(du, kCoatBit)));
    }
    compactor.store_ids(d, history, shadow.history + n);
    compactor.store_ids(d, sample.group, shadow.group + n);
  }

  /// Chooses a ball at diffuse vertices and appends those that are sampled to the waiting vertices.
  HWY_INLINE void caustics(const Arrivals<D>& at, const Lookup<D>& look, const Vec3<V>& tinted) {
    const Surface<D>& surface = look.surface;
    const auto diffuse = hn::And(at.hit, has_trait<&MaterialTraits::is_diffuse>(d, surface));
    if (sampled_events(scene_, depth_) < 1 || hn::AllFalse(d, diffuse)) return;

    // Choose a ball, and whether to sample it.
    const auto random = second_random_at_vertex(d, scene_.sampler, at.pixels, at.samples, depth_ + 1, true);
    const auto chosen = choose_ball(d, scene_.caustics, vertex_at(at, look), random.v[2]);
    Vec3<V> value = tinted;
    if (features().rich_materials) value = select(has_coat(surface), value * (1 - coat_share(surface)), value);
    const V chance = caustic_chance(scene_.caustics, chosen.importance, max(value));
    const auto lanes = hn::And(hn::And(diffuse, chosen.probability > 0), random.v[3] < chance);
    if (hn::AllFalse(d, lanes)) return;

    // Append vertices.
    auto& waiting = paths_.vertices;
    const int n = waiting.count;
    const V one = set(d, 1);
    const Compactor<D> compactor(d, lanes);
    wait(compactor, at, look, value * (1 / (chance * chosen.probability)), waiting);
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

  /// Samples the BSDF, and moves the surviving paths to position `alive` of the stream.
  ///
  /// Result     their number
  HWY_INLINE int scatter(const Arrivals<D>& at, Lookup<D>& look, const Vec3<V>& tinted, int alive) {
    // Sample a direction.
    const Surface<D>& surface = look.surface;
    const bool plays_roulette = depth_ + 1 >= scene_.roulette_depth;
    const auto random = random_at_vertex(d, scene_.sampler, at.pixels, at.samples, depth_ + 1, plays_roulette);
    const auto scattered = sample_bsdf(d, features(), surface, random);
    Vec3<V> throughput = tinted;
    if (features().rich_materials) throughput = select(scattered.in_coat, at.throughput, tinted);

    // End paths.
    auto survives = hn::And(at.hit, scattered.alive);
    if (features().lit) survives = hn::AndNot(has_trait<&MaterialTraits::absorbs>(d, surface), survives);
    if (plays_roulette) survives = hn::And(survives, survives_roulette(random.v[2], throughput));

    // Move the others.
    const Compactor<D> compactor(d, survives);
    compactor.store3(d, look.sphere.center, stream_.base, alive);
    compactor.store3(d, surface.offset, stream_.offset, alive);
    compactor.store3(d, scattered.direction, stream_.direction, alive);
    compactor.store3(d, throughput, stream_.throughput, alive);
    compactor.store_ids(d, at.hits, stream_.self + alive);
    compactor.store_ids(d, at.pixels, stream_.pixel + alive);
    compactor.store_ids(d, at.samples, stream_.sample + alive);
    Ids paths = at.paths;
    if (features().caustics) {
      const auto diffuse = hn::AndNot(scattered.in_coat, has_trait<&MaterialTraits::is_diffuse>(d, surface));
      const Ids state = continued_state(d, scene_.caustics, {caustic_state_of(at), at.ray.self, at.hits}, surface,
                                        scattered.direction, diffuse);
      paths = hn::Or(index_of(at), hn::ShiftLeft<kPathBits>(state));
    }
    compactor.store_ids(d, paths, stream_.path + alive);
    if (features().lit) compactor.store(d, scattered_pdf(at, surface, scattered), stream_.pdf + alive);
    if (features().rich_materials) look.surface.kind = lobe_kinds(surface, scattered.in_coat);
    if (has_cones()) {
      const auto cone = scattered_cone(d, at.cone, surface, look.sphere.radius, scattered.direction, scene_.cone_width);
      compactor.store3(d, Vec3<V>{cone.width2, cone.mixed, cone.slope2}, stream_.cone, alive);
    }
    if (records()) {
      Ids history = history_after(at, surface, scattered.direction);
      // The guide of plastic is its surface, even if the coat is delta.
      if (features().rich_materials)
        history =
            hn::AndNot(hn::IfThenElseZero(hn::RebindMask(du, scattered.in_coat), set(du, kOnlyDeltaBit)), history);
      compactor.store_ids(d, history, stream_.history + alive);
    }
    return compactor.count();
  }

  /// The densities of sampled directions, for the weight of light that they find; infinite where only the BSDF finds
  /// it.
  HWY_INLINE V scattered_pdf(const Arrivals<D>& at, const Surface<D>& surface, const BsdfSample<D>& scattered) const {
    const V delta = hn::Set(d, std::numeric_limits<T>::infinity());
    const auto has_density = hn::AndNot(is_delta(d, surface), at.hit);
    const V pdf = select(has_density, pdf_bsdf(d, features(), surface, scattered.direction), delta);
    if (!features().rich_materials || hn::AllFalse(d, scattered.in_coat)) return pdf;
    const V coat = select(surface.fuzz < kSharpCoat, delta, pdf_coat(surface, scattered.direction));
    return select(scattered.in_coat, coat, pdf);
  }

  /// Adds radiance to paths.
  ///
  /// `groups`   light groups of the sources
  HWY_INLINE void add(const Arrivals<D>& at, hn::Mask<D> lanes, const Vec3<V>& light, Ids groups, Lobe unscattered) {
    if (kLoop.full) recorder(at).event(d, lanes, light, at.history, groups, unscattered);
    gain(d, lanes, light, index_of(at), paths_.batch);
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
  /// Indices within the batch.
  HWY_INLINE Ids index_of(const Arrivals<D>& at) const {
    return features().caustics ? hn::And(at.paths, set(du, (1U << kPathBits) - 1)) : at.paths;
  }
  static HWY_INLINE Ids caustic_state_of(const Arrivals<D>& at) { return hn::ShiftRight<kPathBits>(at.paths); }
  HWY_INLINE bool has_cones() const { return features().rich_materials && scene_.cone_width > 0; }
  static HWY_INLINE hn::Mask<D> has_coat(const Surface<D>& surface) {
    return is_kind(d, surface.kind, MaterialKind::kPlastic);
  }

  const SceneView& scene_;
  const Tile& tile_;
  const std::uint32_t depth_;
  PathsOf<T>& paths_;
  PathStreamOf<T>& stream_;
};

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
