// SPDX-License-Identifier: Apache-2.0
// Between memory and vectors: gathers of rows and of spheres, and compaction of lanes.
#pragma once

#include <hwy/highway.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <type_traits>

#include "kernel/intersect-inl.h"
#include "kernel/sphere.h"
#include "math/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

#if HWY_MAX_BYTES >= 32

/// Loads four consecutive doubles or floats as four numbers of type T.
template <class T, class From>
HWY_INLINE hn::Vec<hn::FixedTag<T, 4>> load_row(const From* row) {
  const hn::FixedTag<T, 4> d;
  const hn::Rebind<From, decltype(d)> from;
  if constexpr (sizeof(T) == sizeof(From)) {
    return hn::LoadU(d, row);
  } else if constexpr (sizeof(T) > sizeof(From)) {
    return hn::PromoteTo(d, hn::LoadU(from, row));
  } else {
    return hn::DemoteTo(d, hn::LoadU(from, row));
  }
}

/// Keeps rows in registers: loading a vector from rows that have just been stored would stall on store forwarding.
template <class D, class RowOfLane>
HWY_INLINE void transpose_rows(D d, RowOfLane row_of_lane, hn::Vec<D> (&out)[4]) {
  using T = hn::TFromD<D>;
  const auto row = [&](std::size_t i) { return load_row<T>(row_of_lane(i)); };
  const auto rows = [&](std::size_t i) {  // i, i + 4, ...
    if constexpr (hn::MaxLanes(D()) == 4) {
      return row(i);
    } else if constexpr (hn::MaxLanes(D()) == 8) {
      return hn::Combine(d, row(i + 4), row(i));
    } else {
      const hn::Half<D> half;
      return hn::Combine(d, hn::Combine(half, row(i + 12), row(i + 8)), hn::Combine(half, row(i + 4), row(i)));
    }
  };
  const auto a = rows(0), b = rows(1), c = rows(2), e = rows(3);
  const auto ab_low = hn::InterleaveLower(d, a, b), ab_high = hn::InterleaveUpper(d, a, b);
  const auto ce_low = hn::InterleaveLower(d, c, e), ce_high = hn::InterleaveUpper(d, c, e);
  if constexpr (sizeof(T) == 8) {
    out[0] = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(ce_low), ab_low);
    out[1] = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(ce_high), ab_high);
    out[2] = hn::OddEvenBlocks(ce_low, hn::SwapAdjacentBlocks(ab_low));
    out[3] = hn::OddEvenBlocks(ce_high, hn::SwapAdjacentBlocks(ab_high));
  } else {
    const hn::Repartition<double, D> pairs;
    const auto lower = [&](auto x, auto y) {
      return hn::BitCast(d, hn::InterleaveLower(pairs, hn::BitCast(pairs, x), hn::BitCast(pairs, y)));
    };
    const auto upper = [&](auto x, auto y) {
      return hn::BitCast(d, hn::InterleaveUpper(pairs, hn::BitCast(pairs, x), hn::BitCast(pairs, y)));
    };
    out[0] = lower(ab_low, ce_low);
    out[1] = upper(ab_low, ce_low);
    out[2] = lower(ab_high, ce_high);
    out[3] = upper(ab_high, ce_high);
  }
}

#else

/// A register does not hold four doubles, so rows pass through memory.
template <class D, class RowOfLane>
HWY_INLINE void transpose_rows(D d, RowOfLane row_of_lane, hn::Vec<D> (&out)[4]) {
  using T = hn::TFromD<D>;
  using From = std::remove_cv_t<std::remove_reference_t<decltype(*row_of_lane(0))>>;
  // The number of lanes of the wider type.
  using Wide = std::conditional_t<sizeof(T) >= sizeof(From), T, From>;
  const hn::CappedTag<Wide, 4> wide_tag;
  const hn::Rebind<From, decltype(wide_tag)> row_tag;
  const hn::Rebind<T, decltype(wide_tag)> to_tag;
  HWY_ALIGN T rows[4 * hn::MaxLanes(D())];
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) {
    for (std::size_t k = 0; k < 4; k += hn::Lanes(row_tag)) {
      const auto part = hn::LoadU(row_tag, row_of_lane(i) + k);
      if constexpr (sizeof(T) == sizeof(From)) {
        hn::StoreU(part, row_tag, rows + 4 * i + k);
      } else if constexpr (sizeof(T) > sizeof(From)) {
        hn::StoreU(hn::PromoteTo(to_tag, part), to_tag, rows + 4 * i + k);
      } else {
        hn::StoreU(hn::DemoteTo(to_tag, part), to_tag, rows + 4 * i + k);
      }
    }
  }
  hn::LoadInterleaved4(d, rows, out[0], out[1], out[2], out[3]);
}

