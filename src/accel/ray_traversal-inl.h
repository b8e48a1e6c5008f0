// SPDX-License-Identifier: Apache-2.0
// Traversal of a SphereBvh by single rays, those of up to four packets interleaved: the steps of a ray, then rounds of
// steps of all rays.
#pragma once

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <type_traits>

#include "accel/sphere_bvh-inl.h"
#include "kernel/gather-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::accel::HWY_NAMESPACE {

// Sort keys: a distance and an index in 32 bits.

/// Keys of non-negative distances, rounded down, with an index below kIndices in their low bits.
template <unsigned kIndices, class D>
HWY_INLINE hn::Vec<hn::RebindToSigned<D>> keys_of(D, hn::Vec<D> distance, hn::Vec<hn::RebindToSigned<D>> index) {
  const hn::RebindToSigned<D> di;
  static_assert((kIndices & (kIndices - 1)) == 0);
  // Also clears the sign, since a zero may be negative.
  constexpr auto kReplaced = static_cast<std::int32_t>(0x80000000u | (kIndices - 1));
  return hn::Or(hn::AndNot(hn::Set(di, kReplaced), hn::BitCast(di, distance)), index);
}

/// AVX-512 moves the chosen lanes of a vector to its front in one instruction; elsewhere a loop over the few chosen
/// lanes is faster.
constexpr bool kHasCompress = HWY_TARGET <= HWY_AVX3;

/// Stores the lanes of `mask` contiguously, followed by zeros up to at least a vector's length.
///
/// Result     number of lanes in `mask`
template <class D>
HWY_INLINE int store_chosen(D d, hn::Vec<D> v, hn::Mask<D> mask, hn::TFromD<D>* to) {
  if constexpr (kHasCompress) {
    hn::StoreU(hn::Compress(v, mask), d, to);  // AVX-512 sets the other lanes to zero
    return static_cast<int>(hn::CountTrue(d, mask));
  } else {
    HWY_ALIGN hn::TFromD<D> lanes[hn::MaxLanes(D())];
    hn::Store(v, d, lanes);
    int count = 0;
    for (const int i : SetBits(bits_of(d, mask))) to[count++] = lanes[i];
    hn::StoreU(hn::Zero(d), d, to + count);
    return count;
  }
}

/// Sorts four keys, largest first, by a network of three layers.
HWY_INLINE hn::Vec<hn::FixedTag<std::int32_t, 4>> sorted4(hn::Vec<hn::FixedTag<std::int32_t, 4>> keys) {
  const hn::FixedTag<std::int32_t, 4> d;
  alignas(16) static constexpr std::int32_t kOdd[4] = {0, -1, 0, -1}, kUpper[4] = {0, 0, -1, -1},
                                            kMiddle[4] = {0, 2, 1, 3};
  const auto exchange = [&](auto other, const std::int32_t* to_min) {
    const auto lower = hn::Load(d, to_min) < 0;
    keys = select(lower, min(keys, other), max(keys, other));
  };
  exchange(hn::Shuffle2301(keys), kOdd);
  exchange(hn::Shuffle1032(keys), kUpper);
  exchange(hn::TableLookupLanes(keys, hn::SetTableIndices(d, kMiddle)), kUpper);
  return keys;
}

