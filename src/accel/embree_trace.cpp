// SPDX-License-Identifier: Apache-2.0
// Queries of packets by Embree, and its callbacks.
//
// Closest hits and occlusion are the same functions: a packet's type says which of the two it is traced for.
#include <hwy/highway.h>

#include <algorithm>
#include <type_traits>

#include "accel/embree_scene.h"
#include "accel/packet_traversal-inl.h"
#include "accel/ray_traversal-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::accel::HWY_NAMESPACE {

template <class Packet>
using EmbreePacket = std::conditional_t<
    Packet::kIsShadow, EmbreeShadowRays,
    std::conditional_t<kWidth == 16, RTCRayHit16, std::conditional_t<kWidth == 8, RTCRayHit8, RTCRayHit4>>>;
template <class Packet>
using EmbreeRay = std::conditional_t<Packet::kIsShadow, RTCRay, RTCRayHit>;

/// The rays of an Embree packet or ray that may also have hits.
template <class Rays>
HWY_INLINE auto& rays_of(Rays& rays) {
  if constexpr (requires { rays.hit; }) {
    return rays.ray;
  } else {
    return rays;
  }
}

/// The rays that Embree passes to a callback.
HWY_INLINE RTCRayN* rays_of(const RTCIntersectFunctionNArguments& arguments) {
  return RTCRayHitN_RayN(arguments.rayhit, arguments.N);
}
HWY_INLINE RTCRayN* rays_of(const RTCOccludedFunctionNArguments& arguments) { return arguments.ray; }

/// Tests Embree's rays from `v` on against a primitive. D has one lane for a ray that Embree traverses alone.
///
/// `test`     called as test(d, packet, first, lanes, found) for rays of the packet from `first` on
template <class D, class Packet, class Arguments, class Test>
HWY_INLINE void test_primitive(D d, const EmbreeQuery<Packet>& query, const Arguments& arguments, int v, Test test) {
  const hn::Rebind<std::int32_t, D> di;
  const auto flags = hn::LoadU(di, arguments.valid + v);
  if (hn::AllFalse(di, flags < hn::Zero(di))) return;
  Packet& packet = *query.packet;
  const int first = query.first + v;
  auto found = Found<D, Packet>::load(d, packet, first);
  test(d, packet, first, is_valid(d, flags), found);
  // After an occlusion test, Embree ignores the flags.
  if (hn::AllFalse(d, found.is_new)) {
    if (!Packet::kIsShadow) hn::StoreU(hn::Zero(di), di, arguments.valid + v);
    return;
  }
  found.store(d, packet, first);
  store_float_lanes(d, found.limit(d, query, v), found.is_new, &RTCRayN_tfar(rays_of(arguments), arguments.N, 0) + v);
  if (!Packet::kIsShadow) hn::StoreU(flags_of(d, found.is_new), di, arguments.valid + v);
}

/// Tests all of Embree's rays against a primitive.
template <class Packet, class Arguments, class Test>
HWY_INLINE void test_all(const EmbreeQuery<Packet>& query, const Arguments& arguments, Test test) {
  using T = typename Packet::Number;
  if (arguments.N == 1) {
    test_primitive(hn::FixedTag<T, 1>(), query, arguments, 0, test);
    return;
  }
  const hn::ScalableTag<T> d;
  for (int v = 0; v < static_cast<int>(arguments.N); v += static_cast<int>(hn::Lanes(d)))
    test_primitive(d, query, arguments, v, test);
}

/// Embree's callback for a sphere that is a primitive.
template <class Packet, kernel::Precision kPrecision, class Arguments>
void at_sphere(const Arguments* arguments) {
  const auto& query = *reinterpret_cast<const EmbreeQuery<Packet>*>(arguments->context);
  const std::uint32_t id = query.scene->sphere_id(arguments->geomID, arguments->primID);
  const auto test_all_with = [&](auto is_plain) {
    // Captured by value: the compiler would read a reference again after each store.
    test_all(query, *arguments,
             [id, &scene = *query.scene](auto d, const Packet& packet, int first, auto lanes, auto& found) {
               intersect_sphere<kPrecision, decltype(is_plain)::value>(
                   d, scene, packet, first, k::load_rays(d, packet, first), id, lanes, found);
             });
  };
  query.scene->is_plain() ? test_all_with(std::true_type()) : test_all_with(std::false_type());
}

/// Embree's callback for a part of a rod.
template <class Packet, kernel::Precision kPrecision, class Arguments>
void at_rod(const Arguments* arguments) {
  const auto& query = *reinterpret_cast<const EmbreeQuery<Packet>*>(arguments->context);
  const std::size_t rod = query.scene->rod_pieces[arguments->primID].rod;
  const auto test = [rod, &scene = *query.scene](auto d, const Packet& packet, int first, auto lanes, auto& found) {
    intersect_rod<kPrecision>(d, scene, packet, first, k::load_rays(d, packet, first), rod, lanes, found);
  };
  test_all(query, *arguments, test);
}

/// Embree's callback for a SphereBvh. Rays that are traced each on their own have been through it: see trace().
template <class Packet, kernel::Precision kPrecision, class Arguments>
void at_bvh(const Arguments* arguments) {
  const auto& query = *reinterpret_cast<const EmbreeQuery<Packet>*>(arguments->context);
  RTCRayN* const rays = rays_of(*arguments);
  unsigned hits = 0;  // lanes with a new hit, as bits
  float limits[kWidth];
  if (query.traversal == Traversal::kPacket)
    hits = PacketTraversal<Packet, kPrecision>(*query.scene->bvh, query, arguments->valid, rays).trace(limits);
  for (unsigned i = 0; i < arguments->N; ++i) {
    const bool is_new = (hits >> i & 1u) != 0;
    if (!Packet::kIsShadow) arguments->valid[i] = is_new ? -1 : 0;
    if (is_new) RTCRayN_tfar(rays, arguments->N, i) = limits[i];
  }
}

