// SPDX-License-Identifier: Apache-2.0
// A path's random numbers: the Sobol sequence with hash-based Owen scrambling, four dimensions per vertex, or
// independent ones.
#pragma once

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "kernel/camera.h"
#include "kernel/random-inl.h"
#include "kernel/sobol_columns.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// Reverses the bits of each 32-bit lane.
template <class D32, class V = hn::Vec<D32>>
HWY_INLINE V reversed_bits(D32 d32, V v) {
  const hn::Repartition<std::uint8_t, D32> d8;
  const hn::FixedTag<std::uint8_t, std::max<std::size_t>(16, hn::MaxLanes(d8))> whole;  // tables have 16 bytes
  alignas(16) static constexpr std::uint8_t kNibble[16] = {0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15};
  alignas(16) static constexpr std::uint8_t kBytes[16] = {3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12};
  const auto table = hn::LoadDup128(whole, kNibble);
  const auto low_mask = hn::Set(d8, std::uint8_t{15});
  const auto bytes = hn::TableLookupBytes(hn::BitCast(d8, v), hn::LoadDup128(d8, kBytes));
  const auto high = hn::And(hn::BitCast(d8, hn::ShiftRight<4>(hn::BitCast(d32, bytes))), low_mask);
  const auto low = hn::TableLookupBytes(table, hn::And(bytes, low_mask));
  return hn::Or(hn::BitCast(d32, hn::TableLookupBytes(table, high)), hn::ShiftLeft<4>(hn::BitCast(d32, low)));
}

/// Owen scrambling of bit-reversed numbers: flips every bit by a hash of the seed and the bits below it.
///
/// Reference  laine2011 (the idea), vegdahl2021 (these constants)
template <class D32, class V = hn::Vec<D32>>
HWY_INLINE V laine_karras_permutation(D32 d32, V v, V seed) {
  v = hn::Xor(v, v * hn::Set(d32, 0x3d20adeau));
  v = v + seed;
  v = v * hn::Or(hn::ShiftRight<16>(seed), hn::Set(d32, 1u));
  v = hn::Xor(v, v * hn::Set(d32, 0x05526c56u));
  return hn::Xor(v, v * hn::Set(d32, 0x53a22864u));
}

/// The product over GF(2) of a 16 x 16 matrix and the low bits of each lane.
///
/// Domain     v < 2^kSobolBits
template <class D32, class V = hn::Vec<D32>>
HWY_INLINE V ordered(D32 d32, const SobolOrder& order, V v) {
  const hn::RebindToSigned<D32> ds;
  V out = hn::Zero(d32);
  V bits = hn::ShiftLeft<32 - kSobolBits>(v);
  HWY_UNROLL(kSobolBits)
  for (int j = kSobolBits - 1; j >= 0; --j) {
    const V is_set = hn::BitCast(d32, hn::BroadcastSignBit(hn::BitCast(ds, bits)));
    out = hn::Xor(out, hn::And(is_set, hn::Set(d32, order[static_cast<std::size_t>(j)])));
    bits = bits + bits;
  }
  return out;
}