#if HWY_MAX_BYTES >= 32
/// Sorts eight keys, largest first, by a network of six layers.
HWY_INLINE hn::Vec<hn::FixedTag<std::int32_t, 8>> sorted8(hn::Vec<hn::FixedTag<std::int32_t, 8>> keys) {
  const hn::FixedTag<std::int32_t, 8> d;
  alignas(32) static constexpr std::int32_t kOther[6][8] = {{1, 0, 3, 2, 5, 4, 7, 6}, {2, 3, 0, 1, 6, 7, 4, 5},
                                                            {0, 2, 1, 3, 4, 6, 5, 7}, {4, 5, 6, 7, 0, 1, 2, 3},
                                                            {0, 1, 4, 5, 2, 3, 6, 7}, {0, 2, 1, 4, 3, 6, 5, 7}};
  alignas(32) static constexpr std::int32_t kUpper[6][8] = {{0, -1, 0, -1, 0, -1, 0, -1}, {0, 0, -1, -1, 0, 0, -1, -1},
                                                            {0, 0, -1, 0, 0, 0, -1, 0},   {0, 0, 0, 0, -1, -1, -1, -1},
                                                            {0, 0, 0, 0, -1, -1, 0, 0},   {0, 0, -1, 0, -1, 0, -1, 0}};
  for (int layer = 0; layer < 6; ++layer) {
    const auto other = hn::TableLookupLanes(keys, hn::SetTableIndices(d, kOther[layer]));
    const auto upper = hn::Load(d, kUpper[layer]) < 0;
    keys = select(upper, min(keys, other), max(keys, other));
  }
  return keys;
}
#endif

/// Sorts keys in place, largest first.
///
/// Domain     `keys` is aligned to a vector and padded with zeros to eight keys
HWY_INLINE void sort_keys(std::int32_t* keys, int count) {
  const hn::FixedTag<std::int32_t, 4> d;
  if (count <= 4) {
    hn::Store(sorted4(hn::Load(d, keys)), d, keys);
    return;
  }
#if HWY_MAX_BYTES >= 32
  if (count <= 8) {
    const hn::FixedTag<std::int32_t, 8> d8;
    hn::Store(sorted8(hn::Load(d8, keys)), d8, keys);
    return;
  }
#endif
  std::sort(keys, keys + count, std::greater<>());
}

/// The traversal state of a ray, in box space.
struct alignas(64) SingleRay {
  float origin[4], direction[4];  ///< the fourth number is 0
  float inverse[3];               ///< 1 / direction
  float limit;                    ///< distance beyond which nothing is searched
  std::uint32_t left;             ///< the sphere that the ray leaves outwards and so cannot hit; kNone: none
  std::uint32_t target;           ///< shadow rays: a sphere that is never hit
  float threshold;                ///< as in kernel::PacketRays; only if the scene has opacities
  float path_place;       ///< where moving spheres are at the time of the ray: -1..1 from the middle of their paths
  std::uint32_t near[3];  ///< per axis: offset in Node::bound of the bounds at which the ray enters boxes
  std::uint32_t subtree;  ///< the node below which everything has been visited once the stack is empty
  unsigned subtree_level;
  std::size_t waiting;        ///< number of entries in `enter` and `what`: the end marker, then nodes, nearest last
  int candidates;             ///< number of entries in `at` and `candidate`: spheres that the ray may hit
  int key_count;              ///< number of entries in `keys`
  std::uint32_t first_child;  ///< of the node tested last: the reference that key index 0 stands for
  /// The spheres of the leaf tested last: distance along the ray, and squared distance from it, infinite if the ray
  /// certainly misses.
  alignas(64) float along[SphereBvh::kArity], offset_square[SphereBvh::kArity];
  // Padded, because whole vectors are stored at the end of each array.
  /// Sort keys of the children that test_children() found, or of the candidates at the end, nearest last.
  alignas(64) std::int32_t keys[kMaxCandidates + SphereBvh::kArity];
  float at[kMaxCandidates + SphereBvh::kArity];                   ///< a lower bound of a candidate's distance
  std::uint32_t candidate[kMaxCandidates + SphereBvh::kArity];    ///< ids
  float enter[SphereBvh::kStackSize + SphereBvh::kArity];         ///< a lower bound of the distance there
  std::uint32_t what[SphereBvh::kStackSize + SphereBvh::kArity];  ///< node references, encoded like SphereBvh::root()
};

/// Discards the end of a ray's stack that is beyond its limit.
///
/// Result     what the ray visits next, the last entry that is left
HWY_INLINE std::uint32_t next_visit(SingleRay& ray) {
  std::size_t waiting = ray.waiting;
  while (ray.enter[waiting - 1] > ray.limit) --waiting;
  ray.waiting = waiting;
  return ray.what[waiting - 1];
}

