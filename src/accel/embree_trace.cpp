// SPDX-License-Identifier: Apache-2.0
// Closest hits of packets by Embree, and its callback for each sphere. Compiled once per instruction set.
#include <algorithm>

#include "accel/embree_scene.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "accel/embree_trace.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target:
#include <hwy/highway.h>

#include "accel/embree_rays-inl.h"
#include "math/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::accel::HWY_NAMESPACE {

using EmbreeRays =
    std::conditional_t<kWidth == 16, RTCRayHit16, std::conditional_t<kWidth == 8, RTCRayHit8, RTCRayHit4>>;

/// Intersects rays, one per lane, with one sphere.
template <class D, kernel::Precision kPrecision>
HWY_INLINE void intersect_sphere(D d, const k::Rays<D>& ray, const k::Spheres<D>& sphere, std::uint32_t id,
                                 hn::Mask<D> lanes, ClosestHit<D>& closest) {
  const auto ids = hn::Set(k::IdTag<D>(), static_cast<hn::TFromD<k::IdTag<D>>>(id));
  const auto is_self = hn::RebindMask(d, ray.self == ids);
  closest.take(d, k::closest_distance<D, kPrecision>(d, ray, sphere, is_self), ids, lanes);
}

/// Embree's callback for one ray.
template <class Packet, kernel::Precision kPrecision, bool kMoves>
void intersect_single(const RTCIntersectFunctionNArguments* arguments, const EmbreeQuery<Packet>& query) {
  using D = hn::FixedTag<DistanceOf<Packet>, 1>;
  const D d;
  const EmbreeScene& scene = *query.scene;
  Packet& packet = *query.packet;
  const std::uint32_t id = scene.sphere_id(kMoves ? arguments->geomID : 0, arguments->primID);
  auto closest = ClosestHit<D>::load(d, packet, query.first);
  intersect_sphere<D, kPrecision>(d, k::load_rays(d, packet, query.first),
                                  k::sphere_at<kMoves>(d, scene, id, packet, query.first), id, hn::FirstN(d, 1),
                                  closest);
  if (hn::AllFalse(d, closest.is_new)) {
    arguments->valid[0] = 0;
    return;
  }
  closest.store(d, packet, query.first);
  const auto limit = far_limits(d, closest.distance, scene.frame.scale, hn::Load(d, query.start));
  RTCRayN_tfar(RTCRayHitN_RayN(arguments->rayhit, 1), 1, 0) = static_cast<float>(hn::GetLane(limit));
}

/// Embree's callback: intersects some rays of the query with one sphere.
template <class Packet, kernel::Precision kPrecision, bool kMoves>
void intersect(const RTCIntersectFunctionNArguments* arguments) {
  using T = DistanceOf<Packet>;
  using D = hn::ScalableTag<T>;
  const D d;
  const hn::Rebind<std::int32_t, D> di;
  auto& query = *reinterpret_cast<EmbreeQuery<Packet>*>(arguments->context);
  if (arguments->N == 1) return intersect_single<Packet, kPrecision, kMoves>(arguments, query);
  const EmbreeScene& scene = *query.scene;
  Packet& packet = *query.packet;
  const std::uint32_t id = scene.sphere_id(kMoves ? arguments->geomID : 0, arguments->primID);
  const int n = static_cast<int>(arguments->N), step = static_cast<int>(hn::Lanes(d));
  float* const to_limit = &RTCRayN_tfar(RTCRayHitN_RayN(arguments->rayhit, arguments->N), arguments->N, 0);
  for (int v = 0; v < n; v += step) {
    const auto flags = hn::LoadU(di, arguments->valid + v);
    if (hn::AllFalse(di, flags < hn::Zero(di))) continue;
    const auto valid = is_valid(d, flags);
    const int first = query.first + v;
    const auto ray = k::load_rays(d, packet, first);
    auto closest = ClosestHit<D>::load(d, packet, first);
    intersect_sphere<D, kPrecision>(d, ray, k::sphere_at<kMoves>(d, scene, id, packet, first), id, valid, closest);
    if (hn::AllFalse(d, closest.is_new)) {
      hn::StoreU(hn::Zero(di), di, arguments->valid + v);
      continue;
    }
    closest.store(d, packet, first);
    const auto limit = far_limits(d, closest.distance, scene.frame.scale, hn::Load(d, query.start + v));
    store_float_lanes(d, limit, closest.is_new, to_limit + v);
    hn::StoreU(flags_of(d, closest.is_new), di, arguments->valid + v);
  }
}