/// Point `index`, in the given order, of the sequence `name`: four coordinates as 32-bit fractions.
///
/// `name` seeds the scrambling; points of different names are independent. In the camera's order points 2^k n .. 2^k (n
/// + 1) are a (0, k, 2)-net in base 2 in the first two coordinates, and nearly a net in all four, for every n and k; in
/// the other orders from k = kSobolFreeBits on. If names are those of a sample's pixel and vertex, coordinates of
/// different vertices also form a net together.
///
/// `order`    index into kSobolOrders
/// `last_two` false: the last two are 0 and not computed
/// Domain     index < 2^kSobolBits; in 64-bit lanes both in the low halves, the high ones 0
/// Result     in 64-bit lanes in the low halves, with the high ones 0
/// Reference  joe2008 (directions), burley2020 (scrambling by a hash)
template <class DU, class V = hn::Vec<DU>>
HWY_INLINE Four<V> sobol(DU du, V index, V name, std::uint32_t order, bool last_two) {
  const hn::Repartition<std::uint32_t, DU> d32;
  using V32 = hn::Vec<decltype(d32)>;
  // A 64-bit lane holds two coordinates, one in each half.
  constexpr bool kPaired = sizeof(hn::TFromD<DU>) == 8;
  const auto both = [&](V v) {
    if constexpr (kPaired)
      return hn::BitCast(d32, hn::Or(v, hn::ShiftLeft<32>(v)));
    else
      return v;
  };
  const auto pair = [&](std::uint32_t low, [[maybe_unused]] std::uint32_t high) {
    if constexpr (kPaired)
      return hn::BitCast(d32, hn::Set(du, std::uint64_t{high} << 32 | low));
    else
      return hn::Set(d32, low);
  };

  // The sequence's seed, and the index in the given order.
  const V32 seed = hashed(d32, both(name));
  const V32 at = order == 0 ? both(index) : ordered(d32, kSobolOrders[order], both(index));

  // Bit-reversed coordinates. The first is the index itself. In the second, bit j of the index stands for the
  // polynomial (1 + t)^j over GF(2); since (1 + t)^(2^b) = 1 + t^(2^b), one step per bit of j suffices.
  V32 second = at;
  const auto expand = [&](auto shift, std::uint32_t mask) {
    second = hn::Xor(second, hn::ShiftRight<decltype(shift)::value>(hn::And(second, hn::Set(d32, mask))));
  };
  expand(std::integral_constant<int, 1>(), 0xaaaaaaaau);
  expand(std::integral_constant<int, 2>(), 0xccccccccu);
  expand(std::integral_constant<int, 4>(), 0xf0f0f0f0u);
  expand(std::integral_constant<int, 8>(), 0xff00ff00u);
  static_assert(kSobolBits <= 16, "one more step");

  // Scrambling, with four arbitrary, distinct numbers.
  constexpr std::uint32_t kSeeds[4] = {0x9e3779b1u, 0x7feb352du, 0xb5297a4du, 0x68e31da5u};
  const auto scrambled = [&](V32 v, int low, int high) {
    // Hashed twice, since one hash leaves correlations that the first points show.
    const V32 own = hashed(d32, seed + pair(kSeeds[low], kSeeds[high]));
    return reversed_bits(d32, laine_karras_permutation(d32, v, own));
  };

  // The first two coordinates.
  Four<V> out;
  [[maybe_unused]] const V low_half = hn::Set(du, hn::TFromD<DU>{0xffffffffu});
  const auto put = [&](V32 v, int to) {
    if constexpr (kPaired) {
      out.v[to] = hn::And(hn::BitCast(du, v), low_half);
      out.v[to + 1] = hn::ShiftRight<32>(hn::BitCast(du, v));
    } else {
      out.v[to] = v;
    }
  };
  if constexpr (kPaired) {
    const V32 mask = hn::BitCast(d32, low_half);
    put(scrambled(hn::Or(hn::And(at, mask), hn::AndNot(mask, second)), 0, 1), 0);
  } else {
    put(scrambled(at, 0, 0), 0);
    put(scrambled(second, 1, 1), 1);
  }
  out.v[2] = out.v[3] = hn::Zero(du);
  if (!last_two) return out;

  // The last two, from columns of direction numbers: one for each bit of the index that is set.
  V32 third = hn::Zero(d32);
  [[maybe_unused]] V32 fourth = third;
  const hn::RebindToSigned<decltype(d32)> ds;
  V32 bits = hn::ShiftLeft<32 - kSobolBits>(at);
  HWY_UNROLL(kSobolBits)
  for (int j = kSobolBits - 1; j >= 0; --j) {
    const V32 is_set = hn::BitCast(d32, hn::BroadcastSignBit(hn::BitCast(ds, bits)));
    third = hn::Xor(third, hn::And(is_set, pair(kSobolColumns.third[j], kSobolColumns.fourth[j])));
    if constexpr (!kPaired) fourth = hn::Xor(fourth, hn::And(is_set, hn::Set(d32, kSobolColumns.fourth[j])));
    bits = bits + bits;
  }
  put(scrambled(third, 2, 3), 2);
  if constexpr (!kPaired) put(scrambled(fourth, 3, 3), 3);
  return out;
}

/// Spreads the lower 16 bits: bit i moves to bit 2i.
template <class DU, class V = hn::Vec<DU>>
HWY_INLINE V spread_bits(DU du, V v) {
  using Id = hn::TFromD<DU>;
  const auto step = [&](auto shift, std::uint32_t mask) {
    v = hn::And(hn::Or(v, hn::ShiftLeft<decltype(shift)::value>(v)), hn::Set(du, Id{mask}));
  };
  v = hn::And(v, hn::Set(du, Id{0xffff}));
  step(std::integral_constant<int, 8>(), 0x00ff00ffu);
  step(std::integral_constant<int, 4>(), 0x0f0f0f0fu);
  step(std::integral_constant<int, 2>(), 0x33333333u);
  step(std::integral_constant<int, 1>(), 0x55555555u);
  return v;
}

