// SPDX-License-Identifier: Apache-2.0
// Rays that traverse a SphereBvh each on its own way. Compiled once per instruction set.
#if defined(ORRERY_ACCEL_SINGLE_RAYS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_ACCEL_SINGLE_RAYS_INL_H_
#undef ORRERY_ACCEL_SINGLE_RAYS_INL_H_
#else
#define ORRERY_ACCEL_SINGLE_RAYS_INL_H_
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <type_traits>
#include <utility>

#include "accel/sphere_bvh_rays-inl.h"
#include "kernel/gather-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::accel::HWY_NAMESPACE {

/// A sphere that a ray may hit, and a lower bound of the distance there.
struct Candidate {
  float enter;
  std::uint32_t id;
};

/// A ray on its way through the tree, in box space.
struct SingleRay {
  float origin[3], direction[3], inverse[3];
  float limit;            ///< distance beyond which nothing is searched
  std::uint32_t near[3];  ///< per axis: which bound the ray enters a box at, 0 or 1
  std::uint32_t home;     ///< the node below which everything has been visited once the stack is empty
  unsigned home_level;
  int lane;        ///< of the query
  int waiting;     ///< entries of `enter` and `what`: the end of the stack, then the nearest last
  int candidates;  ///< number of `spheres`, nearest last
  Candidate spheres[kMaxCandidates];
  // Vectors are stored beyond the last entry.
  float enter[SphereBvh::kStackSize + SphereBvh::kArity];         ///< a lower bound of the distance there
  std::uint32_t what[SphereBvh::kStackSize + SphereBvh::kArity];  ///< references as SphereBvh::root()
};

/// A sort key: the distance at which a ray enters a child, not negative, rounded down, and the child's index.
constexpr std::uint32_t kIndexBits = SphereBvh::kArity - 1;

/// What a distance loses to become a key: the index's bits, and the sign, since a zero may be negative.
constexpr auto kNoKeyBits = static_cast<std::int32_t>(0x80000000u | kIndexBits);

/// Stores the keys of the children that a ray enters before its limit.
///
/// `except`   index of a child that is left out, or -1
/// Result     their number; up to a vector more is written
HWY_INLINE int entered(const SphereBvh::Node& node, const SingleRay& ray, int except, std::int32_t* keys) {
  const ChildTag d;
  const hn::RebindToSigned<ChildTag> di;
  hn::Vec<ChildTag> scale[3], shift[3];
  const std::uint8_t *near[3], *far[3];
  for (int k = 0; k < 3; ++k) {
    scale[k] = hn::Set(d, node.step[k] * ray.inverse[k]);
    shift[k] = hn::Set(d, (node.origin[k] - ray.origin[k]) * ray.inverse[k]);
    near[k] = node.bound[ray.near[k]][k];
    far[k] = node.bound[1 - ray.near[k]][k];
  }
  const auto zero = hn::Zero(d), limit = hn::Set(d, ray.limit);
  int count = 0;
  for (int v = 0; v < static_cast<int>(SphereBvh::kArity); v += kChildLanes) {
    const auto begin = hn::Max(hn::Max(hn::MulAdd(from_bytes(near[0] + v), scale[0], shift[0]),
                                       hn::MulAdd(from_bytes(near[1] + v), scale[1], shift[1])),
                               hn::Max(hn::MulAdd(from_bytes(near[2] + v), scale[2], shift[2]), zero));
    const auto end = hn::Min(hn::Min(hn::MulAdd(from_bytes(far[0] + v), scale[0], shift[0]),
                                     hn::MulAdd(from_bytes(far[1] + v), scale[1], shift[1])),
                             hn::Min(hn::MulAdd(from_bytes(far[2] + v), scale[2], shift[2]), limit));
    const auto index = hn::Iota(di, v);
    const auto hits =
        hn::And(hn::RebindMask(di, begin <= end),
                hn::AndNot(index == hn::Set(di, except), index < hn::Set(di, static_cast<int>(node.count))));
    const auto key = hn::Or(hn::AndNot(hn::Set(di, kNoKeyBits), hn::BitCast(di, begin)), index);
    hn::StoreU(hn::Compress(key, hits), di, keys + count);
    count += static_cast<int>(hn::CountTrue(di, hits));
  }
  return count;
}

