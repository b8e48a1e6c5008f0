// SPDX-License-Identifier: Apache-2.0
// Packets through Embree, and the callback that Embree makes for each sphere. Compiled once per instruction set.
#include <cstddef>
#include <limits>

#include "accel/embree_scene.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "accel/embree_trace.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target:
#include <hwy/highway.h>

#include "accel/box_ray-inl.h"
#include "kernel/intersect-inl.h"
#include "math/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::accel::HWY_NAMESPACE {

// Rays that Embree takes at a time: as many floats as a register holds.
constexpr int kWidth = static_cast<int>(hn::MaxLanes(hn::ScalableTag<float>()));
using EmbreeRays = std::conditional_t<kWidth == 16, RTCRayHit16, std::conditional_t<kWidth == 8, RTCRayHit8, RTCRayHit4>>;

template <class Packet>
using DistanceOf = std::remove_cvref_t<decltype(Packet::distance[0])>;

/// Keeps the nearer of the known hit and this sphere's, lane by lane; of two at the same place the smaller id.
///
/// Result     lanes whose hit is new
template <class D, kernel::Precision kPrecision, class Packet>
HWY_INLINE hn::Mask<D> keep_nearest(D d, const kernel::Sphere& sphere, std::uint32_t id, hn::Mask<D> lanes, Packet& packet,
                                    int first) {
  const k::IdTag<D> du;
  using Id = hn::TFromD<k::IdTag<D>>;
  const auto ray = k::load_rays(d, packet, first);
  const auto ids = hn::Set(du, static_cast<Id>(id));
  const auto is_self = hn::RebindMask(d, ray.self == ids);
  const auto found = k::nearest<D, kPrecision>(d, ray, k::broadcast(d, sphere), is_self);
  const auto best = hn::Load(d, packet.distance + first);
  const auto best_ids = hn::Load(du, packet.hit + first);
  const auto same_place = hn::And(found.value == best, hn::RebindMask(d, best_ids > ids));
  const auto nearer = hn::And(hn::And(lanes, found.mask), hn::Or(found.value < best, same_place));
  if (hn::AllFalse(d, nearer)) return nearer;
  hn::Store(hn::IfThenElse(nearer, found.value, best), d, packet.distance + first);
  hn::Store(hn::IfThenElse(hn::RebindMask(du, nearer), ids, best_ids), du, packet.hit + first);
  return nearer;
}

/// A distance along a ray as Embree's far limit: never below what the double says, so that boxes of other spheres at
/// the same place are still entered.
HWY_INLINE float far_limit(double distance, double scale, double start) {
  const double at = distance * scale;
  return static_cast<float>((at * (1 + 0x1p-50) - start) * (1 + 0x1p-20)) + std::numeric_limits<float>::min();
}

/// Embree's callback: some rays of the query against one sphere.
template <class Packet, kernel::Precision kPrecision>
void intersect(const RTCIntersectFunctionNArguments* arguments) {
  using T = DistanceOf<Packet>;
  using D = hn::ScalableTag<T>;
  const D d;
  const hn::Rebind<std::int32_t, D> di;
  auto& query = *reinterpret_cast<EmbreeQuery<Packet>*>(arguments->context);
  const EmbreeScene& scene = *query.scene;
  Packet& packet = *query.packet;
  const std::uint32_t id = scene.sphere_id(arguments->primID);
  const int n = static_cast<int>(arguments->N), step = static_cast<int>(hn::Lanes(d));
  float* const far_limits = &RTCRayN_tfar(RTCRayHitN_RayN(arguments->rayhit, arguments->N), arguments->N, 0);
  for (int v = 0; v < n; v += step) {
    const auto valid_int = hn::LoadU(di, arguments->valid + v);
    if (hn::AllFalse(di, valid_int < hn::Zero(di))) continue;
    hn::Mask<D> valid;
    if constexpr (sizeof(T) == 8) {
      valid = hn::RebindMask(d, hn::PromoteTo(hn::RebindToSigned<D>(), valid_int) <
                                    hn::Zero(hn::RebindToSigned<D>()));
    } else {
      valid = hn::RebindMask(d, valid_int < hn::Zero(di));
    }
    const int first = query.first + v;
    const auto hit =
        keep_nearest<D, kPrecision>(d, scene.spheres[id], id, valid, packet, first);
    HWY_ALIGN T is_hit[hn::MaxLanes(d)];
    hn::Store(hn::IfThenElseZero(hit, hn::Set(d, T(1))), d, is_hit);
    for (int i = 0; i < step; ++i) {
      const bool lane_hit = is_hit[i] != T(0);
      if (lane_hit)
        far_limits[v + i] = far_limit(static_cast<double>(packet.distance[first + i]), scene.frame.scale, query.start[v + i]);
      arguments->valid[v + i] = lane_hit ? -1 : 0;
    }
  }
}

