// SPDX-License-Identifier: Apache-2.0
// Sampling of caustics: balls, lights, and directions in the images of a light in a ball.
#pragma once

#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include "kernel/caustic_geometry-inl.h"
#include "kernel/caustics.h"
#include "kernel/direct_light-inl.h"
#include "kernel/gather-inl.h"
#include "kernel/light-inl.h"
#include "kernel/path_stream.h"
#include "kernel/scatter-inl.h"
#include "kernel/surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// 1 - sqrt(1 - s^2).
template <class V>
HWY_INLINE V versine_of(V s) {
  return s * s / (1 + hn::Sqrt(max((1 - s) * (1 + s), 0)));
}

/// The part of the light that the events of a chain let through, for weights: Schlick's approximation.
template <int kChain, class D, class V = hn::Vec<D>>
HWY_INLINE V approximate_throughput(D d, const BallAndLight<D>& from, V b) {
  const auto reflected = [&](V sin) { return schlick(from.r0, hn::Sqrt(max((1 - sin) * (1 + sin), 0))); };
  const V outside = reflected(min(b, 1));
  if constexpr (kChain == kReflection) return select(from.is_glass, outside, set(d, 1));
  const V inside = reflected(min(b / from.eta, 1));
  if constexpr (kChain == kOutward || kChain == kInward) return 1 - inside;
  const V through_ball = (1 - outside) * (1 - inside);
  if constexpr (kChain == kRefraction) return through_ball;
  if constexpr (kChain == kRainbow) return through_ball * inside;
  const V at_void = reflected(min(b / from.inner, 1));
  if constexpr (kChain == kOffVoid) return through_ball * at_void;
  return through_ball * (1 - at_void) * (1 - at_void);
}

/// A direction in an image of a light.
template <class D>
struct CausticSample {
  Vec3<hn::Vec<D>> direction;  ///< unit
  hn::Vec<D> inverse_pdf;      ///< steradians; 0: there is no image
  hn::Vec<IdTag<D>> events;    ///< of the chain
};

/// The pieces of the bands of all chains and their weights.
template <class D>
class CausticPieces {
  using V = hn::Vec<D>;

 public:
  /// `events`   maximum number of events of a chain
  HWY_INLINE CausticPieces(D d, const BallAndLight<D>& from, const CausticView<D>& at, int events, hn::Mask<D> lanes)
      : total_(hn::Zero(d)) {
    const auto outside = hn::AndNot(at.is_inside, lanes);
    add_inside(d, from, at, hn::AndNot(outside, hn::And(lanes, from.is_glass)));
    if (hn::AllFalse(d, outside)) return;
    add<kReflection>(d, from, at, outside);
    const auto glass = hn::And(outside, from.is_glass), hollow = hn::And(glass, from.is_hollow);
    if (hn::AllFalse(d, glass)) return;
    if (events > 1) add<kRefraction>(d, from, at, glass);
    if (events > 2) add<kRainbow>(d, from, at, glass);
    if (hn::AllFalse(d, hollow)) return;
    if (events > 2) add_hollow<kOffVoid>(d, from, at, hollow);
    if (events > 3) add_hollow<kThroughVoid>(d, from, at, hollow);
  }

