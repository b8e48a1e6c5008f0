// SPDX-License-Identifier: Apache-2.0
// The numbers that a path takes at its vertices. Compiled once per instruction set.
#if defined(ORRERY_KERNEL_SAMPLER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_KERNEL_SAMPLER_INL_H_
#undef ORRERY_KERNEL_SAMPLER_INL_H_
#else
#define ORRERY_KERNEL_SAMPLER_INL_H_
#endif

#include <hwy/highway.h>

#include "kernel/random-inl.h"
#include "kernel/sampler.h"
#include "kernel/sobol-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// The lower 16 bits, each moved to the bit of twice its place.
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

/// Sobol's points for a pixel's samples at one vertex of their paths.
///
/// `order`    place in kSobolOrders
///
/// With blue noise one sequence goes through neighbouring pixels along a curve that keeps neighbours together, so that
/// their errors cancel rather than add.
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
  V beyond = hn::ShiftRight<kSobolBits>(sample);  // with the half; another sequence for each
  V place = pixel;
  if (sampler.kind == SamplerKind::kBlueNoise) {
    const V curve =
        hn::Or(spread_bits(du, pixel), hn::ShiftLeft<1>(spread_bits(du, hn::template ShiftRight<16>(pixel))));
    // A pixel's samples beyond its share of the sequence come from another one.
    const int bits = sampler.blue_noise_bits;
    index = hn::And(sample, hn::Set(du, (Id{1} << bits) - 1));
    index = hn::And(hn::Or(hn::ShiftLeftSame(curve, bits), index), low_bits);
    beyond = hn::ShiftRightSame(sample, bits);
    place = hn::ShiftRightSame(curve, kSobolBits - bits);
  }
  // Odd multiples keep different places different; what is left of coincidences between vertices is by chance.
  const auto times = [&](V v, std::uint32_t factor) {
    return hn::BitCast(du, hn::BitCast(d32, v) * hn::BitCast(d32, hn::Set(du, Id{factor})));
  };
  const std::uint32_t key = (sampler.seed * 0x2c1b3c6du) ^ ((vertex + 1) * 0x297a2d39u);
  const V name = hn::Xor(times(place, 0x85157af5u), hn::Xor(times(beyond, 0x9e3779b1u), hn::Set(du, Id{key})));
  return sobol(du, index, name, order, last_two);
}

/// The four numbers in 0..1 that one path takes at one of its vertices.
///
/// `last_two` false: nobody reads these, and they may be anything.
template <class D>
HWY_INLINE Four<hn::Vec<D>> random_at_vertex(D d, const Sampler& sampler, hn::Vec<hn::RebindToUnsigned<D>> pixel,
                                             hn::Vec<hn::RebindToUnsigned<D>> sample, std::uint32_t vertex,
                                             bool last_two) {
  const hn::RebindToUnsigned<D> du;
  // Far down a path so much has been decided already that even points bring nothing.
  const auto bits = sampler.kind == SamplerKind::kIndependent || vertex >= kSobolVertices
                        ? independent_at_vertex(du, sampler.seed, pixel, sample, vertex)
                        : sobol_at_vertex(du, sampler, pixel, sample, vertex, vertex, last_two);
  return {{to_unit(d, bits.v[0]), to_unit(d, bits.v[1]), to_unit(d, bits.v[2]), to_unit(d, bits.v[3])}};
}

/// When a path happens, 0..1 within the shutter; the same at all its vertices.
///
/// Precision  24 bits, so that a float has it as it is
template <class D>
HWY_INLINE hn::Vec<D> time_of_path(D d, const Sampler& sampler, hn::Vec<hn::RebindToUnsigned<D>> pixel,
                                   hn::Vec<hn::RebindToUnsigned<D>> sample) {
  using T = hn::TFromD<D>;
  constexpr std::uint32_t kVertex = 0xfffffffe;  // that no path has
  const hn::RebindToUnsigned<D> du;
  const auto bits = sampler.kind == SamplerKind::kIndependent
                        ? independent_at_vertex(du, sampler.seed, pixel, sample, kVertex)
                        : sobol_at_vertex(du, sampler, pixel, sample, kVertex, kSobolTimeOrder, false);
  const auto u = to_unit(d, bits.v[0]);
  return hn::Floor(u * hn::Set(d, T(0x1p24))) * hn::Set(d, T(0x1p-24));
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
