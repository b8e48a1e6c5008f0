// SPDX-License-Identifier: Apache-2.0
// Compaction of lanes.
#if defined(ORRERY_KERNEL_COMPACTION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_KERNEL_COMPACTION_INL_H_
#undef ORRERY_KERNEL_COMPACTION_INL_H_
#else
#define ORRERY_KERNEL_COMPACTION_INL_H_
#endif

#include <hwy/highway.h>

#include <array>
#include <cstddef>
#include <cstdint>

#include "kernel/intersect-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// Calls `what(lane)` for each set lane.
template <class D, class Do>
HWY_INLINE void each_lane(D d, hn::Mask<D> lanes, Do what) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, lanes, bytes);
  for (unsigned bits = bytes[0] | unsigned{bytes[1]} << 8; bits != 0; bits &= bits - 1)
    what(static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(bits)));
}

/// For each lane mask, the permutation that moves the set lanes to the front. The remaining entries are unspecified.
template <class Index, std::size_t kLanes>
constexpr auto make_compaction_table() {
  std::array<std::array<Index, kLanes>, (std::size_t{1} << kLanes)> table{};
  for (std::size_t set = 0; set < table.size(); ++set) {
    std::size_t to = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      if ((set >> lane & 1) != 0) table[set][to++] = static_cast<Index>(lane);
  }
  return table;
}

template <class Index, std::size_t kLanes>
alignas(64) inline constexpr auto kCompaction = make_compaction_table<Index, kLanes>();

/// Stores selected lanes of vectors contiguously. May overwrite a whole vector's length from the destination.
///
/// The permutation is looked up once for all vectors. Highway's CompressStore looks it up each time, for which GCC
/// copies the table to the stack; that took a quarter of the time.
template <class D>
class Compactor {
 public:
  HWY_INLINE Compactor(D d, hn::Mask<D> mask) : mask_(mask), count_(static_cast<int>(hn::CountTrue(d, mask))) {
    if constexpr (kUsesTable) {
      std::uint8_t bits[8] = {};
      hn::StoreMaskBits(d, mask, bits);
      order_ = hn::Load(IdTag<D>(), kCompaction<hn::TFromD<IdTag<D>>, hn::MaxLanes(D())>[bits[0]].data());
    }
  }
  HWY_INLINE int count() const { return count_; }

  HWY_INLINE void store(D d, hn::Vec<D> v, hn::TFromD<D>* to) const {
    if constexpr (hn::MaxLanes(D()) == 1) {
      hn::StoreU(v, d, to);
    } else if constexpr (kUsesTable) {
      hn::StoreU(hn::TableLookupLanes(v, hn::IndicesFromVec(d, order_)), d, to);
    } else if constexpr (sizeof(hn::TFromD<D>) == 4) {
      hn::StoreU(hn::Compress(v, mask_), d, to);  // some processors take ten times as long to compress into memory
    } else {
      hn::CompressStore(v, mask_, d, to);  // Highway 1.0 compresses 64-bit lanes in registers by a table, which is slow
    }
  }
  HWY_INLINE void store_ids(D d, hn::Vec<IdTag<D>> v, hn::TFromD<IdTag<D>>* to) const {
    store(d, hn::BitCast(d, v), reinterpret_cast<hn::TFromD<D>*>(to));
  }
  template <class Array>
  HWY_INLINE void store3(D d, const Vec3<hn::Vec<D>>& v, Array& to, int at) const {
    store(d, v.x, to[0] + at);
    store(d, v.y, to[1] + at);
    store(d, v.z, to[2] + at);
  }

 private:
  // AVX-512 has an instruction for it.
  static constexpr bool kUsesTable = hn::MaxLanes(D()) > 1 && HWY_TARGET > HWY_AVX3;
  hn::Mask<D> mask_;
  int count_;
  hn::Vec<IdTag<D>> order_{};
};

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