  /// A direction of the piece that `choice` selects in proportion to the weights.
  HWY_INLINE CausticSample<D> sample(D d, const BallAndLight<D>& from, const CausticView<D>& at, V u, V v,
                                     V choice) const {
    const V zero = hn::Zero(d), target = choice * total_;
    V before = zero, weight = zero, low = zero, width = zero, chain = zero;
    for (int i = 0; i < count_; ++i) {
      const Piece& piece = piece_[i];
      const auto reached = hn::And(piece.weight > 0, before <= target);
      weight = select(reached, piece.weight, weight);
      low = select(reached, piece.low, low);
      width = select(reached, piece.width, width);
      chain = select(reached, piece.chain, chain);
      before = before + piece.weight;
    }
    const V versine = mul_add(width, u, low), sine = hn::Sqrt(versine * (2 - versine));
    const V b = min(at.distance * sine, 1), c = hn::Sqrt((1 - b) * (1 + b));
    const V along = select(chain == kOutward, 1 - versine, versine - 1);
    auto swept = swept_angle<0, false>(d, at.shells, b, c);
    const auto take = [&](hn::Mask<D> is_it, const SweptAngle<V>& of_chain) {
      swept.cos = select(is_it, of_chain.cos, swept.cos);
      swept.sin = select(is_it, of_chain.sin, swept.sin);
    };
    if (has(kRefraction)) {
      const auto refracted = swept_angle<1, false>(d, at.shells, b, c);
      take(chain == kRefraction, refracted);
      if (has(kOffVoid)) take(chain == kOffVoid, hollow_swept<false>(at.shells, refracted, from.inner, b));
      if (has(kThroughVoid)) take(chain == kThroughVoid, hollow_swept<true>(at.shells, refracted, from.inner, b));
    }
    if (has(kRainbow)) take(chain == kRainbow, swept_angle<2, false>(d, at.shells, b, c));
    if (has(kOutward)) take(chain >= kOutward, inside_swept(d, at, {sine, along}, b));
    const auto range = azimuth_range(d, at, b, swept);
    const V half_versine = range.versine * 0.5;
    const V turns = atan2_turn(d, hn::Sqrt(half_versine), hn::Sqrt(max(1 - half_versine, 0))) * 2;
    const V half_turns = min(turns * (1 + 4 * kEpsilon), 0.5);
    const V place = v * 2 - 1;
    const auto turn = sin_cos_turn(d, hn::Abs(place) * half_turns);
    const V sin = select(hn::Xor(range.is_flipped, place < 0), -turn.sin, turn.sin);
    const V cos = select(range.is_flipped, -turn.cos, turn.cos);
    const auto across = mul_add(at.e2, cos, at.e3 * sin);
    CausticSample<D> out;
    out.direction = mul_add(across, sine, at.e1 * along);
    const auto found = hn::And(weight > 0, range.versine > 0);
    out.inverse_pdf = hn::IfThenElseZero(found, width * half_turns * (2 * kTurn) * total_ / weight);
    const IdTag<D> du;
    out.events = set(du, kCausticEvents[0]);
    for (int i = 1; i < kCausticChains; ++i)
      out.events = select(hn::RebindMask(du, chain == i), set(du, kCausticEvents[i]), out.events);
    return out;
  }

 private:
  static constexpr double kEpsilon = std::numeric_limits<hn::TFromD<D>>::epsilon();

  struct Piece {
    V low, width;  ///< 1 - cos of the angle to -e1; kOutward: to e1
    V weight;
    V chain;
  };
  static constexpr int kMaxPieces = 19;  ///< 2, 4, 6, 2, 1, 1 and 3 of the chains

  HWY_INLINE bool has(CausticChain chain) const { return (chains_ >> chain & 1) != 0; }

  template <int k>
  HWY_INLINE void add(D d, const BallAndLight<D>& from, const CausticView<D>& at, hn::Mask<D> lanes) {
    const auto ends = graph_ends<k>(d, at.shells, at.asin_point, at.asin_light, at.asin_glass);
    const auto band = caustic_band<k>(d, at.shells, ends, at.theta, at.kappa, lanes);
    // Rays that enter a hollow ball with a smaller b hit the void.
    const V clear = from.inner * from.eta * (1 - 8 * kEpsilon);
    const V least = hn::IfThenElseZero(from.is_hollow, k == 0 ? hn::Zero(d) : clear);
    for (const CausticPiece<V>& b : band.piece) add_piece<k>(d, from, at, {max(b.low, least), b.high}, lanes);
  }

  template <int kChain>
  HWY_INLINE void add_hollow(D d, const BallAndLight<D>& from, const CausticView<D>& at, hn::Mask<D> lanes) {
    constexpr bool kThrough = kChain == kThroughVoid;
    const auto turn = hollow_turn<kThrough>(d, at.shells, from.inner);
    const auto near = [&](V theta) {
      return section_piece<kThrough>(d, turn, hn::Zero(d), set(d, 0.25), band_around(d, theta, at.kappa), lanes);
    };
    const auto direct = near(at.theta);
    add_piece<kChain>(d, from, at, direct, lanes);
    if constexpr (kThrough) return;
    const auto around = near(kTurn - at.theta);
    add_piece<kChain>(d, from, at, {max(around.low, direct.high), around.high}, lanes);
  }

  HWY_INLINE void add_inside(D d, const BallAndLight<D>& from, const CausticView<D>& at, hn::Mask<D> lanes) {
    // From the void of a hollow ball, no ray leaves the ball by one refraction.
    const V least = hn::IfThenElseZero(from.is_hollow, from.inner * from.eta);
    const auto in_glass = hn::And(lanes, at.distance > least);
    if (hn::AllFalse(d, in_glass)) return;
    const auto band = inside_band(d, at, in_glass);
    add_piece<kOutward>(d, from, at, band.outward, in_glass);
    for (const CausticPiece<V>& b : band.inward) add_piece<kInward>(d, from, at, b, in_glass);
  }

