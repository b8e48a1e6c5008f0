// SPDX-License-Identifier: Apache-2.0
// Sampling of directions in the images of a light in a ball. Compiled once per instruction set.
#if defined(ORRERY_KERNEL_CAUSTIC_IMAGE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_KERNEL_CAUSTIC_IMAGE_INL_H_
#undef ORRERY_KERNEL_CAUSTIC_IMAGE_INL_H_
#else
#define ORRERY_KERNEL_CAUSTIC_IMAGE_INL_H_
#endif

#include <hwy/highway.h>

#include <limits>

#include "kernel/caustic_chain-inl.h"
#include "kernel/caustic_hollow-inl.h"
#include "kernel/caustics.h"
#include "kernel/sample-inl.h"
#include "kernel/scatter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// A ball and a light as they appear from points outside the ball, one per lane.
template <class D>
struct BallAndLight {
  using V = hn::Vec<D>;
  Vec3<V> from_center;  ///< from the ball's centre to the point, in units of its radius
  Vec3<V> to_light;     ///< unit, from the ball's centre
  V inverse_distance;   ///< 1 / distance of the light's centre, in units of the ball's radius; 0: a sun
  V light_sin;          ///< sine of the half angle that the light subtends at the ball's centre
  V eta;                ///< index of the glass
  V r0;                 ///< Schlick's constant of the glass
  V inner;              ///< radius of the void of a hollow ball, in units of the ball's radius; else any
  hn::Mask<D> is_glass, is_hollow;
};

