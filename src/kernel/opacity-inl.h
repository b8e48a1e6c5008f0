// SPDX-License-Identifier: Apache-2.0
// Opacity: which objects are visible to a ray.
#if defined(ORRERY_KERNEL_OPACITY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_KERNEL_OPACITY_INL_H_
#undef ORRERY_KERNEL_OPACITY_INL_H_
#else
#define ORRERY_KERNEL_OPACITY_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#include "kernel/random-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// Lanes of 32 bits, as many as those of D: keys of rays.
template <class D>
using KeyTag = hn::Rebind<std::uint32_t, D>;

/// The random keys of the rays that start at a path's vertex.
template <class DU>
struct RayKeys {
  hn::Vec<DU> next;     ///< of the ray that continues the path
  hn::Vec<DU> shadow;   ///< of the shadow ray
  hn::Vec<DU> caustic;  ///< of the first ray to a ball; see caustic_sampling-inl.h
};

/// Returns the keys of the rays from a vertex, independent of those from any other. Not inlined.
///
/// `vertex`   0: the camera
/// Domain     vertex < 2^30
/// Result     as for philox
template <class DU, class V = hn::Vec<DU>>
HWY_NOINLINE RayKeys<DU> keys_at_vertex(DU du, std::uint32_t seed, V pixel, V sample, std::uint32_t vertex) {
  constexpr std::uint32_t kKeys = 0x80000000u;  // above the vertices of second_random_at_vertex
  const auto random = independent_at_vertex(du, seed, pixel, sample, kKeys + vertex);
  return {random.v[0], random.v[1], random.v[2]};
}

/// Stores the low 32 bits of keys.
template <class D>
HWY_INLINE void store_keys(D, hn::Vec<hn::RebindToUnsigned<D>> keys, std::uint32_t* to) {
  const KeyTag<D> d32;
  if constexpr (sizeof(hn::TFromD<D>) == 8) {
    hn::Store(hn::TruncateTo(d32, keys), d32, to);
  } else {
    hn::Store(keys, d32, to);
  }
}

/// Whether objects are visible to rays: true with the probability `opacity` over the keys, independently for different
/// ids.
///
/// A function of key and id, so that the decision does not depend on the order of traversal and holds for a whole
/// object, its front and its back.
///
/// Domain     0 <= opacity <= 1; the value of a float, so that all precisions decide alike
/// Precision  multiples of 2^-24 (KernelOpacity.*)
template <class D>
HWY_INLINE hn::Mask<D> are_visible(D d, hn::Vec<KeyTag<D>> keys, hn::Vec<KeyTag<D>> ids, hn::Vec<D> opacity) {
  const KeyTag<D> d32;
  const hn::RebindToSigned<KeyTag<D>> di;
  // Ids are hashed first: otherwise decisions about ids that differ in a single high bit would be correlated.
  const auto hash = hashed(d32, keys + hashed(d32, ids));
  const auto bits = hn::BitCast(di, hn::ShiftRight<8>(hash));
  if constexpr (sizeof(hn::TFromD<D>) == 8) {
    return hn::PromoteTo(d, bits) * 0x1p-24 < opacity;
  } else {
    return hn::ConvertTo(d, bits) * 0x1p-24 < opacity;
  }
}

/// Lanes of the rays of a packet, from `first` on, to which an object is visible.
template <class D, class Packet>
HWY_INLINE hn::Mask<D> visible_lanes(D d, const Packet& packet, int first, std::uint32_t id, float opacity) {
  if (opacity >= 1) return hn::FirstN(d, hn::Lanes(d));
  const KeyTag<D> d32;
  return are_visible(d, hn::LoadU(d32, packet.key + first), hn::Set(d32, id), set(d, opacity));
}

/// Lanes of the rays of a packet, from `first` on, to which rods are visible.
///
/// `ids`      of the first halves: they decide for both
/// `halves`   ids of the halves that the rays enter, which have the opacity
template <class D, class Packet, class DU = hn::RebindToUnsigned<D>>
HWY_INLINE hn::Mask<D> visible_rods(D d, const Packet& packet, int first, hn::Vec<DU> ids, hn::Vec<DU> halves,
                                    hn::Mask<D> lanes, const float* opacity) {
  const KeyTag<D> d32;
  HWY_ALIGN std::uint32_t objects[hn::MaxLanes(D())], of[hn::MaxLanes(D())];
  HWY_ALIGN hn::TFromD<D> opacities[hn::MaxLanes(D())];
  store_keys(d, ids, objects);
  store_keys(d, hn::IfThenElseZero(hn::RebindMask(DU(), lanes), halves), of);
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) opacities[i] = hn::TFromD<D>{opacity[of[i]]};
  return are_visible(d, hn::LoadU(d32, packet.key + first), hn::Load(d32, objects), hn::Load(d, opacities));
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