/// Sorts four keys, largest first, by a network of three layers.
HWY_INLINE hn::Vec<hn::FixedTag<std::int32_t, 4>> sorted(hn::Vec<hn::FixedTag<std::int32_t, 4>> keys) {
  const hn::FixedTag<std::int32_t, 4> d;
  alignas(16) static constexpr std::int32_t kOdd[4] = {0, -1, 0, -1}, kUpper[4] = {0, 0, -1, -1},
                                            kMiddle[4] = {0, 2, 1, 3};
  const auto exchange = [&](auto other, const std::int32_t* to_min) {
    const auto lower = hn::Load(d, to_min) < hn::Zero(d);
    keys = hn::IfThenElse(lower, hn::Min(keys, other), hn::Max(keys, other));
  };
  exchange(hn::Shuffle2301(keys), kOdd);
  exchange(hn::Shuffle1032(keys), kUpper);
  exchange(hn::TableLookupLanes(keys, hn::SetTableIndices(d, kMiddle)), kUpper);
  return keys;
}

/// Visits a node: adds the children that the ray enters, but not child `except`, to its stack.
HWY_INLINE void visit_node(const SphereBvh::Node& node, SingleRay& ray, int except = -1) {
  const hn::FixedTag<std::int32_t, 4> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  alignas(64) std::int32_t keys[2 * SphereBvh::kArity];
  const int count = entered(node, ray, except, keys);
  const auto push = [&](hn::Vec<decltype(d)> four, int at) {
    const auto index = hn::BitCast(du, hn::And(four, hn::Set(d, static_cast<int>(kIndexBits))));
    hn::StoreU(
        hn::BitCast(hn::RebindToFloat<decltype(d)>(), hn::AndNot(hn::Set(d, static_cast<int>(kIndexBits)), four)),
        hn::RebindToFloat<decltype(d)>(), ray.enter + at);
    hn::StoreU(index + hn::Set(du, node.first), du, ray.what + at);
  };
  if (count > 4) {
    std::sort(keys, keys + count, std::greater<>());
    for (int i = 0; i < count; i += 4) push(hn::Load(d, keys + i), ray.waiting + i);
  } else {
    const auto four = hn::IfThenElse(hn::Iota(d, 0) < hn::Set(d, count), hn::Load(d, keys), hn::Set(d, -1));
    push(sorted(four), ray.waiting);
  }
  ray.waiting += count;
}

/// Whether a ray ends, at its limit, in the region that belongs to one node alone.
HWY_INLINE bool stays_in(const SphereBvh::Cell& cell, const SingleRay& ray) {
  bool inside = true;
  for (int k = 0; k < 3; ++k) {
    const float end = ray.origin[k] + ray.direction[k] * ray.limit;
    // False for an infinite limit, too.
    inside = inside & (std::min(ray.origin[k], end) >= cell.lower[k]) & (std::max(ray.origin[k], end) <= cell.upper[k]);
  }
  return inside;
}

/// Goes on above a ray's home, unless nothing there can be nearer.
///
/// Result     false if the ray is done
HWY_INLINE bool climb(const SphereBvh& bvh, SingleRay& ray) {
  if (ray.home == bvh.root() || ray.limit < 0 || stays_in(bvh.cells[ray.home], ray)) return false;
  const std::uint32_t in_level = ray.home - bvh.level_begin[ray.home_level];
  ray.home = bvh.level_begin[++ray.home_level] + in_level / SphereBvh::kArity;
  visit_node(bvh.nodes[ray.home], ray, static_cast<int>(in_level % SphereBvh::kArity));
  return true;
}