  /// Pieces are weighted by width and throughput, which is bounded from below. Their ranges of azimuth are about the
  /// same, unless the point is near the axis.
  template <int kChain>
  HWY_INLINE void add_piece(D d, const BallAndLight<D>& from, const CausticView<D>& at, const CausticPiece<V>& b,
                            hn::Mask<D> lanes) {
    chains_ |= 1U << kChain;
    Piece& piece = piece_[count_++];
    piece = {hn::Zero(d), hn::Zero(d), hn::Zero(d), set(d, kChain)};
    const auto exists = hn::And(lanes, b.low < b.high);
    if (hn::AllFalse(d, exists)) return;
    const V inverse = at.shells.point.inverse;
    piece.low = versine_of(b.low * inverse);
    piece.width = hn::IfThenElseZero(exists, max(versine_of(b.high * inverse) - piece.low, 0));
    piece.weight = piece.width * max(approximate_throughput<kChain>(d, from, (b.low + b.high) * 0.5), 0.02);
    total_ = total_ + piece.weight;
  }

  Piece piece_[kMaxPieces];
  int count_ = 0;
  unsigned chains_ = 0;  ///< a bit per chain that some lanes have
  V total_;
};

/// Samples a direction in the images of a light: first one of the pieces of b, then b uniformly by solid angle, then
/// the azimuth within the range in which the light is hit. Directions that miss the light are rare.
///
/// `events`   maximum number of events of a chain
/// `lanes`    lanes in which the result is needed
/// Reference  docs/decisions/0040
template <class D, class V = hn::Vec<D>>
HWY_NOINLINE CausticSample<D> sample_caustic(D d, const BallAndLight<D>& from, int events, hn::Mask<D> lanes, V u, V v,
                                             V choice) {
  const auto at = caustic_view(d, from);
  return CausticPieces<D>(d, from, at, events, lanes).sample(d, from, at, u, v, choice);
}

/// Balls that were chosen for vertices.
template <class D>
struct ChosenBalls {
  hn::Vec<IdTag<D>> index;
  hn::Vec<D> probability;  ///< 0: none was chosen
  hn::Vec<D> rest;         ///< the random number rescaled to be uniform in 0..1 again
  hn::Vec<D> importance;   ///< sum over all balls
};

/// Chooses a ball for each vertex by power / distance^2. The probability is zero only where the ball is below the
/// horizon.
template <class D, class V = hn::Vec<D>>
HWY_NOINLINE ChosenBalls<D> choose_ball(D d, const Caustics& caustics, const Vertex<D>& at, V u) {
  using T = hn::TFromD<D>;
  V of_ball[Caustics::kMaxBalls];
  V whole = hn::Zero(d);
  for (std::uint32_t i = 0; i < caustics.count; ++i) {
    const CausticBall& ball = caustics.balls[i];
    const V radius = set(d, ball.radius);
    const Vec3<V> to = to_center<D>(at, set3(d, ball.center));
    const V distance2 = max(dot(to, to), radius * radius);
    const auto above = dot(to, at.normal) + radius > 0;
    of_ball[i] = hn::IfThenElseZero(above, set(d, static_cast<T>(ball.power)) / distance2);
    whole = whole + of_ball[i];
  }
  const V target = u * whole;
  const auto chosen = choose_from_list(d, of_ball, caustics.count, target, [](std::uint32_t i) { return i; });
  const auto some = chosen.importance > 0;
  const V rest = hn::IfThenElseZero(some, (target - chosen.before) / chosen.importance);
  return {chosen.id, hn::IfThenElseZero(some, chosen.importance / whole), min(max(rest, 0), 1), whole};
}

/// Maximum number of events of the chains that are sampled at a depth: a path could follow them to the light before its
/// depth ends.
inline int sampled_events(const SceneView& scene, std::uint32_t depth) {
  const std::uint32_t rays_left = scene.max_depth > depth + 2 ? scene.max_depth - depth - 2 : 0;
  return static_cast<int>(std::min<std::uint32_t>(rays_left, kMaxCausticEvents));
}

/// Least probability of sampling a vertex: what is saved beyond is small, and a sample's weight is bounded.
inline constexpr double kLeastCausticChance = 1.0 / 8;

