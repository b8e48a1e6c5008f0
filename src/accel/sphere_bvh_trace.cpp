// SPDX-License-Identifier: Apache-2.0
// Embree's callbacks for a BVH of many spheres, which is one primitive. Compiled once per instruction set.
#include <algorithm>
#include <limits>

#include "accel/embree_scene.h"
#include "accel/sphere_bvh.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "accel/sphere_bvh_trace.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target:
#include <hwy/highway.h>

#include "accel/shared_rays-inl.h"
#include "accel/single_rays-inl.h"
#include "math/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::accel::HWY_NAMESPACE {

/// Traces the valid rays of a packet.
///
/// `limits`   out: per lane, the distance beyond which nothing was searched
/// Result     lanes with a new hit, as bits
template <class Packet, kernel::Precision kPrecision>
HWY_INLINE unsigned trace_valid(const SphereBvh& bvh, const EmbreeQuery<Packet>& query, const int* valid, RTCRayN* rays,
                                float (&limits)[kWidth]) {
  const bool from_camera = query.packet->self[0] == kernel::kNoSphere;
  const Traversals& chosen = query.scene->traversals;
  if ((from_camera ? chosen.camera : chosen.secondary) == Traversal::kSingle)
    return trace_single<Packet, kPrecision>(bvh, query, valid, rays, limits);
  SharedRays<Packet, kPrecision> shared(bvh, query, valid, rays);
  const unsigned hits = shared.trace();
  std::copy_n(shared.limits(), kWidth, limits);
  return hits;
}

/// Traces a ray that Embree traverses alone, in its lane of an otherwise empty packet.
///
/// `limit`    out: the distance beyond which nothing was searched
/// Result     true if there is a new hit
template <class Packet, kernel::Precision kPrecision>
bool trace_alone(const SphereBvh& bvh, const EmbreeQuery<Packet>& query, RTCRayN* ray, float& limit) {
  const auto lane = static_cast<unsigned>(query.lane);
  EmbreeQuery<Packet> all = query;
  all.first -= query.lane;
  all.start[lane] = query.start[0];
  EmbreeShadowRays rays{};
  rays.org_x[lane] = RTCRayN_org_x(ray, 1, 0);
  rays.org_y[lane] = RTCRayN_org_y(ray, 1, 0);
  rays.org_z[lane] = RTCRayN_org_z(ray, 1, 0);
  rays.dir_x[lane] = RTCRayN_dir_x(ray, 1, 0);
  rays.dir_y[lane] = RTCRayN_dir_y(ray, 1, 0);
  rays.dir_z[lane] = RTCRayN_dir_z(ray, 1, 0);
  rays.tfar[lane] = RTCRayN_tfar(ray, 1, 0);
  alignas(64) int valid[kWidth] = {};
  valid[lane] = -1;
  float limits[kWidth];
  const unsigned hits = trace_valid<Packet, kPrecision>(bvh, all, valid, reinterpret_cast<RTCRayN*>(&rays), limits);
  limit = limits[lane];
  return (hits >> lane & 1u) != 0;
}

/// Embree's callback for closest hits.
template <class Packet, kernel::Precision kPrecision>
void intersect_bvh(const RTCIntersectFunctionNArguments* arguments) {
  const auto& query = *reinterpret_cast<const EmbreeQuery<Packet>*>(arguments->context);
  const auto& bvh = *static_cast<const SphereBvh*>(arguments->geometryUserPtr);
  RTCRayN* const rays = RTCRayHitN_RayN(arguments->rayhit, arguments->N);
  float limits[kWidth];
  const unsigned hits = arguments->N == 1
                            ? static_cast<unsigned>(trace_alone<Packet, kPrecision>(bvh, query, rays, limits[0]))
                            : trace_valid<Packet, kPrecision>(bvh, query, arguments->valid, rays, limits);
  for (unsigned i = 0; i < arguments->N; ++i) {
    const bool is_new = (hits >> i & 1u) != 0;
    arguments->valid[i] = is_new ? -1 : 0;
    if (is_new) RTCRayN_tfar(rays, arguments->N, i) = limits[i];
  }
}

/// Embree's callback for occlusion.
template <class Packet, kernel::Precision kPrecision>
void occluded_by_bvh(const RTCOccludedFunctionNArguments* arguments) {
  const auto& query = *reinterpret_cast<const EmbreeQuery<Packet>*>(arguments->context);
  const auto& bvh = *static_cast<const SphereBvh*>(arguments->geometryUserPtr);
  RTCRayN* const rays = arguments->ray;
  float limits[kWidth];
  const unsigned hits = arguments->N == 1
                            ? static_cast<unsigned>(trace_alone<Packet, kPrecision>(bvh, query, rays, limits[0]))
                            : trace_valid<Packet, kPrecision>(bvh, query, arguments->valid, rays, limits);
  for (unsigned i = 0; i < arguments->N; ++i)
    if ((hits >> i & 1u) != 0) RTCRayN_tfar(rays, arguments->N, i) = -std::numeric_limits<float>::infinity();
}

void set_bvh_functions(EmbreeFunctions& f, kernel::Precision precision) {
  using kernel::Precision, kernel::RayPacket, kernel::RayPacketFast, kernel::ShadowPacket, kernel::ShadowPacketFast;
  switch (precision) {
    case Precision::kExact:
      f.intersect_bvh = intersect_bvh<RayPacket, Precision::kExact>;
      f.occluded_by_bvh = occluded_by_bvh<ShadowPacket, Precision::kExact>;
      break;
    case Precision::kBook:
      f.intersect_bvh = intersect_bvh<RayPacket, Precision::kBook>;
      f.occluded_by_bvh = occluded_by_bvh<ShadowPacket, Precision::kBook>;
      break;
    case Precision::kFast:
      f.intersect_bvh = intersect_bvh<RayPacketFast, Precision::kFast>;
      f.occluded_by_bvh = occluded_by_bvh<ShadowPacketFast, Precision::kFast>;
      break;
  }
}

}  // namespace orrery::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace orrery::accel {

HWY_EXPORT(set_bvh_functions);

void add_bvh_functions(EmbreeFunctions& functions, kernel::Precision precision) {
  ORRERY_BEST(set_bvh_functions)(functions, precision);
}

}  // namespace orrery::accel
#endif
