// SPDX-License-Identifier: Apache-2.0
// Traversal of a SphereBvh by single rays, those of up to four packets interleaved.
#if defined(ORRERY_ACCEL_RAY_TRAVERSAL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_ACCEL_RAY_TRAVERSAL_INL_H_
#undef ORRERY_ACCEL_RAY_TRAVERSAL_INL_H_
#else
#define ORRERY_ACCEL_RAY_TRAVERSAL_INL_H_
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "accel/ray_steps-inl.h"
#include "kernel/gather-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::accel::HWY_NAMESPACE {

/// Orders the candidates of a ray that are within its limit.
///
/// Result     whether there are any
HWY_INLINE bool order_candidates(SingleRay& ray) {
  const auto order = [&](auto d, int from, int to) {
    const hn::RebindToSigned<decltype(d)> di;
    const auto at = hn::LoadU(d, ray.at + from);
    const auto index = hn::Iota(di, from);
    const auto within = hn::And(hn::RebindMask(di, at <= ray.limit), index < ray.candidates);
    return store_chosen(di, keys_of<kMaxCandidates>(d, at, index), within, ray.keys + to);
  };
  int count = 0;
  if (ray.candidates <= 4) {
    count = order(hn::FixedTag<float, 4>(), 0, 0);
  } else {
    for (int v = 0; v < ray.candidates; v += kChildLanes) count += order(ChildTag(), v, count);
  }
  if (count > 1) sort_keys(ray.keys, count);
  ray.key_count = count;
  ray.candidates = 0;
  return count > 0;
}

/// Intersects the candidates of rays, which are lanes of the query, and stores the results in the packet.
template <class Packet, kernel::Precision kPrecision>
HWY_INLINE void intersect_candidates(const EmbreeQuery<Packet>& query, unsigned lanes, SingleRay* rays) {
  using Id = typename Packet::Id;
  const hn::ScalableTag<typename Packet::Number> d;
  using D = std::remove_const_t<decltype(d)>;
  const k::IdTag<D> du;
  constexpr int kStep = static_cast<int>(hn::MaxLanes(D()));
  Packet& packet = *query.packet;
  const EmbreeScene& scene = *query.scene;
  const kernel::RodArray& rods = scene.rods;
  unsigned waiting = 0;
  for (const int i : SetBits(lanes)) waiting |= order_candidates(rays[i]) ? 1u << i : 0u;
  for (int v = 0; v < kWidth; v += kStep) {
    unsigned rest = waiting & (((1u << kStep) - 1u) << v);
    if (rest == 0) continue;
    const int first = query.first + v;
    const auto ray = k::load_rays(d, packet, first);
    auto found = Found<D, Packet>::load(d, packet, first);
    while (rest != 0) {
      HWY_ALIGN Id ids[kStep];
      hn::Store(set(du, kernel::kNone), du, ids);
      unsigned now = 0;
      for (const int i : SetBits(rest)) {
        SingleRay& one = rays[i];
        const auto next = static_cast<unsigned>(one.keys[--one.key_count]) & (kMaxCandidates - 1);
        // If this one is beyond the limit, so are the others.
        const bool within = one.at[next] <= one.limit;
        if (within) ids[i - v] = one.candidate[next];
        now |= within ? 1u << i : 0u;
        rest &= within && one.key_count > 0 ? ~0u : ~(1u << i);
      }
      if (now == 0) break;
      const auto found_ids = hn::Load(du, ids);
      const auto active = hn::RebindMask(d, found_ids != kernel::kNone);
      const Id any = ids[static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(now)) - v];
      found.is_new = hn::FirstN(d, 0);
      auto at_spheres = active;
      if (!rods.empty()) {
        at_spheres = hn::RebindMask(d, found_ids < set(du, rods.first_id));
        const auto at_rods = hn::AndNot(at_spheres, active);
        if (!hn::AllFalse(d, at_rods)) {
          const Id any_rod = ids[hn::FindKnownFirstTrue(d, at_rods)];
          const auto rod = k::gather_rods(
              d, rods, [&](std::size_t i) { return rods.index(rods.contains(ids[i]) ? ids[i] : any_rod); });
          intersect_rods<kPrecision>(d, scene, packet, first, ray, rod, found_ids, at_rods, found);
        }
      }
      if (!hn::AllFalse(d, at_spheres)) {
        hn::Vec<D> row[4];
        const Id other = rods.contains(any) ? 0 : any;
        k::gather_spheres(
            d, scene.spheres,
            [&](std::size_t i) { return ids[i] == kernel::kNone || rods.contains(ids[i]) ? other : ids[i]; }, row);
        const k::Spheres<D> sphere{{row[0], row[1], row[2]}, row[3]};
        intersect<kPrecision>(d, ray, sphere, found_ids, at_spheres, found);
      }
      const unsigned hits = bits_of(d, found.is_new);
      if (hits == 0) continue;
      alignas(64) float limits[kWidth];
      store_float(d, found.limit(d, query, v), limits);
      for (const int i : SetBits(hits)) rays[v + i].limit = limits[i];
      if (Packet::kIsShadow) rest &= ~(hits << v);
    }
    found.store(d, packet, first);
  }
}