/// The probability with which vertices are sampled, for a throughput. It falls where the balls are far away or the path
/// carries little, so that time is spent where the light matters.
template <class V>
HWY_INLINE V caustic_chance(const Caustics& caustics, V importance, V throughput) {
  return min(max(importance * throughput * caustics.inverse_reference, kLeastCausticChance), 1);
}

/// Balls and lights of waiting vertices, one per lane.
template <class D>
struct CausticChoice {
  static constexpr std::size_t kMax = hn::MaxLanes(D());
  /// Sphere ids. `inner` is kNone if the ball is not hollow; `light` may be kSun.
  HWY_ALIGN hn::TFromD<IdTag<D>> ball[kMax], inner[kMax], light[kMax];
  HWY_ALIGN hn::TFromD<D> inverse_probability[kMax];  ///< of the choice of the light
};

/// Chooses a light for each ball, by power.
///
/// `balls`, `u`  indices into Caustics, and uniform numbers in 0..1; as many as `count`, at most one per lane
template <class D>
HWY_INLINE CausticChoice<D> choose_lights(D d, const Caustics& caustics, const hn::TFromD<IdTag<D>>* balls,
                                          const hn::TFromD<D>* u, int count) {
  using T = hn::TFromD<D>;
  CausticChoice<D> out;
  for (int i = 0; i < static_cast<int>(hn::Lanes(d)); ++i) {
    const bool in_use = i < count;
    const CausticBall& ball = caustics.balls[in_use ? balls[i] : 0];
    const double target = in_use ? static_cast<double>(u[i]) : 0;
    const CausticLight* const last = caustics.lights + ball.end - 1;
    const CausticLight* const light =
        std::lower_bound(caustics.lights + ball.begin, last, target,
                         [](const CausticLight& at, double share) { return at.cumulative < share; });
    out.ball[i] = ball.sphere;
    out.inner[i] = ball.inner;
    out.light[i] = light->id;
    out.inverse_probability[i] = static_cast<T>(1 / light->probability);
  }
  return out;
}

/// Loads balls and lights of pairs as they appear from vertices.
template <class D>
HWY_INLINE BallAndLight<D> load_pairs(D d, const SceneView& scene, const Vertex<D>& at, const CausticChoice<D>& pairs) {
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  constexpr std::size_t kMax = hn::MaxLanes(D());
  const auto& ball = pairs.ball;
  const auto& light = pairs.light;
  HWY_ALIGN hn::TFromD<IdTag<D>> emitter[kMax], inner[kMax];
  HWY_ALIGN T eta[kMax], r0[kMax], glass[kMax], hollow[kMax], sun[kMax];
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) {
    const Material& material = scene.materials[scene.object_materials[ball[i]]];
    eta[i] = static_cast<T>(material.eta[1]);
    r0[i] = static_cast<T>(material.r0[0]);
    glass[i] = traits_of(material.kind).transmits ? T(1) : T(0);
    sun[i] = light[i] == kSun ? T(1) : T(0);
    emitter[i] = light[i] == kSun ? ball[i] : light[i];
    hollow[i] = pairs.inner[i] != kNone ? T(1) : T(0);
    inner[i] = pairs.inner[i] != kNone ? pairs.inner[i] : ball[i];
  }
  const auto sphere = load_spheres(d, scene, ball, at.times), lamp = load_spheres(d, scene, emitter, at.times);
  const V inverse_radius = 1 / sphere.radius;
  const auto is_sun = hn::Load(d, sun) != 0;
  const auto to = lamp.center - sphere.center;
  const V inverse = 1 / hn::Sqrt(dot(to, to));
  BallAndLight<D> out;
  out.from_center = negated(to_center(at, sphere.center)) * inverse_radius;
  out.to_light = to * inverse;
  out.inverse_distance = sphere.radius * inverse;
  out.light_sin = lamp.radius * inverse;
  if (scene.environment != nullptr && scene.environment->has_sun) {
    const V versine = set(d, scene.environment->sun_one_minus_cos);
    out.to_light = select(is_sun, set3(d, scene.environment->sun), out.to_light);
    out.inverse_distance = select(is_sun, 0, out.inverse_distance);
    out.light_sin = select(is_sun, hn::Sqrt(versine * (2 - versine)), out.light_sin);
  }
  out.is_glass = hn::Load(d, glass) != 0;
  out.eta = select(out.is_glass, hn::Load(d, eta), 1.5);  // in other lanes any index will do
  out.r0 = hn::Load(d, r0);
  out.is_hollow = hn::Load(d, hollow) != 0;
  out.inner = set(d, 1);
  if (scene.caustics.has_hollow) out.inner = load_spheres(d, scene, inner, at.times).radius * inverse_radius;
  return out;
}