#endif

/// Loads four consecutive doubles or floats per lane and transposes them into four vectors.
template <class D, class RowOfLane>
HWY_INLINE void gather4(D d, RowOfLane row_of_lane, hn::Vec<D> (&out)[4]) {
  if constexpr (hn::MaxLanes(D()) == 1) {
    for (int k = 0; k < 4; ++k) out[k] = set(d, row_of_lane(0)[k]);
  } else {
    transpose_rows(d, row_of_lane, out);
  }
}

/// Loads a sphere per lane: centre and radius.
template <class D, class IdOfLane>
HWY_INLINE void gather_spheres(D d, const SphereArray& spheres, IdOfLane id_of_lane, hn::Vec<D> (&out)[4]) {
  using T = hn::TFromD<D>;
  if (spheres.all_plain()) {
    gather4(
        d, [&](std::size_t i) { return &spheres.plain[id_of_lane(i)].x; }, out);
    return;
  }
  std::size_t ids[hn::MaxLanes(D())];
  bool compact = true;
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) {
    ids[i] = id_of_lane(i);
    compact = compact & (ids[i] >= spheres.plain_count);
  }
  if (compact) {
    gather4(
        d, [&](std::size_t i) { return spheres.centers + 3 * (ids[i] - spheres.plain_count); }, out);
    if (spheres.radii == nullptr && spheres.radius_indices == nullptr) {
      out[3] = hn::Set(d, static_cast<T>(spheres.radius_palette[0]));
      return;
    }
    HWY_ALIGN T radii[hn::MaxLanes(D())];
    for (std::size_t i = 0; i < hn::Lanes(d); ++i)
      radii[i] = static_cast<T>(spheres.radius_of_compact(ids[i] - spheres.plain_count));
    out[3] = hn::Load(d, radii);
    return;
  }
  Sphere row[hn::MaxLanes(D())];
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) row[i] = spheres[ids[i]];
  gather4(
      d, [&](std::size_t i) { return &row[i].x; }, out);
}

/// Loads a float per lane.
template <class D>
HWY_INLINE hn::Vec<D> load_floats(D d, const float* from) {
  const auto narrow = hn::LoadU(hn::Rebind<float, D>(), from);
  if constexpr (sizeof(hn::TFromD<D>) == 8)
    return hn::PromoteTo(d, narrow);
  else
    return narrow;
}

/// Stores lanes as floats.
template <class D>
HWY_INLINE void store_floats(D, hn::Vec<D> value, float* to) {
  const hn::Rebind<float, D> narrow;
  if constexpr (sizeof(hn::TFromD<D>) == 8)
    hn::StoreU(hn::DemoteTo(narrow, value), narrow, to);
  else
    hn::StoreU(value, narrow, to);
}

/// Converts a mask to one bit per lane.
template <class D>
HWY_INLINE unsigned bits_of(D d, hn::Mask<D> mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  return static_cast<unsigned>(bytes[0]) | static_cast<unsigned>(bytes[1]) << 8;
}

/// The bits that are set in a word, ascending. Compilers inline the body of a loop over them, unlike a lambda.
class SetBits {
 public:
  struct Iterator {
    std::uint64_t rest;

    HWY_INLINE int operator*() const { return static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(rest)); }
    HWY_INLINE void operator++() { rest &= rest - 1; }
    HWY_INLINE bool operator!=(std::default_sentinel_t) const { return rest != 0; }
  };
  HWY_INLINE explicit SetBits(std::uint64_t bits) : bits_(bits) {}
  HWY_INLINE Iterator begin() const { return {bits_}; }
  HWY_INLINE std::default_sentinel_t end() const { return {}; }

 private:
  std::uint64_t bits_;
};

/// Calls `what(lane)` for each set lane.
template <class D, class Do>
HWY_INLINE void each_lane(D d, hn::Mask<D> lanes, Do what) {
  for (const int lane : SetBits(bits_of(d, lanes))) what(lane);
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
