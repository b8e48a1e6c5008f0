// SPDX-License-Identifier: Apache-2.0
// A path's random numbers.
#if defined(ORRERY_KERNEL_SAMPLER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_KERNEL_SAMPLER_INL_H_
#undef ORRERY_KERNEL_SAMPLER_INL_H_
#else
#define ORRERY_KERNEL_SAMPLER_INL_H_
#endif

#include <hwy/highway.h>

#include "kernel/camera.h"
#include "kernel/random-inl.h"
#include "kernel/sobol-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

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

/// A path's time, 0..1 within the shutter; the same at all its vertices.
///
/// Precision  24 bits, so that a float holds it exactly
template <class D>
HWY_INLINE hn::Vec<D> time_of_path(D d, const Sampler& sampler, hn::Vec<hn::RebindToUnsigned<D>> pixel,
                                   hn::Vec<hn::RebindToUnsigned<D>> sample) {
  constexpr std::uint32_t kVertex = 0xfffffffe;  // above all vertices
  const hn::RebindToUnsigned<D> du;
  const auto bits = sampler.kind == SamplerKind::kIndependent
                        ? independent_at_vertex(du, sampler.seed, pixel, sample, kVertex)
                        : sobol_at_vertex(du, sampler, pixel, sample, kVertex, kSobolTimeOrder, false);
  const auto u = to_unit(d, bits.v[0]);
  return hn::Floor(u * 0x1p24) * 0x1p-24;
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