/// Traces rays of a packet one by one.
template <class Packet>
HWY_INLINE void trace_one_by_one(const int* valid, const EmbreeRays& rays, EmbreeQuery<Packet>& query) {
  const int first = query.first;
  alignas(64) DistanceOf<Packet> start[kWidth];
  std::copy_n(query.start, kWidth, start);
  RTCRayHit ray;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  for (int i = 0; i < kWidth; ++i) {
    if (valid[i] == 0) continue;
    ray.ray = one_ray(rays.ray, i);
    query.first = first + i;
    query.lane = i;
    query.start[0] = start[i];
    accel::intersect(query.scene->scene, query.context, ray);
  }
}

/// Traces a packet: the outliers, then the BVH.
template <class Packet, kernel::Precision kPrecision, bool kMoves>
void trace(const void* self, Packet& packet) {
  using T = DistanceOf<Packet>;
  using D = hn::ScalableTag<T>;
  const D d;
  const int step = static_cast<int>(hn::Lanes(d));
  const auto& scene = *static_cast<const EmbreeScene*>(self);
  for (int v = 0; !scene.outliers.empty() && v < packet.count; v += step) {
    const auto ray = k::load_rays(d, packet, v);
    const auto lanes = hn::FirstN(d, static_cast<std::size_t>(packet.count - v));
    auto closest = ClosestHit<D>::load(d, packet, v);
    for (const std::uint32_t id : scene.outliers)
      intersect_sphere<D, kPrecision>(d, ray, k::sphere_at<kMoves>(d, scene, id, packet, v), id, lanes, closest);
    closest.store(d, packet, v);
  }
  if (scene.scene == nullptr) return;
  const bool from_camera = packet.self[0] == kernel::kNoSphere;
  const Traversal traversal = from_camera ? scene.traversals.camera : scene.traversals.secondary;

  EmbreeQuery<Packet> query;
  init(query.context);
  query.scene = &scene;
  query.packet = &packet;
  EmbreeRays rays;
  set_constants(rays.ray);
  for (int i = 0; i < kWidth; ++i) {
    rays.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    rays.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  alignas(64) int valid[kWidth];
  for (int first = 0; first < packet.count; first += kWidth) {
    query.first = first;
    set_rays<true, kMoves>(query, rays.ray, valid);
    if (scene.by_packets(traversal)) {
      accel::intersect(valid, scene.scene, query.context, rays);
    } else {
      trace_one_by_one(valid, rays, query);
    }
  }
}

template <bool kMoves>
EmbreeFunctions instance(kernel::Precision precision) {
  using kernel::Precision, kernel::RayPacket, kernel::RayPacketFast;
  EmbreeFunctions f;
  f.tracer.target = HWY_TARGET;
  f.width = kWidth;
  switch (precision) {
    case Precision::kExact:
      f.intersect = intersect<RayPacket, Precision::kExact, kMoves>;
      f.tracer.trace = trace<RayPacket, Precision::kExact, kMoves>;
      break;
    case Precision::kBook:
      f.intersect = intersect<RayPacket, Precision::kBook, kMoves>;
      f.tracer.trace = trace<RayPacket, Precision::kBook, kMoves>;
      break;
    case Precision::kFast:
      f.intersect = intersect<RayPacketFast, Precision::kFast, kMoves>;
      f.tracer.trace_fast = trace<RayPacketFast, Precision::kFast, kMoves>;
      break;
  }
  return f;
}

EmbreeFunctions functions(kernel::Precision precision, bool moves) {
  return moves ? instance<true>(precision) : instance<false>(precision);
}

}  // namespace orrery::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace orrery::accel {

HWY_EXPORT(functions);

EmbreeFunctions embree_functions(kernel::Precision precision, bool moves) {
  EmbreeFunctions all = ORRERY_BEST(functions)(precision, moves);
  add_occlusion_functions(all, precision, moves);
  add_bvh_functions(all, precision);
  return all;
}

}  // namespace orrery::accel
#endif
