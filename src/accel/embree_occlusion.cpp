// SPDX-License-Identifier: Apache-2.0
// Occlusion of packets by Embree, and its callback for each sphere. Compiled once per instruction set.
#include <algorithm>
#include <limits>
#include <type_traits>

#include "accel/embree_scene.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "accel/embree_occlusion.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target:
#include <hwy/highway.h>

#include "accel/embree_query.h"
#include "accel/embree_rays-inl.h"
#include "math/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::accel::HWY_NAMESPACE {

/// Tests lanes `first` .. of a packet against one sphere and stores which of them it occludes.
///
/// Result     the lanes that it occludes
template <class D, kernel::Precision kPrecision, bool kMoves, class Packet>
HWY_INLINE hn::Mask<D> occlude_by_sphere(D d, const EmbreeScene& scene, std::uint32_t id, Packet& packet, int first,
                                         hn::Mask<D> lanes) {
  const k::IdTag<D> du;
  const auto ids = hn::Set(du, static_cast<hn::TFromD<decltype(du)>>(id));
  const auto ray = k::load_rays(d, packet, first);
  const auto is_target = hn::RebindMask(d, hn::Load(du, packet.target + first) == ids);
  const auto found = k::closest_distance<D, kPrecision>(d, ray, k::sphere_at<kMoves>(d, scene, id, packet, first),
                                                        hn::RebindMask(d, ray.self == ids));
  const auto hits =
      hn::And(hn::And(hn::AndNot(is_target, lanes), found.mask), found.value < hn::Load(d, packet.distance + first));
  if (!hn::AllFalse(d, hits)) {
    const auto before = hn::Load(du, packet.occluded + first);
    hn::Store(hn::Or(before, hn::VecFromMask(du, hn::RebindMask(du, hits))), du, packet.occluded + first);
  }
  return hits;
}

/// Embree's callback: tests some rays of the query against one sphere.
template <class Packet, kernel::Precision kPrecision, bool kMoves>
void occluded(const RTCOccludedFunctionNArguments* arguments) {
  const auto& query = *reinterpret_cast<const EmbreeQuery<Packet>*>(arguments->context);
  const EmbreeScene& scene = *query.scene;
  const std::uint32_t id = scene.sphere_id(kMoves ? arguments->geomID : 0, arguments->primID);
  float* const limits = &RTCRayN_tfar(arguments->ray, arguments->N, 0);
  constexpr float kOccluded = -std::numeric_limits<float>::infinity();
  if (arguments->N == 1) {
    const hn::FixedTag<DistanceOf<Packet>, 1> d;
    const auto hit = occlude_by_sphere<std::remove_const_t<decltype(d)>, kPrecision, kMoves>(
        d, scene, id, *query.packet, query.first, hn::FirstN(d, 1));
    if (!hn::AllFalse(d, hit)) *limits = kOccluded;
    return;
  }
  const hn::ScalableTag<DistanceOf<Packet>> d;
  const hn::Rebind<std::int32_t, std::remove_const_t<decltype(d)>> di;
  for (int v = 0; v < static_cast<int>(arguments->N); v += static_cast<int>(hn::Lanes(d))) {
    const auto flags = hn::LoadU(di, arguments->valid + v);
    if (hn::AllFalse(di, flags < hn::Zero(di))) continue;
    const auto valid = is_valid(d, flags);
    const auto hits = occlude_by_sphere<std::remove_const_t<decltype(d)>, kPrecision, kMoves>(
        d, scene, id, *query.packet, query.first + v, valid);
    store_float_lanes(d, hn::Set(d, kOccluded), hits, limits + v);
  }
}

/// Tests a packet: the outliers, then the BVH for the rays that are not yet occluded.
template <class Packet, kernel::Precision kPrecision, bool kMoves>
void occlude(const void* self, Packet& packet) {
  using D = hn::ScalableTag<DistanceOf<Packet>>;
  const D d;
  const auto& scene = *static_cast<const EmbreeScene*>(self);
  std::fill_n(packet.occluded, kernel::kPacketSize, 0);
  for (int v = 0; v < packet.count; v += static_cast<int>(hn::Lanes(d))) {
    const auto lanes = hn::FirstN(d, static_cast<std::size_t>(packet.count - v));
    for (const std::uint32_t id : scene.outliers)
      occlude_by_sphere<D, kPrecision, kMoves>(d, scene, id, packet, v, lanes);
  }
  if (scene.scene == nullptr) return;

  EmbreeQuery<Packet> query;
  init(query.context);
  query.scene = &scene;
  query.packet = &packet;
  EmbreeShadowRays rays;
  set_constants(rays);
  alignas(64) int valid[kWidth];
  for (int first = 0; first < packet.count; first += kWidth) {
    query.first = first;
    set_rays<false, kMoves>(query, rays, valid);
    for (int i = 0; i < kWidth; ++i)
      if (packet.occluded[first + i] != 0) valid[i] = 0;
    if (scene.by_packets(scene.traversals.secondary)) {
      accel::occluded(valid, scene.scene, query.context, rays);
      continue;
    }
    for (int i = 0; i < kWidth; ++i) {
      if (valid[i] == 0) continue;
      query.first = first + i;
      query.lane = i;
      RTCRay ray = one_ray(rays, i);
      accel::occluded(scene.scene, query.context, ray);
    }
  }
}

template <bool kMoves>
void set_functions(EmbreeFunctions& f, kernel::Precision precision) {
  using kernel::Precision, kernel::ShadowPacket, kernel::ShadowPacketFast;
  switch (precision) {
    case Precision::kExact:
      f.occluded = occluded<ShadowPacket, Precision::kExact, kMoves>;
      f.tracer.occlude = occlude<ShadowPacket, Precision::kExact, kMoves>;
      break;
    case Precision::kBook:
      f.occluded = occluded<ShadowPacket, Precision::kBook, kMoves>;
      f.tracer.occlude = occlude<ShadowPacket, Precision::kBook, kMoves>;
      break;
    case Precision::kFast:
      f.occluded = occluded<ShadowPacketFast, Precision::kFast, kMoves>;
      f.tracer.occlude_fast = occlude<ShadowPacketFast, Precision::kFast, kMoves>;
      break;
  }
}

void set_occlusion_functions(EmbreeFunctions& f, kernel::Precision precision, bool moves) {
  moves ? set_functions<true>(f, precision) : set_functions<false>(f, precision);
}

}  // namespace orrery::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace orrery::accel {

HWY_EXPORT(set_occlusion_functions);

void add_occlusion_functions(EmbreeFunctions& functions, kernel::Precision precision, bool moves) {
  ORRERY_BEST(set_occlusion_functions)(functions, precision, moves);
}

}  // namespace orrery::accel
#endif