/// Finds the spheres of a leaf that a ray may hit before its limit, as bits, and lower bounds of the distances there.
/// Shortens the ray to spheres that it certainly hits.
///
/// `shortest`  hits nearer than this are not certain, box space
/// `target`    a sphere that is never hit
template <bool kShadows>
HWY_INLINE unsigned visit_leaf(const SphereBvh& bvh, std::uint32_t index, float shortest, std::uint32_t target,
                               SingleRay& ray, float* enter) {
  const ChildTag d;
  const SphereBvh::Leaf& leaf = bvh.leaves[index];
  const auto set = [&](float x) { return hn::Set(d, x); };
  const auto step = set(leaf.step);
  const auto margin = set(margin_of(bvh, leaf));
  const auto limit = set(ray.limit), zero = hn::Zero(d), growth = set(kGrowth);
  const auto dx = set(ray.direction[0]), dy = set(ray.direction[1]), dz = set(ray.direction[2]);
  const auto ox = set(leaf.origin[0] - ray.origin[0]), oy = set(leaf.origin[1] - ray.origin[1]),
             oz = set(leaf.origin[2] - ray.origin[2]);
  const std::uint32_t* const ids = &bvh.ids[std::size_t{index} * SphereBvh::kArity];
  const hn::RebindToUnsigned<ChildTag> du;
  const auto is_target = [&](int v) { return hn::RebindMask(d, hn::LoadU(du, ids + v) == hn::Set(du, target)); };
  const bool is_last = index == bvh.last_leaf;
  unsigned bits = 0;
  auto nearest = limit;
  for (int v = 0; v < static_cast<int>(SphereBvh::kArity); v += kChildLanes) {
    const auto x = hn::MulAdd(from_bytes(leaf.center[0] + v), step, ox);
    const auto y = hn::MulAdd(from_bytes(leaf.center[1] + v), step, oy);
    const auto z = hn::MulAdd(from_bytes(leaf.center[2] + v), step, oz);
    const auto along = hn::MulAdd(x, dx, hn::MulAdd(y, dy, z * dz));
    const auto px = hn::NegMulAdd(along, dx, x), py = hn::NegMulAdd(along, dy, y), pz = hn::NegMulAdd(along, dz, z);
    const auto offset_square = hn::MulAdd(px, px, hn::MulAdd(py, py, pz * pz)) * growth;
    const auto radii = radii_of(bvh, index, v);
    const auto outer = radii.most + margin, begin = along - outer;
    auto may_hit = hn::And(hn::And(offset_square <= outer * outer * growth, along + outer >= zero), begin <= limit);
    if (is_last)
      may_hit = hn::And(may_hit, hn::Iota(d, static_cast<float>(v)) < set(static_cast<float>(bvh.count_in(index))));
    if (kShadows) may_hit = hn::AndNot(is_target(v), may_hit);
    bits |= bits_of(d, may_hit) << v;
    hn::StoreU(begin, d, enter + v);
    const auto inner = radii.least - margin;
    const auto deep = hn::NegMulAdd(offset_square, growth, inner * inner);
    const auto pierced = hn::And(hn::And(may_hit, inner > zero), hn::And(deep > zero, begin > set(shortest)));
    const auto certain = ((along - hn::Sqrt(hn::Max(deep, zero))) + margin) * set(kLonger);
    nearest = hn::Min(nearest, hn::IfThenElse(pierced, certain, nearest));
  }
  ray.limit = hn::GetLane(hn::MinOfLanes(d, nearest));
  return bits;
}

/// Adds spheres of a leaf to the candidates of a ray.
HWY_INLINE void add_candidates(unsigned bits, const std::uint32_t* ids, const float* enter,
                               const kernel::SphereArray& spheres, SingleRay& ray) {
  for (; bits != 0; bits &= bits - 1) {
    const auto i = hwy::Num0BitsBelowLS1Bit_Nonzero32(bits);
    if (enter[i] > ray.limit) continue;
    prefetch_sphere(spheres, ids[i]);
    insert(ray.spheres, 0, ray.candidates, Candidate{enter[i], ids[i]});
  }
}

