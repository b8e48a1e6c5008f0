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
  const auto& [scene, duplicates] = *static_cast<const DistinctSpheres*>(self);
  if constexpr (Packet::kIsShadow) std::fill_n(packet.occluded, kernel::kPacketSize, Id{0});
  for (int i = 0; i < packet.count; ++i) {
    const auto ray = k::load_rays(d, packet, i);
    // Of a rod, the half that the ray enters has the opacity.
    const auto is_visible = [&](std::size_t hit) {
      return scene.opacity == nullptr || packet.threshold[i] < scene.opacity[hit];
    };
    std::size_t id = 0;
    const auto trace_up_to = [&](std::size_t end) {
      for (; id < end; ++id) {
        // Compared as vectors: for a comparison of integers, GCC 12 reuses a register of the test before, for which the
        // next test then waits; with AVX-512, `fast` took 1.5 times as long.
        const auto is_self = hn::RebindMask(d, ray.self == hn::Set(k::IdTag<D>(), static_cast<Id>(id)));
        const auto found = k::closest_distance<D, kPrecision>(
            d, ray, k::sphere_at(d, scene, static_cast<std::uint32_t>(id), packet, i), is_self);
        if (hn::AllFalse(d, found.mask)) continue;
        const T distance = hn::GetLane(found.value);
        if (distance >= packet.distance[i]) continue;  // ids ascend, so at equal distance the smaller id was first
        if (!is_visible(id)) continue;
        if constexpr (Packet::kIsShadow) {
          if (packet.target[i] == id) continue;
          packet.occluded[i] = static_cast<Id>(~Id{0});
          return true;
        } else {
          packet.distance[i] = distance;
          packet.hit[i] = static_cast<Id>(id);
        }
      }
      return false;
    };
    bool is_occluded = false;
    for (const std::uint32_t duplicate : duplicates) {
      is_occluded = is_occluded || trace_up_to(duplicate);
      id = std::size_t{duplicate} + 1;
    }
    if (!is_occluded) is_occluded = trace_up_to(scene.sphere_count);
    for (std::size_t rod = 0; rod < scene.rods.count && !is_occluded; ++rod) {
      const auto at = k::rod_at(d, scene.rods, rod, packet, i);
      if (hn::AllFalse(d, k::may_hit(ray, at))) continue;
      const auto entry = k::closest_entry<D, kPrecision>(d, ray, at);
      if (hn::AllFalse(d, entry.hits) || hn::GetLane(entry.distance) >= packet.distance[i]) continue;
      const std::size_t hit = scene.rods.id(rod) + (hn::AllTrue(d, entry.second_half) ? 1u : 0u);
      if (!is_visible(hit)) continue;
      if constexpr (Packet::kIsShadow) {
        if (packet.target[i] == hit) continue;
        packet.occluded[i] = static_cast<Id>(~Id{0});
        is_occluded = true;
      } else {
        packet.distance[i] = hn::GetLane(entry.distance);
        packet.hit[i] = static_cast<Id>(hit);
      }
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
