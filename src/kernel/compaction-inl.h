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
/// copies the table to the stack; that took a quarter of the time. AVX-512 has an instruction for it, which some
/// processors execute in ten times the time if its destination is memory. Highway uses it in registers for 32-bit lanes
/// only, so that 64-bit lanes are compressed as pairs of them.
template <class D>
class Compactor {
 public:
  HWY_INLINE Compactor(D d, hn::Mask<D> mask) : count_(static_cast<int>(hn::CountTrue(d, mask))) {
    if constexpr (kUsesInstruction) {
      words_ = hn::MaskFromVec(hn::BitCast(Words(), hn::VecFromMask(d, mask)));
    } else if constexpr (kUsesTable) {
      std::uint8_t bits[8] = {};
      hn::StoreMaskBits(d, mask, bits);
      order_ = hn::Load(IdTag<D>(), kCompaction<hn::TFromD<IdTag<D>>, hn::MaxLanes(D())>[bits[0]].data());
    }
  }
  HWY_INLINE int count() const { return count_; }

  HWY_INLINE void store(D d, hn::Vec<D> v, hn::TFromD<D>* to) const {
    if constexpr (kUsesInstruction)
      v = hn::BitCast(d, hn::Compress(hn::BitCast(Words(), v), words_));
    else if constexpr (kUsesTable)
      v = hn::TableLookupLanes(v, hn::IndicesFromVec(d, order_));
    hn::StoreU(v, d, to);
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
  using Words = hn::Repartition<std::uint32_t, D>;

  static constexpr bool kUsesInstruction = hn::MaxLanes(D()) > 1 && HWY_TARGET <= HWY_AVX3;
  static constexpr bool kUsesTable = hn::MaxLanes(D()) > 1 && !kUsesInstruction;
  hn::Mask<Words> words_{};
  int count_;
  hn::Vec<IdTag<D>> order_{};
};

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