/// Traces the valid rays of an Embree packet one by one.
template <class Packet>
HWY_INLINE void trace_one_by_one(const int* valid, EmbreePacket<Packet>& rays, EmbreeQuery<Packet>& query) {
  const int first = query.first;
  alignas(64) typename Packet::Number start[kWidth];
  std::copy_n(query.start, kWidth, start);
  EmbreeRay<Packet> ray;
  reset_hits(ray);
  for (int i = 0; i < kWidth; ++i) {
    if (valid[i] == 0) continue;
    rays_of(ray) = rtcGetRayFromRayN(reinterpret_cast<RTCRayN*>(&rays_of(rays)), kWidth, static_cast<unsigned>(i));
    query.first = first + i;
    query.start[0] = start[i];
    accel::query(query.scene->scene, query.context, ray);
  }
}

template <class Packet>
HWY_INLINE Traversal traversal_of(const Traversals& traversals, const Packet& packet) {
  const bool from_camera = !Packet::kIsShadow && packet.self[0] == kernel::kCamera;
  return from_camera ? traversals.camera : traversals.others;
}

/// Tests the rays of a packet against the outliers.
template <class Packet, kernel::Precision kPrecision, bool kPlain>
HWY_INLINE void test_outliers(const EmbreeScene& scene, Packet& packet) {
  const hn::ScalableTag<typename Packet::Number> d;
  using D = std::remove_const_t<decltype(d)>;
  for (int v = 0; v < packet.count && !scene.outliers.empty(); v += static_cast<int>(hn::Lanes(d))) {
    auto found = Found<D, Packet>::load(d, packet, v);
    const auto ray = k::load_rays(d, packet, v);
    const auto lanes = hn::FirstN(d, static_cast<std::size_t>(packet.count - v));
    for (const std::uint32_t id : scene.outliers)
      intersect_sphere<kPrecision, kPlain>(d, scene, packet, v, ray, id, lanes, found);
    found.store(d, packet, v);
  }
}

/// Traces a packet through Embree's scene.
template <class Packet>
HWY_INLINE void trace_embree(const EmbreeScene& scene, Traversal traversal, Packet& packet) {
  EmbreeQuery<Packet> query;
  init(query.context);
  query.scene = &scene;
  query.packet = &packet;
  query.traversal = traversal;
  EmbreePacket<Packet> rays;
  set_constants(rays_of(rays));
  reset_hits(rays);
  alignas(64) int valid[kWidth];
  for (int first = 0; first < packet.count; first += kWidth) {
    query.first = first;
    set_rays(query, rays_of(rays), valid);
    if (scene.by_packets(traversal)) {
      accel::query(valid, scene.scene, query.context, rays);
    } else {
      trace_one_by_one(valid, rays, query);
    }
  }
}

/// Traces packets: the outliers, then Embree's scene. Rays that are traced each on their own go through the SphereBvh
/// before, those of all packets at the same time.
///
/// `self`     TracedScene
template <class Packet, kernel::Precision kPrecision>
void trace(const void* self, void* memory, int count) {
  const auto& traced = *static_cast<const TracedScene*>(self);
  const EmbreeScene& scene = *traced.scene;
  auto* const packets = static_cast<Packet*>(memory);
  const bool is_plain = scene.is_plain();
  for (int i = 0; i < count; ++i) {
    Packet& packet = packets[i];
    if constexpr (Packet::kIsShadow) std::fill_n(packet.occluded, kernel::kPacketSize, 0);
    is_plain ? test_outliers<Packet, kPrecision, true>(scene, packet)
             : test_outliers<Packet, kPrecision, false>(scene, packet);
  }
  if (scene.scene == nullptr) return;

  const Traversal traversal = traversal_of(traced.traversals, packets[0]);
  const bool by_rays = scene.bvh != nullptr && traversal == Traversal::kSingle;
  if (by_rays) trace_by_rays<Packet, kPrecision>(scene, packets, count);
  for (int i = 0; i < count && !(by_rays && scene.is_bvh_alone); ++i) trace_embree(scene, traversal, packets[i]);
}

template <kernel::Precision kPrecision>
EmbreeFunctions instance() {
  using T = std::conditional_t<kPrecision == kernel::Precision::kFast, float, double>;
  using Rays = kernel::RayPacket<T>;
  using ShadowRays = kernel::ShadowPacket<T>;
  EmbreeFunctions f;
  f.width = kWidth;
  f.spheres = {at_sphere<Rays, kPrecision>, at_sphere<ShadowRays, kPrecision>};
  f.rods = {at_rod<Rays, kPrecision>, at_rod<ShadowRays, kPrecision>};
  f.bvh = {at_bvh<Rays, kPrecision>, at_bvh<ShadowRays, kPrecision>};
  f.tracer.trace = trace<Rays, kPrecision>;
  f.tracer.occlude = trace<ShadowRays, kPrecision>;
  f.tracer.target = HWY_TARGET;
  return f;
}

EmbreeFunctions embree_functions(kernel::Precision precision) {
  using enum kernel::Precision;
  return precision == kFast ? instance<kFast>() : instance<kExact>();
}

}  // namespace orrery::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
