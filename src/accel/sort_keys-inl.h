// SPDX-License-Identifier: Apache-2.0
// Sort keys: a distance and an index in 32 bits. Compiled once per instruction set.
#if defined(ORRERY_ACCEL_SORT_KEYS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_ACCEL_SORT_KEYS_INL_H_
#undef ORRERY_ACCEL_SORT_KEYS_INL_H_
#else
#define ORRERY_ACCEL_SORT_KEYS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>
#include <functional>

#include "accel/embree_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::accel::HWY_NAMESPACE {

/// Keys of non-negative distances, rounded down, with an index below kIndices in their low bits.
template <unsigned kIndices, class D>
HWY_INLINE hn::Vec<hn::RebindToSigned<D>> keys_of(D, hn::Vec<D> distance, hn::Vec<hn::RebindToSigned<D>> index) {
  const hn::RebindToSigned<D> di;
  static_assert((kIndices & (kIndices - 1)) == 0);
  // Also clears the sign, since a zero may be negative.
  constexpr auto kReplaced = static_cast<std::int32_t>(0x80000000u | (kIndices - 1));
  return hn::Or(hn::AndNot(hn::Set(di, kReplaced), hn::BitCast(di, distance)), index);
}

/// AVX-512 moves the chosen lanes of a vector to its front in one instruction; elsewhere a loop over the few chosen
/// lanes is faster.
constexpr bool kHasCompress = HWY_TARGET <= HWY_AVX3;

/// Stores the lanes of `mask` contiguously, followed by zeros up to at least a vector's length.
///
/// Result     number of lanes in `mask`
template <class D>
HWY_INLINE int store_chosen(D d, hn::Vec<D> v, hn::Mask<D> mask, hn::TFromD<D>* to) {
  if constexpr (kHasCompress) {
    hn::StoreU(hn::Compress(v, mask), d, to);  // AVX-512 sets the other lanes to zero
    return static_cast<int>(hn::CountTrue(d, mask));
  } else {
    HWY_ALIGN hn::TFromD<D> lanes[hn::MaxLanes(D())];
    hn::Store(v, d, lanes);
    int count = 0;
    each_bit(bits_of(d, mask), [&](int i) { to[count++] = lanes[i]; });
    hn::StoreU(hn::Zero(d), d, to + count);
    return count;
  }
}

/// Sorts four keys, largest first, by a network of three layers.
HWY_INLINE hn::Vec<hn::FixedTag<std::int32_t, 4>> sorted4(hn::Vec<hn::FixedTag<std::int32_t, 4>> keys) {
  const hn::FixedTag<std::int32_t, 4> d;
  alignas(16) static constexpr std::int32_t kOdd[4] = {0, -1, 0, -1}, kUpper[4] = {0, 0, -1, -1},
                                            kMiddle[4] = {0, 2, 1, 3};
  const auto exchange = [&](auto other, const std::int32_t* to_min) {
    const auto lower = hn::Load(d, to_min) < hn::Zero(d);
    keys = hn::IfThenElse(lower, hn::Min(keys, other), hn::Max(keys, other));
  };
  exchange(hn::Shuffle2301(keys), kOdd);
  exchange(hn::Shuffle1032(keys), kUpper);
  exchange(hn::TableLookupLanes(keys, hn::SetTableIndices(d, kMiddle)), kUpper);
  return keys;
}

#if HWY_MAX_BYTES >= 32
/// Sorts eight keys, largest first, by a network of six layers.
HWY_INLINE hn::Vec<hn::FixedTag<std::int32_t, 8>> sorted8(hn::Vec<hn::FixedTag<std::int32_t, 8>> keys) {
  const hn::FixedTag<std::int32_t, 8> d;
  alignas(32) static constexpr std::int32_t kOther[6][8] = {{1, 0, 3, 2, 5, 4, 7, 6}, {2, 3, 0, 1, 6, 7, 4, 5},
                                                            {0, 2, 1, 3, 4, 6, 5, 7}, {4, 5, 6, 7, 0, 1, 2, 3},
                                                            {0, 1, 4, 5, 2, 3, 6, 7}, {0, 2, 1, 4, 3, 6, 5, 7}};
  alignas(32) static constexpr std::int32_t kUpper[6][8] = {{0, -1, 0, -1, 0, -1, 0, -1}, {0, 0, -1, -1, 0, 0, -1, -1},
                                                            {0, 0, -1, 0, 0, 0, -1, 0},   {0, 0, 0, 0, -1, -1, -1, -1},
                                                            {0, 0, 0, 0, -1, -1, 0, 0},   {0, 0, -1, 0, -1, 0, -1, 0}};
  for (int layer = 0; layer < 6; ++layer) {
    const auto other = hn::TableLookupLanes(keys, hn::SetTableIndices(d, kOther[layer]));
    const auto upper = hn::Load(d, kUpper[layer]) < hn::Zero(d);
    keys = hn::IfThenElse(upper, hn::Min(keys, other), hn::Max(keys, other));
  }
  return keys;
}
#endif

/// Sorts keys in place, largest first.
///
/// Domain     `keys` is aligned to a vector and padded with zeros to eight keys
HWY_INLINE void sort_keys(std::int32_t* keys, int count) {
  const hn::FixedTag<std::int32_t, 4> d;
  if (count <= 4) {
    hn::Store(sorted4(hn::Load(d, keys)), d, keys);
    return;
  }
#if HWY_MAX_BYTES >= 32
  if (count <= 8) {
    const hn::FixedTag<std::int32_t, 8> d8;
    hn::Store(sorted8(hn::Load(d8, keys)), d8, keys);
    return;
  }
#endif
  std::sort(keys, keys + count, std::greater<>());
}

}  // namespace orrery::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