/// The values that the images of a light depend on.
template <class D>
struct CausticView {
  using V = hn::Vec<D>;
  CausticShells<V> shells;
  V distance;          ///< of the point
  Vec3<V> e1, e2, e3;  ///< from the centre to the point; towards the light, perpendicular to e1; their product
  V sin, cos;          ///< of the angle between point and light at the centre
  V theta, kappa;      ///< that angle; half width of the band of Theta, radians
  V light_sin;
  V asin_point, asin_light, asin_glass;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE CausticView<D> caustic_view(D d, const BallAndLight<D>& from) {
  constexpr double kEpsilon = std::numeric_limits<hn::TFromD<D>>::epsilon();
  CausticView<D> at;
  const V p2 = dot(from.from_center, from.from_center);
  at.distance = max(hn::Sqrt(p2), 1);
  const V inverse = 1 / at.distance, eta_inverse = 1 / from.eta, g = from.inverse_distance;
  at.shells.point = {inverse, max(p2 - 1, 0) * (inverse * inverse)};
  at.shells.light = {g, (1 - g) * (1 + g)};
  at.shells.glass = {eta_inverse, (1 - eta_inverse) * (1 + eta_inverse)};
  at.e1 = normalized(from.from_center);
  const auto& a = at.e1;
  const auto& b = from.to_light;
  const Vec3<V> across = {neg_mul_add(a.z, b.y, a.y * b.z), neg_mul_add(a.x, b.z, a.z * b.x),
                          neg_mul_add(a.y, b.x, a.x * b.y)};
  at.cos = dot(a, b);
  at.sin = hn::Sqrt(dot(across, across));
  // Near the axis, where the product is a rounding error, any plane will do.
  at.e3 = select(at.sin > 64 * kEpsilon, normalized(neg_mul_add(a, dot(a, across), across)), frame_around(d, a).x);
  at.e2 = {neg_mul_add(at.e3.z, a.y, at.e3.y * a.z), neg_mul_add(at.e3.x, a.z, at.e3.z * a.x),
           neg_mul_add(at.e3.y, a.x, at.e3.x * a.y)};
  at.theta = angle_of(d, at.sin, at.cos);
  at.light_sin = mul_add(from.light_sin, set(d, 1 + 8 * kEpsilon), 8 * kEpsilon);
  at.asin_point = angle_of(d, inverse, hn::Sqrt(at.shells.point.rest));
  const V cos_light = hn::Sqrt(max(at.shells.light.rest, 0));
  at.asin_light = angle_of(d, g, cos_light);
  at.asin_glass = angle_of(d, eta_inverse, hn::Sqrt(at.shells.glass.rest));
  // The ray ends at most the light's radius from the light's centre: for each b, Theta is within
  // asin((b + r) / d) - asin(b / d) of the centre's angle, which is largest for b = 1.
  const V reach = g + from.light_sin;
  const V cos_reach = hn::Sqrt(max((1 - reach) * (1 + reach), 0));
  at.kappa = max(angle_of(d, min(reach, 1), cos_reach) - at.asin_light, 0);
  return at;
}

/// The range of azimuth around e1 in which rays with one impact parameter hit the light.
template <class V, class M>
struct AzimuthRange {
  V versine;     ///< 1 - cos of half the range, 0..2; 0: none
  M is_flipped;  ///< the range is centred on the side away from the light
};

/// Computes the range in closed form. At the azimuth phi, the ray leaves in the plane at the angle `swept`, and its
/// squared distance from the light's centre is a parabola in cos(phi), known at 0 and pi. If it is within the light at
/// both, it is within the light everywhere.
template <class D, class V = hn::Vec<D>>
HWY_INLINE AzimuthRange<V, hn::Mask<D>> azimuth_range(D d, const CausticView<D>& at, V b, const SweptAngle<V>& swept) {
  const V bg = b * at.shells.light.inverse;
  const V cc = swept.cos * at.cos, ss = swept.sin * at.sin, sc = swept.sin * at.cos, cs = swept.cos * at.sin;
  const V none = set(d, -1);
  const auto inside = [&](V cos, V sin) {
    const V off = sin - bg;
    return select(cos > 0, (at.light_sin - off) * (at.light_sin + off), none);
  };
  const V near = inside(cc + ss, sc - cs), far = inside(cc - ss, sc + cs);
  const auto flipped = hn::And(far > 0, near <= 0);
  const V depth = select(flipped, far, near);
  const V slope = select(flipped, -ss, ss), cos = select(flipped, cc - ss, cc + ss);
  const V half = neg_mul_add(bg, select(flipped, -cs, cs), slope * cos);
  const V root = hn::Sqrt(max(neg_mul_add(slope * slope, depth, half * half), 0));
  const V divisor = half + root;
  const auto full = hn::Or(hn::And(near > 0, far > 0), depth >= divisor * 2);
  const V versine = select(full, 2, depth / divisor);
  return {hn::IfThenElseZero(depth > 0, versine), hn::AndNot(full, flipped)};
}

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
    add<kReflection>(d, from, at, lanes);
    const auto glass = hn::And(lanes, from.is_glass), hollow = hn::And(glass, from.is_hollow);
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
    auto swept = swept_angle<0, false>(d, at.shells, b, c);
    const auto take = [&](int of, const SweptAngle<V>& of_chain) {
      const auto is_it = chain == of;
      swept.cos = select(is_it, of_chain.cos, swept.cos);
      swept.sin = select(is_it, of_chain.sin, swept.sin);
    };
    if (count_ > kFirst[kRefraction]) {
      const auto refracted = swept_angle<1, false>(d, at.shells, b, c);
      take(kRefraction, refracted);
      if (count_ > kFirst[kOffVoid]) take(kOffVoid, hollow_swept<false>(at.shells, refracted, from.inner, b));
      if (count_ > kFirst[kThroughVoid]) take(kThroughVoid, hollow_swept<true>(at.shells, refracted, from.inner, b));
    }
    if (count_ > kFirst[kRainbow]) take(kRainbow, swept_angle<2, false>(d, at.shells, b, c));
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
    out.direction = mul_add(across, sine, at.e1 * (versine - 1));
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
    V low, width;  ///< 1 - cos of the angle to -e1
    V weight;
    V chain;
  };
  static constexpr int kFirst[kCausticChains + 1] = {0, 2, 6, 12, 14, 15};  ///< pieces of the chains before

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
    const auto shells = hollow_shells<kThrough>(d, at.shells, from.inner);
    const V tolerance = mul_add(at.kappa, set(d, 0.02), 32 * kEpsilon);
    const V width = mul_add(at.kappa, set(d, 1.001), 32 * kEpsilon);
    const auto near = [&](V theta) {
      return hollow_piece<kThrough>(d, shells, theta - width, theta + width, tolerance, lanes);
    };
    const auto direct = near(at.theta);
    add_piece<kChain>(d, from, at, direct, lanes);
    if constexpr (kThrough) return;
    const auto around = near(kTurn - at.theta);
    add_piece<kChain>(d, from, at, {max(around.low, direct.high), around.high}, lanes);
  }

  /// Pieces are weighted by width and throughput, which is bounded from below. Their ranges of azimuth are about the
  /// same, unless the point is near the axis.
  template <int kChain>
  HWY_INLINE void add_piece(D d, const BallAndLight<D>& from, const CausticView<D>& at, const CausticPiece<V>& b,
                            hn::Mask<D> lanes) {
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

  Piece piece_[kFirst[kCausticChains]];
  int count_ = 0;
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

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