/// Offset from lower to upper bounds in Node::bound.
constexpr std::uint32_t kOtherSide = 3 * SphereBvh::kArity;

/// Determines the children of a node that a ray enters before its limit.
///
/// `except`   with kExcept: index of a child to skip
template <bool kExcept = false>
HWY_INLINE void test_children(const SphereBvh::Node& node, SingleRay& ray, int except = 0) {
  const ChildTag d;
  const hn::RebindToSigned<ChildTag> di;
  const auto inverse = [&](int k) { return hn::Set(d, ray.inverse[k]); };
  const auto scale_of = [&](int k) { return hn::Set(d, node.step[k]) * inverse(k); };
  const auto shift_of = [&](int k) { return (hn::Set(d, node.origin[k]) - hn::Set(d, ray.origin[k])) * inverse(k); };
  const hn::Vec<ChildTag> scale[3] = {scale_of(0), scale_of(1), scale_of(2)},
                          shift[3] = {shift_of(0), shift_of(1), shift_of(2)};
  const auto zero = hn::Zero(d), limit = hn::Set(d, ray.limit);
  int count = 0;
  for (std::uint32_t v = 0; v < SphereBvh::kArity; v += kChildLanes) {
    const auto at = [&](std::uint32_t side, unsigned k) {
      return mul_add(from_bytes(node.bound[0][0] + side + k * SphereBvh::kArity + v), scale[k], shift[k]);
    };
    const auto begin = max(max(at(ray.near[0], 0), at(ray.near[1], 1)), max(at(ray.near[2], 2), zero));
    const auto end = min(min(at(kOtherSide - ray.near[0], 0), at(kOtherSide - ray.near[1], 1)),
                         min(at(kOtherSide - ray.near[2], 2), limit));
    const auto index = hn::Iota(di, static_cast<int>(v));
    auto hits = hn::RebindMask(di, begin <= end);
    if constexpr (kExcept) hits = hn::And(hits, index != except);
    count += store_chosen(di, keys_of<SphereBvh::kArity>(d, begin, index), hits, ray.keys + count);
  }
  ray.key_count = count;
  ray.first_child = node.first;
}

/// Pushes the children that test_children() has found onto the ray's stack, nearest last.
HWY_INLINE void push_children(SingleRay& ray) {
  const hn::FixedTag<std::int32_t, 4> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  const hn::RebindToFloat<decltype(d)> df;
  const auto index_bits = hn::Set(d, static_cast<int>(SphereBvh::kArity - 1));
  const auto first = hn::Set(du, ray.first_child);
  const int count = ray.key_count;
  const auto push = [&](hn::Vec<decltype(d)> four, int at) {
    const std::size_t end = ray.waiting + static_cast<std::size_t>(at);
    hn::StoreU(hn::BitCast(df, hn::AndNot(index_bits, four)), df, ray.enter + end);
    hn::StoreU(hn::BitCast(du, hn::And(four, index_bits)) + first, du, ray.what + end);
  };
  if (count <= 4) {
    push(sorted4(hn::Load(d, ray.keys)), 0);
  } else {
    sort_keys(ray.keys, count);
    for (int i = 0; i < count; i += 4) push(hn::Load(d, ray.keys + i), i);
  }
  ray.waiting += static_cast<std::size_t>(count);
}

/// Returns whether a ray's end point, at its limit, lies in the region that only this node covers.
HWY_INLINE bool stays_in(const SphereBvh::Cell& cell, const SingleRay& ray) {
  const hn::FixedTag<float, 4> d;
  const auto begin = hn::Load(d, ray.origin);
  const auto end = mul_add(hn::Load(d, ray.direction), ray.limit, begin);
  const auto lower = hn::LoadU(d, cell.lower), upper = hn::LoadU(d, cell.upper);
  // Also false for an infinite limit.
  return hn::AllTrue(d, hn::And(hn::And(begin >= lower, end >= lower), hn::And(begin <= upper, end <= upper)));
}

