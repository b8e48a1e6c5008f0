// SPDX-License-Identifier: Apache-2.0
// Rows of memory fetched lane by lane. Compiled once per instruction set.
#if defined(ORRERY_KERNEL_GATHER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_KERNEL_GATHER_INL_H_
#undef ORRERY_KERNEL_GATHER_INL_H_
#else
#define ORRERY_KERNEL_GATHER_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <type_traits>

#include "kernel/sphere_array.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Loads four consecutive doubles or floats per lane and transposes them into four vectors.
template <class D, class RowOfLane>
HWY_INLINE void gather4(D d, RowOfLane row_of_lane, hn::Vec<D> (&out)[4]) {
  using T = hn::TFromD<D>;
  using From = std::remove_cv_t<std::remove_reference_t<decltype(*row_of_lane(0))>>;
  if constexpr (hn::MaxLanes(D()) == 1) {
    for (int k = 0; k < 4; ++k) out[k] = hn::Set(d, static_cast<T>(row_of_lane(0)[k]));
  } else {
    // As many lanes as the wider type has.
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
}

/// Loads a sphere per lane: centre and radius.
template <class D, class IdOfLane>
HWY_INLINE void gather_spheres(D d, const SphereArray& spheres, IdOfLane id_of_lane, hn::Vec<D> (&out)[4]) {
  if (spheres.all_plain()) {
    gather4(
        d, [&](std::size_t i) { return &spheres.plain[id_of_lane(i)].x; }, out);
  } else {
    Sphere row[hn::MaxLanes(D())];
    for (std::size_t i = 0; i < hn::Lanes(d); ++i) row[i] = spheres[id_of_lane(i)];
    gather4(
        d, [&](std::size_t i) { return &row[i].x; }, out);
  }
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