/// The rays of a query of packets, one for each bit of a word.
constexpr int kMostRays = kernel::kPacketsInFlight * kernel::kPacketSize;
static_assert(kMostRays <= 64 && kMostRays % kWidth == 0);

/// Traces rays through the tree in rounds of one step per ray, so that the memory latency of one ray is hidden by the
/// others. Candidate spheres are intersected at the end.
///
/// `queries`  kWidth rays each
/// `lanes`    which rays there are, as bits
template <class Packet, kernel::Precision kPrecision>
HWY_INLINE void trace_rays(const SphereBvh& bvh, const EmbreeQuery<Packet>* queries, std::uint64_t lanes,
                           SingleRay* rays) {
  const EmbreeScene& scene = *queries->scene;
  const bool has_opacity = scene.opacity != nullptr;
  const Prefetcher prefetcher(bvh, scene);
  const auto intersect_all = [&] {
    for (int i = 0; i < kMostRays; i += kWidth) {
      const auto of_query = static_cast<unsigned>(lanes >> i) & ((1u << kWidth) - 1u);
      if (of_query != 0) intersect_candidates<Packet, kPrecision>(queries[i / kWidth], of_query, rays + i);
    }
  };
  std::uint64_t active = lanes;
  // A round is divided into passes over the rays, arithmetic without branches first: a mispredicted branch would
  // discard the arithmetic of the next rays, which is already in flight.
  while (true) {
    std::uint64_t at_leaves = 0, at_ends = 0;
    for (const int i : SetBits(active)) {
      const std::uint32_t next = next_visit(rays[i]);
      at_leaves |= std::uint64_t{(next >> kIndexWidth & kLeaf) != 0} << i;
      at_ends |= std::uint64_t{(next >> kIndexWidth & kEnd) != 0} << i;
      prefetcher.prefetch(next);
    }
    const std::uint64_t at_nodes = active & ~(at_leaves | at_ends);
    for (const int i : SetBits(at_ends)) at_ends &= ~(std::uint64_t{is_done(bvh, rays[i])} << i);
    active = at_nodes | at_leaves | at_ends;
    if (active == 0) break;
    for (const int i : SetBits(at_nodes)) test_children(bvh.nodes[rays[i].what[--rays[i].waiting]], rays[i]);
    for (const int i : SetBits(at_ends)) climb(bvh, rays[i]);
    for (const int i : SetBits(at_nodes | at_ends)) push_children(rays[i]);

    bool full = false;
    std::uint64_t found = 0;
    for (const int i : SetBits(at_leaves)) {
      SingleRay& ray = rays[i];
      const std::uint32_t leaf = ray.what[--ray.waiting] & kIndexMask;
      bool any = test_spheres<Packet::kIsShadow>(bvh, leaf, ray);
      if (has_opacity) any = any && keep_visible(bvh, leaf, scene.opacity, ray);
      found |= std::uint64_t{any} << i;
    }
    for (const int i : SetBits(found)) {
      SingleRay& ray = rays[i];
      add_candidates(bvh, ray.what[ray.waiting] & kIndexMask, has_opacity, ray);
      full = full || ray.candidates > kMaxCandidates - static_cast<int>(SphereBvh::kArity);
      prefetcher.prefetch_candidate(ray.candidate[ray.candidates - 1]);
    }
    if (full) intersect_all();
  }
  intersect_all();
}

/// The spheres that rays leave outwards, one per lane; kNone for other rays. A ray cannot hit such a sphere, see
/// kernel::closest_distance().
template <class Packet>
HWY_INLINE void set_left_spheres(const EmbreeQuery<Packet>& query, typename Packet::Id* left) {
  const hn::ScalableTag<typename Packet::Number> d;
  const k::IdTag<std::remove_const_t<decltype(d)>> du;
  const auto none = set(du, kernel::kNone);
  const kernel::RodArray& rods = query.scene->rods;
  for (int v = 0; v < kWidth; v += static_cast<int>(hn::Lanes(d))) {
    const auto ray = k::load_rays(d, *query.packet, query.first + v);
    auto outwards = dot(ray.direction, ray.offset) >= 0;
    if (!rods.empty()) outwards = hn::And(outwards, hn::RebindMask(d, ray.self < set(du, rods.first_id)));
    hn::Store(select(hn::RebindMask(du, outwards), ray.self, none), du, left + v);
  }
}