/// Traces a packet: the spheres that stand apart, then the hierarchy.
template <class Packet, kernel::Precision kPrecision>
void trace(const void* self, Packet& packet) {
  using T = DistanceOf<Packet>;
  using D = hn::ScalableTag<T>;
  const D d;
  const hn::Rebind<float, D> df;
  const int step = static_cast<int>(hn::Lanes(d));
  const auto& scene = *static_cast<const EmbreeScene*>(self);
  for (const std::uint32_t id : scene.apart)
    for (int v = 0; v < packet.count; v += step)
      keep_nearest<D, kPrecision>(d, scene.spheres[id], id, hn::FirstN(d, static_cast<std::size_t>(packet.count - v)),
                                            packet, v);
  if (scene.scene == nullptr) return;

  EmbreeQuery<Packet> query;
  init(query.context);
  query.scene = &scene;
  query.packet = &packet;
  EmbreeRays rays;
  alignas(64) int valid[kWidth];
  for (int first = 0; first < packet.count; first += kWidth) {
    query.first = first;
    for (int v = 0; v < kWidth; v += step) {
      const auto ray = k::load_rays(d, packet, first + v);
      const auto box = to_box_space(d, ray, scene.frame);
      const auto store = [&](hn::Vec<D> value, float* to) {
        if constexpr (sizeof(T) == 8) {
          hn::StoreU(hn::DemoteTo(df, value), df, to + v);
        } else {
          hn::StoreU(value, df, to + v);
        }
      };
      store(box.origin.x, rays.ray.org_x);
      store(box.origin.y, rays.ray.org_y);
      store(box.origin.z, rays.ray.org_z);
      store(ray.direction.x, rays.ray.dir_x);
      store(ray.direction.y, rays.ray.dir_y);
      store(ray.direction.z, rays.ray.dir_z);
      HWY_ALIGN T start[hn::MaxLanes(d)];
      HWY_ALIGN T reaches[hn::MaxLanes(d)];
      hn::Store(box.start, d, start);
      hn::Store(hn::IfThenElseZero(box.reaches, hn::Set(d, T(1))), d, reaches);
      for (int i = 0; i < step; ++i) {
        const int lane = v + i;
        query.start[lane] = static_cast<double>(start[i]);
        const auto known = packet.distance[first + lane];
        const bool none = packet.hit[first + lane] == kernel::kNoSphere;
        rays.ray.tnear[lane] = 0;
        rays.ray.tfar[lane] = none ? std::numeric_limits<float>::infinity()
                                   : far_limit(static_cast<double>(known), scene.frame.scale, query.start[lane]);
        rays.ray.time[lane] = 0;
        rays.ray.mask[lane] = ~0u;
        rays.ray.id[lane] = static_cast<unsigned>(lane);
        rays.ray.flags[lane] = 0;
        rays.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
        rays.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
        // A known hit before the boxes begin leaves nothing to look for (and Embree wants no negative limit).
        valid[lane] = first + lane < packet.count && reaches[i] != T(0) && rays.ray.tfar[lane] > 0 ? -1 : 0;
      }
    }
    accel::intersect(valid, scene.scene, query.context, rays);
  }
}

void intersect_exact(const RTCIntersectFunctionNArguments* a) {
  intersect<kernel::RayPacket, kernel::Precision::kExact>(a);
}
void intersect_book(const RTCIntersectFunctionNArguments* a) {
  intersect<kernel::RayPacket, kernel::Precision::kBook>(a);
}
void intersect_fast(const RTCIntersectFunctionNArguments* a) {
  intersect<kernel::RayPacketFast, kernel::Precision::kFast>(a);
}
void trace_exact(const void* self, kernel::RayPacket& p) {
  trace<kernel::RayPacket, kernel::Precision::kExact>(self, p);
}
void trace_book(const void* self, kernel::RayPacket& p) {
  trace<kernel::RayPacket, kernel::Precision::kBook>(self, p);
}
void trace_fast(const void* self, kernel::RayPacketFast& p) {
  trace<kernel::RayPacketFast, kernel::Precision::kFast>(self, p);
}

}  // namespace orrery::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace orrery::accel {

HWY_EXPORT(intersect_exact);
HWY_EXPORT(intersect_book);
HWY_EXPORT(intersect_fast);
HWY_EXPORT(trace_exact);
HWY_EXPORT(trace_book);
HWY_EXPORT(trace_fast);

EmbreeFunctions embree_functions(kernel::Precision precision) {
  EmbreeFunctions f;
  switch (precision) {
    case kernel::Precision::kExact:
      f.intersect = ORRERY_BEST(intersect_exact);
      f.trace = ORRERY_BEST(trace_exact);
      break;
    case kernel::Precision::kBook:
      f.intersect = ORRERY_BEST(intersect_book);
      f.trace = ORRERY_BEST(trace_book);
      break;
    case kernel::Precision::kFast:
      f.intersect = ORRERY_BEST(intersect_fast);
      f.trace_fast = ORRERY_BEST(trace_fast);
      break;
  }
  return f;
}

}  // namespace orrery::accel
#endif
