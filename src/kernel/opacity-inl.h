// SPDX-License-Identifier: Apache-2.0
// Opacity: which objects are visible to a path.
#pragma once

#include <hwy/highway.h>

#include <cstddef>

#include "kernel/gather-inl.h"
#include "kernel/ray_packet.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// Lanes of the rays of a packet, from `first` on, to which an object is visible.
template <class D, class Packet>
HWY_INLINE hn::Mask<D> visible_lanes(D d, const Packet& packet, int first, float opacity) {
  return load_floats(d, packet.threshold + first) < set(d, opacity);
}

/// Those of the lanes in which an object is visible to a ray. Not inlined.
///
/// `thresholds` of the rays
/// `ids`        of the objects
/// `opacity`    of all objects
template <class D>
HWY_NOINLINE hn::Mask<D> visible_objects(D d, const float* thresholds, hn::Vec<hn::RebindToUnsigned<D>> ids,
                                         hn::Mask<D> lanes, const float* opacity) {
  const hn::RebindToUnsigned<D> du;
  HWY_ALIGN hn::TFromD<decltype(du)> id[hn::MaxLanes(D())];
  HWY_ALIGN hn::TFromD<D> of[hn::MaxLanes(D())];
  hn::Store(hn::IfThenElseZero(hn::RebindMask(du, lanes), ids), du, id);
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) of[i] = hn::TFromD<D>{opacity[id[i]]};
  return hn::And(lanes, load_floats(d, thresholds) < hn::Load(d, of));
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