/// Starts the rays of a query.
///
/// `rays`     out: one per lane
/// Result     lanes that have a ray, as bits
template <class Packet>
HWY_INLINE unsigned start_rays(const SphereBvh& bvh, EmbreeQuery<Packet>& query, SingleRay* rays) {
  const hn::ScalableTag<float> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  const Packet& packet = *query.packet;
  EmbreeShadowRays embree;
  alignas(64) int valid[kWidth];
  set_rays(query, embree, valid);
  alignas(64) typename Packet::Id left[kWidth];
  set_left_spheres(query, left);
  const float *const origin[3] = {embree.org_x, embree.org_y, embree.org_z}, *const direction[3] = {embree.dir_x,
                                                                                                    embree.dir_y,
                                                                                                    embree.dir_z};
  alignas(64) float inverse[3][kWidth];
  alignas(64) std::uint32_t near[3][kWidth];
  for (int k = 0; k < 3; ++k) {
    const auto x = hn::Load(d, direction[k]);
    const auto one_over = 1.0F / hn::CopySign(max(hn::Abs(x), kSmallestDirection), x);
    hn::Store(one_over, d, inverse[k]);
    hn::Store(hn::IfThenElseZero(hn::RebindMask(du, one_over < 0), hn::Set(du, kOtherSide)), du, near[k]);
  }
  unsigned lanes = 0;
  for (int i = 0; i < kWidth; ++i) lanes |= valid[i] != 0 ? 1u << i : 0u;
  for (const int i : SetBits(lanes)) {
    SingleRay& ray = rays[i];
    const int lane = query.first + i;
    for (int k = 0; k < 3; ++k) {
      ray.origin[k] = origin[k][i];
      ray.direction[k] = direction[k][i];
      ray.inverse[k] = inverse[k][i];
      ray.near[k] = near[k][i];
    }
    ray.origin[3] = ray.direction[3] = 0;
    ray.limit = embree.tfar[i];
    ray.left = static_cast<std::uint32_t>(left[i]);
    if constexpr (Packet::kIsShadow) ray.target = static_cast<std::uint32_t>(packet.target[lane]);
    if (query.scene->opacity != nullptr) ray.key = packet.key[lane];
    ray.candidates = 0;
    ray.candidate[0] = 0;
    ray.enter[0] = -std::numeric_limits<float>::infinity();  // never beyond the limit
    ray.what[0] = kEndOfStack;
    ray.enter[1] = 0;
    ray.subtree = bvh.start_node(query.scene->rods.object(static_cast<std::uint32_t>(packet.self[lane])));
    ray.subtree_level = 0;
    if (ray.subtree == kernel::kNone) ray.subtree = bvh.root();
    ray.what[1] = ray.subtree;
    ray.waiting = 2;
  }
  return lanes;
}

/// Traces the rays of packets, each on its own.
template <class Packet, kernel::Precision kPrecision>
HWY_NOINLINE void trace_by_rays(const EmbreeScene& scene, Packet* packets, int count) {
  const SphereBvh& bvh = *scene.bvh;
  const std::size_t objects = bvh.start_nodes.size();
  for (int p = 0; p < count; ++p) {
    for (int i = 0; i < packets[p].count; ++i) {
      const std::size_t self = scene.rods.object(static_cast<std::uint32_t>(packets[p].self[i]));
      hwy::Prefetch(bvh.start_nodes.address(self < objects ? self : 0));
    }
  }
  EmbreeQuery<Packet> queries[kMostRays / kWidth];
  SingleRay rays[kMostRays];
  std::uint64_t lanes = 0;
  for (int i = 0; i < count * kernel::kPacketSize; i += kWidth) {
    EmbreeQuery<Packet>& query = queries[i / kWidth];
    query.scene = &scene;
    query.packet = packets + i / kernel::kPacketSize;
    query.first = i % kernel::kPacketSize;
    lanes |= std::uint64_t{start_rays(bvh, query, rays + i)} << i;
  }
  trace_rays<Packet, kPrecision>(bvh, queries, lanes, rays);
}

}  // namespace orrery::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
