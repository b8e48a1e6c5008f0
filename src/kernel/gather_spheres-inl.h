// SPDX-License-Identifier: Apache-2.0
// Gathers of spheres.
#if defined(ORRERY_KERNEL_GATHER_SPHERES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_KERNEL_GATHER_SPHERES_INL_H_
#undef ORRERY_KERNEL_GATHER_SPHERES_INL_H_
#else
#define ORRERY_KERNEL_GATHER_SPHERES_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>

#include "kernel/gather-inl.h"
#include "kernel/sphere.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

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
