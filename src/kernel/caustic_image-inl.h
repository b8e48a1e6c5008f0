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
#include "kernel/caustic_inside-inl.h"
#include "kernel/caustic_view-inl.h"
#include "kernel/caustics.h"
#include "kernel/sample-inl.h"
#include "kernel/scatter-inl.h"

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

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