/// Intersects the candidates of rays, which are lanes of the query, and stores the results in the packet.
///
/// Result     lanes with a new hit, as bits
template <class Packet, kernel::Precision kPrecision>
HWY_INLINE unsigned intersect_candidates(const EmbreeQuery<Packet>& query, SingleRay* const (&ray_of)[kWidth]) {
  using D = hn::ScalableTag<DistanceOf<Packet>>;
  using Id = hn::TFromD<k::IdTag<D>>;
  const D d;
  constexpr bool kShadows = requires(Packet p) { p.occluded; };
  const k::IdTag<D> du;
  const int step = static_cast<int>(hn::Lanes(d));
  Packet& packet = *query.packet;
  const EmbreeScene& scene = *query.scene;
  unsigned changed = 0;
  for (int v = 0; v < kWidth; v += step) {
    const int first = query.first + v;
    HWY_ALIGN Id ids[hn::MaxLanes(D())];
    const auto next = [&] {
      bool any = false;
      for (int i = 0; i < step; ++i) {
        SingleRay* const ray = ray_of[v + i];
        ids[i] = kernel::kNoSphere;
        if (ray == nullptr || ray->candidates == 0) continue;
        const Candidate candidate = ray->spheres[--ray->candidates];
        if (candidate.enter > ray->limit) {
          ray->candidates = 0;  // the others are further away
          continue;
        }
        ids[i] = candidate.id;
        any = true;
      }
      return any;
    };
    if (!next()) continue;
    const auto ray = k::load_rays(d, packet, first);
    ClosestHit<D> nearest;
    if constexpr (!kShadows) nearest = ClosestHit<D>::load(d, packet, first);
    do {
      const auto spheres = hn::Load(du, ids);
      const auto active = hn::RebindMask(d, spheres != hn::Set(du, static_cast<Id>(kernel::kNoSphere)));
      hn::Vec<D> row[4];
      k::gather_spheres(
          d, scene.spheres, [&](std::size_t i) { return ids[i] == kernel::kNoSphere ? 0 : ids[i]; }, row);
      const k::Spheres<D> sphere{{row[0], row[1], row[2]}, row[3]};
      const auto found = k::nearest<D, kPrecision>(d, ray, sphere, hn::RebindMask(d, ray.self == spheres));
      unsigned hits = 0;
      if constexpr (kShadows) {
        hits = bits_of(d, hn::And(hn::And(found.mask, active), found.value < hn::Load(d, packet.distance + first)));
        for (unsigned rest = hits; rest != 0; rest &= rest - 1) {
          const int i = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(rest));
          packet.occluded[first + i] = static_cast<Id>(~Id{0});
          ray_of[v + i]->limit = -1;
          ray_of[v + i]->candidates = 0;
        }
      } else {
        nearest.is_new = hn::FirstN(d, 0);
        nearest.take(d, found, spheres, active);
        hits = bits_of(d, nearest.is_new);
        if (hits != 0) {
          alignas(64) float limits[hn::MaxLanes(hn::ScalableTag<float>())];
          store_float(d, far_limits(d, nearest.distance, scene.frame.scale, hn::Load(d, query.start + v)), limits);
          for (unsigned rest = hits; rest != 0; rest &= rest - 1) {
            const int i = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(rest));
            ray_of[v + i]->limit = limits[i];
          }
        }
      }
      changed |= hits << v;
    } while (next());
    if constexpr (!kShadows) nearest.store(d, packet, first);
  }
  return changed;
}

/// Traces rays through the tree in rounds, in which each ray takes one step: while one waits for memory, the others go
/// on. The spheres that they may hit are intersected at the end.
///
/// Result     lanes with a new hit, as bits
template <class Packet, kernel::Precision kPrecision>
HWY_INLINE unsigned trace_rays(const SphereBvh& bvh, const EmbreeQuery<Packet>& query,
                               SingleRay* const (&ray_of)[kWidth]) {
  constexpr bool kShadows = requires(Packet p) { p.occluded; };
  const EmbreeScene& scene = *query.scene;
  const float shortest = shortest_certain<kPrecision>(bvh, scene.frame);
  // Rays by what they visit next.
  SingleRay* queue[kKinds][kWidth];
  int queued[kKinds] = {0, 0, 0};
  const Prefetcher prefetcher(bvh);
  const auto enqueue = [&](SingleRay& ray) {
    int top = ray.waiting - 1;
    while (ray.enter[top] > ray.limit) --top;
    ray.waiting = top + 1;
    const std::uint32_t next = ray.what[top];
    const unsigned kind = next >> kIndexWidth;
    queue[kind][queued[kind]++] = &ray;
    prefetcher.prefetch(next);
  };
  for (int i = 0; i < kWidth; ++i)
    if (ray_of[i] != nullptr) enqueue(*ray_of[i]);
  unsigned changed = 0;
  // The arithmetic of all rays comes first, then what branches: a mispredicted branch would discard the next ray's
  // arithmetic, which has already begun.
  while (queued[kNode] + queued[kLeaf] + queued[kEnd] > 0) {
    SingleRay* now[kWidth];
    const auto take = [&](Kind kind) { return std::copy_n(queue[kind], kWidth, now), std::exchange(queued[kind], 0); };
    int count = take(kNode);
    for (int i = 0; i < count; ++i) visit_node(bvh.nodes[now[i]->what[--now[i]->waiting]], *now[i]);
    for (int i = 0; i < count; ++i) enqueue(*now[i]);

    count = take(kLeaf);
    alignas(64) float enter[kWidth][SphereBvh::kArity];
    unsigned bits[kWidth];
    std::uint32_t leaf[kWidth];
    for (int i = 0; i < count; ++i) {
      SingleRay& ray = *now[i];
      leaf[i] = ray.what[--ray.waiting] & kIndexMask;
      std::uint32_t target = kernel::kNoSphere;
      if constexpr (kShadows) target = static_cast<std::uint32_t>(query.packet->target[query.first + ray.lane]);
      bits[i] = visit_leaf<kShadows>(bvh, leaf[i], shortest, target, ray, enter[i]);
    }
    bool full = false;
    for (int i = 0; i < count; ++i) {
      add_candidates(bits[i], &bvh.ids[std::size_t{leaf[i]} * SphereBvh::kArity], enter[i], scene.spheres, *now[i]);
      full = full || now[i]->candidates > kMaxCandidates - static_cast<int>(SphereBvh::kArity);
      enqueue(*now[i]);
    }

    count = take(kEnd);
    for (int i = 0; i < count; ++i)
      if (climb(bvh, *now[i])) enqueue(*now[i]);
    if (full) changed |= intersect_candidates<Packet, kPrecision>(query, ray_of);
  }
  return changed | intersect_candidates<Packet, kPrecision>(query, ray_of);
}

