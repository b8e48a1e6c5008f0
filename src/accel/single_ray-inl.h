// SPDX-License-Identifier: Apache-2.0
// The steps of one ray through a SphereBvh. Compiled once per instruction set.
#if defined(ORRERY_ACCEL_SINGLE_RAY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_ACCEL_SINGLE_RAY_INL_H_
#undef ORRERY_ACCEL_SINGLE_RAY_INL_H_
#else
#define ORRERY_ACCEL_SINGLE_RAY_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "accel/sort_keys-inl.h"
#include "accel/sphere_bvh_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::accel::HWY_NAMESPACE {

/// The traversal state of a ray, in box space.
struct alignas(64) SingleRay {
  // Vectors of four, of which the last is 0.
  float origin[4], direction[4], inverse[4];
  float limit;            ///< distance beyond which nothing is searched
  std::uint32_t near[3];  ///< per axis: offset in Node::bound of the bounds at which the ray enters boxes
  std::uint32_t subtree;  ///< the node below which everything has been visited once the stack is empty
  unsigned subtree_level;
  std::size_t waiting;  ///< number of entries in `enter` and `what`: the end marker, then nodes, nearest last
  int candidates;       ///< number of entries in `at` and `candidate`: spheres that the ray may hit
  int ordered;          ///< number of entries in `order`
  // Padded, because whole vectors are stored at the end of each array.
  alignas(64) std::int32_t order[kMaxCandidates + SphereBvh::kArity];  ///< keys of candidates, nearest last
  float at[kMaxCandidates + SphereBvh::kArity];                        ///< a lower bound of a candidate's distance
  std::uint32_t candidate[kMaxCandidates + SphereBvh::kArity];         ///< ids
  float enter[SphereBvh::kStackSize + SphereBvh::kArity];              ///< a lower bound of the distance there
  std::uint32_t what[SphereBvh::kStackSize + SphereBvh::kArity];  ///< node references, encoded like SphereBvh::root()
};

/// Offset from lower to upper bounds in Node::bound.
constexpr std::uint32_t kOtherSide = 3 * SphereBvh::kArity;

/// Stores the keys of the children that a ray enters before its limit, followed by zeros up to a vector's length.
///
/// `except`   with kExcept: index of a child to skip
/// Result     number of keys
template <bool kExcept>
HWY_INLINE int entered(const SphereBvh::Node& node, const SingleRay& ray, int except, std::int32_t* keys) {
  const ChildTag d;
  const hn::RebindToSigned<ChildTag> di;
  const hn::FixedTag<float, 4> four;
  alignas(16) static constexpr std::uint32_t kThree[4] = {~0u, ~0u, ~0u, 0};
  const auto three = hn::BitCast(four, hn::Load(hn::RebindToUnsigned<decltype(four)>(), kThree));
  const auto inverse = hn::Load(four, ray.inverse);
  alignas(16) float scale[4], shift[4];
  // The fourth number is none: `first` or `count`.
  hn::Store(hn::And(hn::Load(four, node.step), three) * inverse, four, scale);
  hn::Store((hn::And(hn::Load(four, node.origin), three) - hn::Load(four, ray.origin)) * inverse, four, shift);
  const auto zero = hn::Zero(d), limit = hn::Set(d, ray.limit);
  int count = 0;
  for (std::uint32_t v = 0; v < SphereBvh::kArity; v += kChildLanes) {
    const auto at = [&](std::uint32_t side, unsigned k) {
      return hn::MulAdd(from_bytes(node.bound[0][0] + side + k * SphereBvh::kArity + v), hn::Set(d, scale[k]),
                        hn::Set(d, shift[k]));
    };
    const auto begin = hn::Max(hn::Max(at(ray.near[0], 0), at(ray.near[1], 1)), hn::Max(at(ray.near[2], 2), zero));
    const auto end = hn::Min(hn::Min(at(kOtherSide - ray.near[0], 0), at(kOtherSide - ray.near[1], 1)),
                             hn::Min(at(kOtherSide - ray.near[2], 2), limit));
    const auto index = hn::Iota(di, static_cast<int>(v));
    auto hits = hn::RebindMask(di, begin <= end);
    if constexpr (kExcept) hits = hn::And(hits, index != hn::Set(di, except));
    count += store_chosen(di, keys_of<SphereBvh::kArity>(d, begin, index), hits, keys + count);
  }
  return count;
}

