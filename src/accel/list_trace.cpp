// SPDX-License-Identifier: Apache-2.0
// Queries of packets by the naive list.
#include <hwy/highway.h>

#include <algorithm>
#include <type_traits>

#include "accel/list.h"
#include "kernel/intersect-inl.h"
#include "kernel/rod-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::accel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Traces each ray of a packet, or tests it for occlusion, by a loop over all spheres, then all rods.
template <class Packet, kernel::Precision kPrecision>
void trace_list(const void* self, Packet& packet) {
  namespace k = kernel::HWY_NAMESPACE;
  using T = typename Packet::Number;
  using Id = typename Packet::Id;
  using D = hn::FixedTag<T, 1>;
  const D d;
  const auto& [scene, duplicates] = *static_cast<const DistinctObjects*>(self);
  if constexpr (Packet::kIsShadow) std::fill_n(packet.occluded, kernel::kPacketSize, Id{0});
  for (int i = 0; i < packet.count; ++i) {
    const auto ray = k::load_rays(d, packet, i);
    // Includes a hit, and returns whether the ray is done. Ids ascend, so at equal distance the smaller one was first.
    const auto take = [&](std::size_t hit, T distance) {
      if (distance >= packet.distance[i]) return false;
      if (scene.opacity != nullptr && !(packet.threshold[i] < scene.opacity[hit])) return false;
      if constexpr (Packet::kIsShadow) {
        if (packet.target[i] == hit) return false;
        packet.occluded[i] = static_cast<Id>(~Id{0});
        return true;
      } else {
        packet.distance[i] = distance;
        packet.hit[i] = static_cast<Id>(hit);
        return false;
      }
    };
    std::size_t id = 0;
    bool is_done = false;
    const auto trace_up_to = [&](std::size_t end) {
      for (; id < end && !is_done; ++id) {
        // Compared as vectors: for a comparison of integers, GCC 12 reuses a register of the test before, for which the
        // next test then waits; with AVX-512, `fast` took 1.5 times as long.
        const auto is_self = hn::RebindMask(d, ray.self == hn::Set(k::IdTag<D>(), static_cast<Id>(id)));
        const auto found = k::closest_distance<D, kPrecision>(
            d, ray, k::sphere_at(d, scene, static_cast<std::uint32_t>(id), packet, i), is_self);
        if (!hn::AllFalse(d, found.mask)) is_done = take(id, hn::GetLane(found.value));
      }
    };
    for (const std::size_t duplicate : duplicates) {
      trace_up_to(std::min(duplicate, scene.sphere_count));
      id = duplicate + 1;
    }
    trace_up_to(scene.sphere_count);
    for (std::size_t rod = 0; rod < scene.rods.count && !is_done; ++rod) {
      const auto at = k::rod_at(d, scene.rods, rod, packet, i);
      if (hn::AllFalse(d, k::may_hit(ray, at)) || std::ranges::binary_search(duplicates, scene.rods.first_id + rod))
        continue;
      const auto entry = k::closest_entry<D, kPrecision>(d, ray, at);
      // Of a rod, the half that the ray enters has the opacity.
      const std::size_t hit = scene.rods.id(rod) + (hn::AllTrue(d, entry.second_half) ? 1u : 0u);
      if (!hn::AllFalse(d, entry.hits)) is_done = take(hit, hn::GetLane(entry.distance));
    }
  }
}

template <kernel::Precision kPrecision>
kernel::Tracer list_instance() {
  using T = std::conditional_t<kPrecision == kernel::Precision::kFast, float, double>;
  kernel::Tracer t;
  using Rays = kernel::RayPacket<T>;
  using ShadowRays = kernel::ShadowPacket<T>;
  t.trace = kernel::query_each<Rays, trace_list<Rays, kPrecision>>;
  t.occlude = kernel::query_each<ShadowRays, trace_list<ShadowRays, kPrecision>>;
  t.target = HWY_TARGET;
  return t;
}

kernel::Tracer list_tracer(kernel::Precision precision) {
  using enum kernel::Precision;
  switch (precision) {
    case kExact: return list_instance<kExact>();
    case kFast: return list_instance<kFast>();
    case kBook: return list_instance<kBook>();
  }
  return {};
}

}  // namespace orrery::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