/// Sobol points for a pixel's samples at one path vertex.
///
/// `order`    index into kSobolOrders
///
/// With blue noise one sequence runs through neighbouring pixels along the Morton curve, so that their errors cancel
/// rather than add up.
///
/// Reference  burley2020, ahmed2020 (pixels in hierarchical order)
template <class DU, class V = hn::Vec<DU>>
HWY_INLINE Four<V> sobol_at_vertex(DU du, const Sampler& sampler, V pixel, V sample, std::uint32_t vertex,
                                   std::uint32_t order, bool last_two) {
  using Id = hn::TFromD<DU>;
  const hn::Repartition<std::uint32_t, DU> d32;
  constexpr Id kMask = (Id{1} << kSobolBits) - 1;
  const V low_bits = hn::Set(du, kMask);
  V index = hn::And(sample, low_bits);
  V beyond = hn::ShiftRight<kSobolBits>(sample);  // includes the half; each value selects another sequence
  V place = pixel;
  if (sampler.kind == SamplerKind::kBlueNoise) {
    const V curve =
        hn::Or(spread_bits(du, pixel), hn::ShiftLeft<1>(spread_bits(du, hn::template ShiftRight<16>(pixel))));
    // A pixel's samples beyond its part of the sequence come from another sequence.
    const int bits = sampler.blue_noise_bits;
    index = hn::And(sample, hn::Set(du, (Id{1} << bits) - 1));
    index = hn::And(hn::Or(hn::ShiftLeftSame(curve, bits), index), low_bits);
    beyond = hn::ShiftRightSame(sample, bits);
    place = hn::ShiftRightSame(curve, kSobolBits - bits);
  }
  // Odd factors are bijective, so different pixels get different names; names of different vertices coincide only by
  // chance.
  const auto times = [&](V v, std::uint32_t factor) {
    return hn::BitCast(du, hn::BitCast(d32, v) * hn::BitCast(d32, hn::Set(du, Id{factor})));
  };
  const std::uint32_t key = (sampler.seed * 0x2c1b3c6du) ^ ((vertex + 1) * 0x297a2d39u);
  const V name = hn::Xor(times(place, 0x85157af5u), hn::Xor(times(beyond, 0x9e3779b1u), hn::Set(du, Id{key})));
  return sobol(du, index, name, order, last_two);
}

/// Four random numbers in 0..1 for a path, from the sampler's sequence `name`. Sobol points are taken in the order
/// kSobolOrders[order].
template <class D>
HWY_INLINE Four<hn::Vec<D>> random_of_sequence(D d, const Sampler& sampler, hn::Vec<hn::RebindToUnsigned<D>> pixel,
                                               hn::Vec<hn::RebindToUnsigned<D>> sample, bool is_independent,
                                               std::uint32_t name, std::uint32_t order, bool last_two) {
  const hn::RebindToUnsigned<D> du;
  const auto bits = is_independent ? independent_at_vertex(du, sampler.seed, pixel, sample, name)
                                   : sobol_at_vertex(du, sampler, pixel, sample, name, order, last_two);
  return {{to_unit(d, bits.v[0]), to_unit(d, bits.v[1]), to_unit(d, bits.v[2]), to_unit(d, bits.v[3])}};
}

/// True if a vertex uses independent random numbers. Deep in a path, low-discrepancy points have no advantage, since
/// the numbers of earlier vertices determine most of the result.
inline bool is_independent_at(const Sampler& sampler, std::uint32_t vertex) {
  return sampler.kind == SamplerKind::kIndependent || vertex >= kSobolVertices;
}

/// The four numbers in 0..1 that one path takes at one of its vertices.
///
/// `last_two` false: the last two numbers are not used and may have any value
template <class D>
HWY_INLINE Four<hn::Vec<D>> random_at_vertex(D d, const Sampler& sampler, hn::Vec<hn::RebindToUnsigned<D>> pixel,
                                             hn::Vec<hn::RebindToUnsigned<D>> sample, std::uint32_t vertex,
                                             bool last_two) {
  return random_of_sequence(d, sampler, pixel, sample, is_independent_at(sampler, vertex), vertex, vertex, last_two);
}

/// Four more numbers in 0..1 at the same vertex, in separate dimensions. They sample lights; those of random_at_vertex
/// sample the BSDF.
///
/// `last_two` see random_at_vertex
/// Domain     vertex < 2^30
template <class D>
HWY_INLINE Four<hn::Vec<D>> second_random_at_vertex(D d, const Sampler& sampler, hn::Vec<hn::RebindToUnsigned<D>> pixel,
                                                    hn::Vec<hn::RebindToUnsigned<D>> sample, std::uint32_t vertex,
                                                    bool last_two) {
  constexpr std::uint32_t kSecond = 0x40000000;  // above all vertices
  return random_of_sequence(d, sampler, pixel, sample, is_independent_at(sampler, vertex), kSecond + vertex,
                            kSobolSecondOrders + vertex, last_two);
}

/// Numbers in 0..1 that are the same at all vertices of a path.
template <class V>
struct PathNumbers {
  V time;       ///< within the shutter
  V threshold;  ///< objects with a greater opacity are visible to the path
};

/// The numbers of paths.
///
/// Precision  24 bits, so that a float holds them exactly
template <class D>
HWY_INLINE PathNumbers<hn::Vec<D>> numbers_of_path(D d, const Sampler& sampler, hn::Vec<hn::RebindToUnsigned<D>> pixel,
                                                   hn::Vec<hn::RebindToUnsigned<D>> sample) {
  constexpr std::uint32_t kVertex = 0xfffffffe;  // above all vertices
  const hn::RebindToUnsigned<D> du;
  const auto bits = sampler.kind == SamplerKind::kIndependent
                        ? independent_at_vertex(du, sampler.seed, pixel, sample, kVertex)
                        : sobol_at_vertex(du, sampler, pixel, sample, kVertex, kSobolTimeOrder, false);
  const auto number = [&](int i) { return hn::Floor(to_unit(d, bits.v[i]) * 0x1p24) * 0x1p-24; };
  return {number(0), number(1)};
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