/// Visits a node: pushes the children that the ray enters onto its stack. With kExcept, skips child `except`.
template <bool kExcept = false>
HWY_INLINE void visit_node(const SphereBvh::Node& node, SingleRay& ray, int except = 0) {
  const hn::FixedTag<std::int32_t, 4> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  const hn::RebindToFloat<decltype(d)> df;
  alignas(64) std::int32_t keys[2 * SphereBvh::kArity];
  const int count = entered<kExcept>(node, ray, except, keys);
  const auto index_bits = hn::Set(d, static_cast<int>(SphereBvh::kArity - 1));
  const auto first = hn::Set(du, node.first);
  const auto push = [&](hn::Vec<decltype(d)> four, int at) {
    const std::size_t end = ray.waiting + static_cast<std::size_t>(at);
    hn::StoreU(hn::BitCast(df, hn::AndNot(index_bits, four)), df, ray.enter + end);
    hn::StoreU(hn::BitCast(du, hn::And(four, index_bits)) + first, du, ray.what + end);
  };
  if (count <= 4) {
    push(sorted4(hn::Load(d, keys)), 0);
  } else {
    sort_keys(keys, count);
    for (int i = 0; i < count; i += 4) push(hn::Load(d, keys + i), i);
  }
  ray.waiting += static_cast<std::size_t>(count);
}

/// Returns whether a ray's end point, at its limit, lies in the region that only this node covers.
HWY_INLINE bool stays_in(const SphereBvh::Cell& cell, const SingleRay& ray) {
  const hn::FixedTag<float, 4> d;
  const auto begin = hn::Load(d, ray.origin);
  const auto end = hn::MulAdd(hn::Load(d, ray.direction), hn::Set(d, ray.limit), begin);
  const auto lower = hn::LoadU(d, cell.lower), upper = hn::LoadU(d, cell.upper);
  // Also false for an infinite limit.
  return hn::AllTrue(d, hn::And(hn::And(begin >= lower, end >= lower), hn::And(begin <= upper, end <= upper)));
}

/// Continues the traversal above a ray's subtree, unless nothing there can be closer.
///
/// Result     false if the ray is done
HWY_INLINE bool climb(const SphereBvh& bvh, SingleRay& ray) {
  if (ray.subtree == bvh.root() || ray.limit < 0 || stays_in(bvh.cells[ray.subtree], ray)) return false;
  const std::uint32_t in_level = ray.subtree - bvh.level_begin[ray.subtree_level];
  ray.subtree = bvh.level_begin[++ray.subtree_level] + in_level / SphereBvh::kArity;
  visit_node<true>(bvh.nodes[ray.subtree], ray, static_cast<int>(in_level % SphereBvh::kArity));
  return true;
}