/// Loads radiance and light groups.
template <class D>
HWY_INLINE Emitted<D> load_lights(D d, const SceneView& scene, hn::Vec<IdTag<D>> lights) {
  const IdTag<D> du;
  const auto is_sun = hn::RebindMask(d, lights == kSun);
  Emitted<D> out{{hn::Zero(d), hn::Zero(d), hn::Zero(d)}, hn::Zero(du)};
  if (scene.emission != nullptr) out = emitted(d, scene, lights, hn::Not(is_sun));
  if (scene.environment == nullptr) return out;
  out.radiance = select(is_sun, set3(d, scene.environment->sun_radiance), out.radiance);
  out.group = select(hn::RebindMask(du, is_sun), set(du, scene.environment->light_group), out.group);
  return out;
}

/// Samples directions at the waiting vertices and appends their rays to the caustic rays.
///
/// `has_events`  the tile records light events
/// `events`      maximum number of events of a chain
template <class D>
HWY_NOINLINE void sample_caustics(const SceneView& scene, bool has_events, PathsOf<hn::TFromD<D>>& paths, int events) {
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  const D d;
  const IdTag<D> du;
  const auto& vertices = paths.vertices;
  auto& rays = paths.caustic_rays;
  for (int v = 0; v < vertices.count; v += static_cast<int>(hn::Lanes(d))) {
    const auto active = hn::FirstN(d, static_cast<std::size_t>(vertices.count - v));
    const auto chosen = choose_lights(d, scene.caustics, vertices.ball + v, vertices.random[2] + v, vertices.count - v);
    const auto lights = hn::Load(du, chosen.light);
    const auto base = load3(d, vertices.base, v), offset = load3(d, vertices.offset, v);
    const V side = hn::Load(d, vertices.side + v);
    const auto origin = base + offset;
    const T* const times = scene.features.motion ? vertices.time + v : nullptr;
    const Vertex<D> at{origin, sum_error(base, offset, origin), normalized(offset) * side, {}, times};
    const auto source = load_lights(d, scene, lights);
    const auto sample =
        sample_caustic(d, load_pairs(d, scene, at, chosen), events, active, hn::Load(d, vertices.random[0] + v),
                       hn::Load(d, vertices.random[1] + v), hn::Load(d, vertices.random[3] + v));
    // The density of the diffuse lobes, as in pdf_bsdf.
    const V cosine = dot(sample.direction, at.normal);
    const auto uniform = hn::Load(d, vertices.uniform + v) != 0;
    const V factor = select(uniform, 1 / kTwoPi, cosine * (2 / kTwoPi)) * sample.inverse_pdf *
                     hn::Load(d, chosen.inverse_probability);
    const auto lanes = hn::And(hn::And(active, dot(sample.direction, offset) * side > 0), factor > 0);
    if (hn::AllFalse(d, lanes)) continue;
    const int n = rays.count;
    const Compactor<D> compactor(d, lanes);
    const auto keep = [&](const auto& from_array, auto& to) {
      compactor.store_ids(d, hn::Load(du, from_array + v), to + n);
    };
    compactor.store3(d, base, rays.base, n);
    compactor.store3(d, offset, rays.offset, n);
    compactor.store3(d, sample.direction, rays.direction, n);
    compactor.store3(d, source.radiance * load3(d, vertices.value, v) * factor, rays.value, n);
    if (times != nullptr) compactor.store(d, hn::Load(d, times), rays.time + n);
    if (scene.features.opacity) compactor.store(d, hn::Load(d, vertices.threshold + v), rays.threshold + n);
    keep(vertices.self, rays.self);
    keep(vertices.path, rays.path);
    compactor.store_ids(d, sample.events, rays.events + n);
    compactor.store_ids(d, hn::Load(du, chosen.ball), rays.ball + n);
    compactor.store_ids(d, hn::Load(du, chosen.inner), rays.inner + n);
    compactor.store_ids(d, lights, rays.light + n);
    if (has_events) {
      keep(vertices.history, rays.history);
      compactor.store_ids(d, source.group, rays.group + n);
    }
    rays.count += compactor.count();
  }
  paths.vertices.count = 0;
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