/// Returns whether nothing outside a ray's subtree can be closer than what it has found.
HWY_INLINE bool is_done(const SphereBvh& bvh, const SingleRay& ray) {
  // Without branches, which would be hard to predict.
  return (ray.subtree == bvh.root()) | (ray.limit < 0) | stays_in(bvh.cells[ray.subtree], ray);
}

/// Tests the other children of the parent of a ray's subtree, which becomes its subtree.
HWY_INLINE void climb(const SphereBvh& bvh, SingleRay& ray) {
  const std::uint32_t in_level = ray.subtree - bvh.level_begin[ray.subtree_level];
  ray.subtree = bvh.level_begin[++ray.subtree_level] + in_level / SphereBvh::kArity;
  test_children<true>(bvh.nodes[ray.subtree], ray, static_cast<int>(in_level % SphereBvh::kArity));
}

/// A ray, and the rods of a leaf from `first` on.
HWY_INLINE AtRod<hn::Vec<ChildTag>> at_rods(const SphereBvh& bvh, std::uint32_t index, int first,
                                            const SingleRay& ray) {
  const ChildTag d;
  const SphereBvh::Leaf& leaf = bvh.leaves[index];
  const auto to_center = [&](int k) {
    return mul_add(from_bytes(leaf.center[k] + first), leaf.step, hn::Set(d, leaf.origin[k] - ray.origin[k]));
  };
  const auto direction = [&](int k) { return hn::Set(d, ray.direction[k]); };
  const SphereBvh::LeafRods& rods = bvh.rods[index];
  return {bvh,
          rods,
          margin_of(bvh, leaf, rods),
          {to_center(0), to_center(1), to_center(2)},
          {direction(0), direction(1), direction(2)},
          half_axes(rods, first)};
}

/// Determines the spheres of a leaf that a ray may hit before its limit.
///
/// Result     whether there are any
template <bool kShadows>
HWY_INLINE bool test_spheres(const SphereBvh& bvh, std::uint32_t index, SingleRay& ray) {
  const ChildTag d;
  const SphereBvh::Leaf& leaf = bvh.leaves[index];
  const auto set3 = [&](float x, float y, float z) {
    return k::Vec3<hn::Vec<ChildTag>>{hn::Set(d, x), hn::Set(d, y), hn::Set(d, z)};
  };
  const auto step = hn::Set(d, leaf.step), margin = hn::Set(d, moving_margin_of(bvh, index)),
             limit = hn::Set(d, ray.limit);
  const auto infinite = hn::Set(d, std::numeric_limits<float>::infinity());
  const auto direction = set3(ray.direction[0], ray.direction[1], ray.direction[2]);
  const auto origin =
      set3(leaf.origin[0], leaf.origin[1], leaf.origin[2]) - set3(ray.origin[0], ray.origin[1], ray.origin[2]);
  const hn::RebindToUnsigned<ChildTag> du;
  const bool is_last = index == bvh.last_leaf;
  const bool has_rods = bvh.has_rods_in(index);
  bool any = false;
  for (int v = 0; v < static_cast<int>(SphereBvh::kArity); v += kChildLanes) {
    const k::Vec3<hn::Vec<ChildTag>> codes = {from_bytes(leaf.center[0] + v), from_bytes(leaf.center[1] + v),
                                              from_bytes(leaf.center[2] + v)};
    auto to_center = mul_add(codes, step, origin);
    if (bvh.moves) {
      const auto still = mask_of(d, bvh.rods[index].rods >> v);
      const auto half = half_axes(bvh.rods[index], v);
      const auto place = select(still, hn::Zero(d), hn::Set(d, ray.path_place));
      to_center = mul_add(half, place, to_center);
    }
    const auto passed = passing(to_center, direction);
    auto hit = may_hit(passed, radii_of(bvh, index, v).most + margin, limit);
    const auto rods = has_rods ? hn::And(hit, mask_of(d, bvh.rods[index].rods >> v)) : hn::FirstN(d, 0);
    if (has_rods && !hn::AllFalse(d, rods))
      hit = hn::And(hit, hn::Or(hn::Not(rods), at_rods(bvh, index, v, ray).may_hit(passed.along, limit)));
    if (is_last) hit = hn::And(hit, hn::Iota(d, static_cast<float>(v)) < bvh.count_in(index));
    const auto ids = hn::LoadU(du, leaf.ids + v);
    hit = hn::And(hit, hn::RebindMask(d, ids != ray.left));
    if (kShadows) hit = hn::And(hit, hn::RebindMask(d, ids != ray.target));
    hn::Store(passed.along, d, ray.along + v);
    hn::Store(select(hit, passed.offset_square, infinite), d, ray.offset_square + v);
    any |= !hn::AllFalse(d, hit);
  }
  return any;
}