/// Sets up a ray of Embree's packet.
HWY_INLINE void begin(SingleRay& ray, RTCRayN* rays, unsigned i, const SphereBvh& bvh, std::uint32_t self) {
  ray.origin[0] = RTCRayN_org_x(rays, kWidth, i);
  ray.origin[1] = RTCRayN_org_y(rays, kWidth, i);
  ray.origin[2] = RTCRayN_org_z(rays, kWidth, i);
  ray.direction[0] = RTCRayN_dir_x(rays, kWidth, i);
  ray.direction[1] = RTCRayN_dir_y(rays, kWidth, i);
  ray.direction[2] = RTCRayN_dir_z(rays, kWidth, i);
  ray.limit = RTCRayN_tfar(rays, kWidth, i);
  for (int k = 0; k < 3; ++k) {
    const float x = ray.direction[k];
    ray.near[k] = x < 0 ? 1 : 0;
    ray.inverse[k] = 1 / (x < 0 ? std::min(x, -kSmallestDirection) : std::max(x, kSmallestDirection));
  }
  ray.lane = static_cast<int>(i);
  ray.candidates = 0;
  ray.enter[0] = -std::numeric_limits<float>::infinity();  // never beyond the limit
  ray.what[0] = kEndOfStack;
  ray.enter[1] = 0;
  ray.home = bvh.home_of(self);
  ray.home_level = 0;
  if (ray.home == kernel::kNoSphere) ray.home = bvh.root();
  ray.what[1] = ray.home;
  ray.waiting = 2;
}

/// Traces the valid rays of Embree's packet, each on its own way.
///
/// `limits`   out: by lane, distances beyond which nothing was searched
/// Result     lanes with a new hit, as bits
template <class Packet, kernel::Precision kPrecision>
HWY_INLINE unsigned trace_single(const SphereBvh& bvh, const EmbreeQuery<Packet>& query, const int* valid,
                                 RTCRayN* rays, float (&limits)[kWidth]) {
  SingleRay states[kWidth];
  SingleRay* ray_of[kWidth] = {};
  int count = 0;
  const auto self = [&](unsigned i) {
    return static_cast<std::uint32_t>(query.packet->self[query.first + static_cast<int>(i)]);
  };
  for (unsigned i = 0; i < kWidth; ++i) hwy::Prefetch(&bvh.places[self(i) < bvh.places.size() ? self(i) : 0]);
  for (unsigned i = 0; i < kWidth; ++i) {
    if (valid[i] == 0) continue;
    ray_of[i] = &states[count++];
    begin(*ray_of[i], rays, i, bvh, self(i));
  }
  const unsigned hits = trace_rays<Packet, kPrecision>(bvh, query, ray_of);
  for (int i = 0; i < kWidth; ++i)
    if (ray_of[i] != nullptr) limits[i] = ray_of[i]->limit;
  return hits;
}

}  // namespace orrery::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
