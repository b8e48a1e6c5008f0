// SPDX-License-Identifier: Apache-2.0
// Counter-based random numbers.
#pragma once

#include <hwy/highway.h>

#include "math/functions-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using namespace math::HWY_NAMESPACE;  // NOLINT(google-build-using-namespace): SIMD vectors of another room

/// Hashes 32 bits.
///
/// Reference  appleby2011, the end of MurmurHash3
template <class D32, class V = hn::Vec<D32>>
HWY_INLINE V hashed(D32 d32, V v) {
  v = hn::Xor(v, hn::ShiftRight<16>(v)) * hn::Set(d32, 0x85ebca6bu);
  v = hn::Xor(v, hn::ShiftRight<13>(v)) * hn::Set(d32, 0xc2b2ae35u);
  return hn::Xor(v, hn::ShiftRight<16>(v));
}

/// A 64-bit product. In 64-bit lanes each half is in the low 32 bits.
template <class V>
struct WideProduct {
  V high, low;
};

/// The full 32 x 32 bit products a * multiplier.
template <class DU, class V = hn::Vec<DU>>
HWY_INLINE WideProduct<V> multiply_wide(DU du, V a, std::uint32_t multiplier) {
  if constexpr (sizeof(hn::TFromD<DU>) == 8) {
    const hn::Repartition<std::uint32_t, DU> d32;
    const V product = hn::BitCast(du, hn::MulEven(hn::BitCast(d32, a), hn::Set(d32, multiplier)));
    return {hn::ShiftRight<32>(product), product};
  } else {
    const hn::Repartition<std::uint64_t, DU> d64;
    const V m = hn::Set(du, multiplier);
    const V even = hn::BitCast(du, hn::MulEven(a, m));
    const V odd = hn::BitCast(du, hn::MulEven(hn::BitCast(du, hn::ShiftRight<32>(hn::BitCast(d64, a))), m));
    return {hn::OddEven(odd, hn::BitCast(du, hn::ShiftRight<32>(hn::BitCast(d64, even)))), a * m};
  }
}

template <class V>
struct Four {
  V v[4];
};

/// Philox4x32 with seven rounds: four 32-bit random numbers for each counter.
///
/// Result     bits; in 64-bit lanes in the low halves, with the high halves undefined
/// Reference  salmon2011
template <class DU, class V = hn::Vec<DU>>
HWY_INLINE Four<V> philox(DU du, Four<V> counter, std::uint32_t key0, std::uint32_t key1) {
  V c0 = counter.v[0], c1 = counter.v[1], c2 = counter.v[2], c3 = counter.v[3];
  HWY_UNROLL(7)
  for (int round = 0; round < 7; ++round) {
    const auto p0 = multiply_wide(du, c0, 0xD2511F53u);
    const auto p1 = multiply_wide(du, c2, 0xCD9E8D57u);
    c0 = hn::Xor(hn::Xor(p1.high, c1), hn::Set(du, key0));
    c1 = p1.low;
    c2 = hn::Xor(hn::Xor(p0.high, c3), hn::Set(du, key1));
    c3 = p0.low;
    key0 += 0x9E3779B9u;
    key1 += 0xBB67AE85u;
  }
  return {{c0, c1, c2, c3}};
}

/// Maps bits to the centre of one of 2^32 (double) or 2^23 (float) equal intervals of 0..1: never 0 or 1, symmetric
/// about 1/2.
template <class D>
HWY_INLINE hn::Vec<D> to_unit(D d, hn::Vec<hn::RebindToUnsigned<D>> bits) {
  const hn::RebindToUnsigned<D> du;
  if constexpr (sizeof(hn::TFromD<D>) == 8) {
    const auto low = hn::And(bits, hn::Set(du, 0xffffffffu));
    return mul_add(math::HWY_NAMESPACE::to_real(d, low), 0x1p-32, 0x1p-33);
  } else {
    const auto whole = math::HWY_NAMESPACE::to_real(d, hn::ShiftRight<9>(bits));
    return mul_add(whole, 0x1p-23f, 0x1p-24f);
  }
}

/// Four random numbers, independent of those of any other (seed, pixel, sample, vertex).
///
/// Result     as for philox
template <class DU, class V = hn::Vec<DU>>
HWY_INLINE Four<V> independent_at_vertex(DU du, std::uint32_t seed, V pixel, V sample, std::uint32_t vertex) {
  return philox(du, Four<V>{{pixel, sample, hn::Set(du, vertex), hn::Zero(du)}}, seed,
                0x6f727279u /* names this use of the seed */);
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
