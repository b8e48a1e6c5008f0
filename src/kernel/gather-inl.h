// SPDX-License-Identifier: Apache-2.0
// Gathers of rows of memory, and of spheres.
#if defined(ORRERY_KERNEL_GATHER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_KERNEL_GATHER_INL_H_
#undef ORRERY_KERNEL_GATHER_INL_H_
#else
#define ORRERY_KERNEL_GATHER_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <type_traits>

#include "kernel/sphere.h"
#include "math/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using namespace math::HWY_NAMESPACE;  // NOLINT(google-build-using-namespace): SIMD vectors of another room

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

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