/// Adds the spheres of a leaf that a ray may hit before its limit to its candidates. Shortens the ray to spheres that
/// it certainly hits.
///
/// `shortest`  hits nearer than this are not certain, box space
/// `target`    a sphere that is never hit
template <bool kShadows>
HWY_INLINE void visit_leaf(const SphereBvh& bvh, std::uint32_t index, float shortest, std::uint32_t target,
                           SingleRay& ray) {
  const ChildTag d;
  const SphereBvh::Leaf& leaf = bvh.leaves[index];
  const auto set = [&](float x) { return hn::Set(d, x); };
  const auto step = set(leaf.step);
  const auto margin = set(margin_of(bvh, leaf));
  const auto limit = set(ray.limit), zero = hn::Zero(d), growth = set(kGrowth);
  const auto dx = set(ray.direction[0]), dy = set(ray.direction[1]), dz = set(ray.direction[2]);
  const auto ox = set(leaf.origin[0] - ray.origin[0]), oy = set(leaf.origin[1] - ray.origin[1]),
             oz = set(leaf.origin[2] - ray.origin[2]);
  const std::uint32_t* const ids = leaf.ids;
  const hn::RebindToUnsigned<ChildTag> du;
  const auto is_target = [&](int v) { return hn::RebindMask(d, hn::LoadU(du, ids + v) == hn::Set(du, target)); };
  const bool is_last = index == bvh.last_leaf;
  const SphereBvh::LeafRadii* const own = bvh.radii.empty() ? nullptr : &bvh.radii[index];
  const auto uniform = set(bvh.radius), radius_step = set(own != nullptr ? own->step : 0);
  int count = ray.candidates;
  auto nearest = limit;
  for (int v = 0; v < static_cast<int>(SphereBvh::kArity); v += kChildLanes) {
    const auto x = hn::MulAdd(from_bytes(leaf.center[0] + v), step, ox);
    const auto y = hn::MulAdd(from_bytes(leaf.center[1] + v), step, oy);
    const auto z = hn::MulAdd(from_bytes(leaf.center[2] + v), step, oz);
    const auto along = hn::MulAdd(x, dx, hn::MulAdd(y, dy, z * dz));
    const auto px = hn::NegMulAdd(along, dx, x), py = hn::NegMulAdd(along, dy, y), pz = hn::NegMulAdd(along, dz, z);
    const auto offset_square = hn::MulAdd(px, px, hn::MulAdd(py, py, pz * pz)) * growth;
    auto most = uniform, least = uniform;
    if (own != nullptr) {
      most = from_bytes(own->radius + v) * radius_step;
      least = most - radius_step;
    }
    const auto outer = most + margin, begin = along - outer;
    auto may_hit = hn::And(hn::And(offset_square <= outer * outer * growth, along + outer >= zero), begin <= limit);
    if (is_last)
      may_hit = hn::And(may_hit, hn::Iota(d, static_cast<float>(v)) < set(static_cast<float>(bvh.count_in(index))));
    if (kShadows) may_hit = hn::AndNot(is_target(v), may_hit);
    const auto distance = hn::Max(begin, zero);
    if constexpr (kHasCompress) {
      hn::StoreU(hn::Compress(distance, may_hit), d, ray.at + count);
      hn::StoreU(hn::Compress(hn::LoadU(du, ids + v), hn::RebindMask(du, may_hit)), du, ray.candidate + count);
      count += static_cast<int>(hn::CountTrue(d, may_hit));
    } else {
      alignas(64) float distances[SphereBvh::kArity];
      hn::Store(distance, d, distances);
      each_bit(bits_of(d, may_hit), [&](int i) {
        ray.at[count] = distances[i];
        ray.candidate[count++] = ids[v + i];
      });
    }
    const auto inner = least - margin;
    const auto deep = hn::NegMulAdd(offset_square, growth, inner * inner);
    const auto pierced = hn::And(hn::And(may_hit, inner > zero), hn::And(deep > zero, begin > set(shortest)));
    // Slightly below the root, so that the distance is overestimated. The error of the approximate reciprocal square
    // root is below 2^-11; it differs between processors, but does not affect the image.
    const auto root = deep * hn::ApproximateReciprocalSqrt(hn::Max(deep, set(0x1p-100F)));
    const auto certain = (hn::NegMulAdd(root, set(1 - 0x1p-10F), along) + margin) * set(kLonger);
    nearest = hn::Min(nearest, hn::IfThenElse(pierced, certain, nearest));
  }
  ray.candidates = count;
  ray.limit = hn::GetLane(hn::MinOfLanes(d, nearest));
}

}  // namespace orrery::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