/// Removes the spheres that test_spheres() has found, but that are not visible to the ray. Rods are kept: the opacity
/// of the half that is hit is not known yet.
///
/// `opacity`  of each sphere
/// Result     whether any are left
inline bool keep_visible(const SphereBvh& bvh, std::uint32_t index, const float* opacity, SingleRay& ray) {
  const ChildTag d;
  const SphereBvh::Leaf& leaf = bvh.leaves[index];
  const auto infinite = hn::Set(d, std::numeric_limits<float>::infinity());
  bool any = false;
  for (int v = 0; v < static_cast<int>(SphereBvh::kArity); v += kChildLanes) {
    const auto offset_square = hn::Load(d, ray.offset_square + v);
    const unsigned rods = bvh.has_rods_in(index) ? bvh.rods[index].rods >> v : 0;
    unsigned visible = bits_of(d, offset_square < infinite);
    for (const int i : SetBits(visible & ~rods))
      if (!(ray.threshold < opacity[leaf.ids[v + i]])) visible &= ~(1u << i);
    hn::Store(select(mask_of(d, visible), offset_square, infinite), d, ray.offset_square + v);
    any |= visible != 0;
  }
  return any;
}

/// Adds the spheres that test_spheres() has found to a ray's candidates. Shortens the ray to spheres that it certainly
/// hits.
HWY_INLINE void add_candidates(const SphereBvh& bvh, std::uint32_t index, bool has_opacity, SingleRay& ray) {
  const ChildTag d;
  const hn::RebindToUnsigned<ChildTag> du;
  const SphereBvh::Leaf& leaf = bvh.leaves[index];
  const auto margin = hn::Set(d, moving_margin_of(bvh, index));
  const auto infinite = hn::Set(d, std::numeric_limits<float>::infinity());
  const bool has_rods = bvh.has_rods_in(index);
  int count = ray.candidates;
  auto nearest = hn::Set(d, ray.limit);
  for (int v = 0; v < static_cast<int>(SphereBvh::kArity); v += kChildLanes) {
    const Passing<hn::Vec<ChildTag>> passed = {hn::Load(d, ray.along + v), hn::Load(d, ray.offset_square + v)};
    const RadiusBounds radii = radii_of(bvh, index, v);
    auto begin = passed.along - (radii.most + margin);
    auto inner = radii.least - margin;
    const auto hit = passed.offset_square < infinite;
    const auto rods = has_rods ? hn::And(hit, mask_of(d, bvh.rods[index].rods >> v)) : hn::FirstN(d, 0);
    if (has_rods && !hn::AllFalse(d, rods)) {
      const auto at = at_rods(bvh, index, v, ray);
      begin = select(rods, at.begin(passed.along), begin);
      inner = select(rods, -1, inner);
      if (!has_opacity)  // otherwise a rod may be invisible
        nearest = min(nearest, select(rods, at.certain_distance(begin), infinite));
    }
    const auto distance = max(begin, 0);
    if constexpr (kHasCompress) {
      hn::StoreU(hn::Compress(distance, hit), d, ray.at + count);
      hn::StoreU(hn::Compress(hn::LoadU(du, leaf.ids + v), hn::RebindMask(du, hit)), du, ray.candidate + count);
      count += static_cast<int>(hn::CountTrue(d, hit));
    } else {
      alignas(64) float distances[SphereBvh::kArity];
      hn::Store(distance, d, distances);
      for (const int i : SetBits(bits_of(d, hit))) {
        ray.at[count] = distances[i];
        ray.candidate[count++] = leaf.ids[v + i];
      }
    }
    nearest = certain_limit(passed, inner, begin, margin, nearest);
  }
  ray.candidates = count;
  ray.limit = hn::GetLane(hn::MinOfLanes(d, nearest));
}

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
  const kernel::RodArray& rods = scene.view.rods;
  unsigned waiting = 0;
  for (const int i : SetBits(lanes)) waiting |= order_candidates(rays[i]) ? 1u << i : 0u;
  for (int v = 0; v < kWidth; v += kStep) {
    unsigned rest = waiting & (((1u << kStep) - 1u) << v);
    if (rest == 0) continue;
    const int first = query.first + v;
    const auto ray = k::load_rays(d, packet, first);
    auto found = Found<D, Packet>::load(d, packet, first);
    while (rest != 0) {
      // Take the nearest candidate of each ray.
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
      // Intersect the rays with their candidates: first those that are rods, then spheres.
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
            d, scene.view.spheres,
            [&](std::size_t i) { return ids[i] == kernel::kNone || rods.contains(ids[i]) ? other : ids[i]; }, row);
        k::Spheres<D> sphere{{row[0], row[1], row[2]}, row[3]};
        if (scene.view.moving_count > 0) {
          static constexpr kernel::Sphere kResting{0, 0, 0, 0};
          k::gather4(
              d,
              [&](std::size_t i) {
                return &(ids[i] < scene.view.moving_count ? scene.view.motion[ids[i]] : kResting).x;
              },
              row);
          sphere = k::moved<D>(sphere, {{row[0], row[1], row[2]}, row[3]}, hn::Load(d, packet.time + first));
        }
        intersect<kPrecision>(d, ray, sphere, found_ids, at_spheres, found);
      }
      // Shorten the rays to their hits; shadow rays end there.
      const unsigned hits = bits_of(d, found.is_new);
      if (hits == 0) continue;
      alignas(64) float limits[kWidth];
      store_floats(d, found.limit(d, query, v), limits);
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
  const bool has_opacity = scene.view.opacity != nullptr;
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
    // Where is each ray?
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
    // Nodes, and the parents of subtrees that have been visited: test and push children.
    for (const int i : SetBits(at_nodes)) test_children(bvh.nodes[rays[i].what[--rays[i].waiting]], rays[i]);
    for (const int i : SetBits(at_ends)) climb(bvh, rays[i]);
    for (const int i : SetBits(at_nodes | at_ends)) push_children(rays[i]);

    // Leaves: find the spheres that rays may hit, then add them as candidates.
    bool full = false;
    std::uint64_t found = 0;
    for (const int i : SetBits(at_leaves)) {
      SingleRay& ray = rays[i];
      const std::uint32_t leaf = ray.what[--ray.waiting] & kIndexMask;
      bool any = test_spheres<Packet::kIsShadow>(bvh, leaf, ray);
      if (has_opacity) any = any && keep_visible(bvh, leaf, scene.view.opacity, ray);
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
  const kernel::RodArray& rods = query.scene->view.rods;
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
  // The rays in box space, and what the steps need of each.
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
  // The state of each ray: it starts at the node above its leaf, or at the root.
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
    if (query.scene->view.opacity != nullptr) ray.threshold = packet.threshold[lane];
    if (bvh.moves) ray.path_place = static_cast<float>(2 * packet.time[lane] - 1);
    ray.candidates = 0;
    ray.candidate[0] = 0;
    ray.enter[0] = -std::numeric_limits<float>::infinity();  // never beyond the limit
    ray.what[0] = kEndOfStack;
    ray.enter[1] = 0;
    ray.subtree = bvh.start_node(query.scene->view.rods.object(static_cast<std::uint32_t>(packet.self[lane])));
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
      const std::size_t self = scene.view.rods.object(static_cast<std::uint32_t>(packets[p].self[i]));
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
