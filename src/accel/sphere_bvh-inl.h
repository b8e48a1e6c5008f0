// SPDX-License-Identifier: Apache-2.0
// What the traversals of a SphereBvh share: references, prefetching, and the tests of leaves.
#pragma once

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "accel/embree_rays-inl.h"
#include "accel/sphere_bvh.h"
#include "kernel/sphere.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::accel::HWY_NAMESPACE {

/// SIMD tag for the children of a node or the spheres of a leaf.
using ChildTag = hn::CappedTag<float, SphereBvh::kArity>;
constexpr int kChildLanes = static_cast<int>(hn::MaxLanes(ChildTag()));

/// Smaller direction components are replaced by this value. Its reciprocal is finite, and over the extent of a frame
/// the deviation is far less than the padding.
constexpr float kSmallestDirection = 0x1p-80F;

/// Inserts an entry by its entry distance `enter`, so that the nearest is last.
template <class T>
HWY_INLINE void insert(T* sorted, int begin, int& end, const T& added) {
  int at = end++;
  for (; at > begin && sorted[at - 1].enter < added.enter; --at) sorted[at] = sorted[at - 1];
  sorted[at] = added;
}

/// Maximum number of pending candidates of a ray; one more leaf must fit.
constexpr int kMaxCandidates = 2 * static_cast<int>(SphereBvh::kArity);

HWY_INLINE hn::Vec<ChildTag> from_bytes(const std::uint8_t* bytes) {
  const ChildTag d;
  const hn::Rebind<std::int32_t, ChildTag> di;
  const hn::Rebind<std::uint8_t, ChildTag> d8;
  return hn::ConvertTo(d, hn::PromoteTo(di, hn::LoadU(d8, bytes)));
}

/// Kind of a node reference, stored in its upper two bits.
enum Kind : unsigned { kNode = 0, kEnd = 1, kLeaf = 2, kKinds = 3 };
constexpr int kIndexWidth = 30;
constexpr std::uint32_t kIndexMask = (1u << kIndexWidth) - 1;
constexpr std::uint32_t kEndOfStack = kEnd << kIndexWidth;
static_assert(SphereBvh::kLeafBit == std::uint32_t{kLeaf} << kIndexWidth);

/// Prefetches nodes and leaves. Which of the two a ray visits next is hard to predict, so the code does not branch on
/// it.
class Prefetcher {
 public:
  Prefetcher(const SphereBvh& bvh, const EmbreeScene& scene)
      : rods_(scene.view.rods),
        motion_(scene.view.motion),
        moving_count_(scene.view.moving_count),
        has_radii_(!bvh.radii.empty()),
        has_rods_(!bvh.rods.empty()) {
    const kernel::SphereArray& spheres = scene.view.spheres;
    // The less frequent kind of sphere is not prefetched.
    const bool plain = spheres.all_plain();
    sphere_stride_ = plain ? sizeof(kernel::Sphere) : 3 * sizeof(float);
    spheres_ = reinterpret_cast<std::uintptr_t>(spheres.address(plain ? 0 : spheres.plain_count)) -
               (plain ? 0 : spheres.plain_count * sphere_stride_);
    const auto at = [](const auto* p) { return reinterpret_cast<const std::uint8_t*>(p); };
    first_[kNode] = first_[kEnd] = at(bvh.nodes.data());
    first_[kLeaf] = at(bvh.leaves.data());
    radii_[kNode] = radii_[kEnd] = radii_[kLeaf] = at(bvh.radii.data());
    leaf_rods_ = at(bvh.rods.data());
  }
  HWY_INLINE void prefetch(std::uint32_t reference) const {
    static_assert(sizeof(SphereBvh::Node) == 128 && sizeof(SphereBvh::Leaf) == 128);
    static constexpr std::size_t kRadii[kKinds] = {0, 0, sizeof(SphereBvh::LeafRadii)};
    const unsigned kind = reference >> kIndexWidth;
    const std::size_t index = reference & kIndexMask;
    const std::uint8_t* const at = first_[kind] + index * 128;
    hwy::Prefetch(at);
    hwy::Prefetch(at + 64);
    if (has_radii_) hwy::Prefetch(radii_[kind] + index * kRadii[kind]);
    if (has_rods_) hwy::Prefetch(leaf_rods_ + (kind == kLeaf ? index * sizeof(SphereBvh::LeafRods) : 0));
  }
  /// Prefetches a sphere or rod.
  HWY_INLINE void prefetch_candidate(std::uint32_t id) const {
    const auto* const at = reinterpret_cast<const std::uint8_t*>(spheres_ + id * sphere_stride_);
    hwy::Prefetch(has_rods_ && rods_.contains(id) ? static_cast<const std::uint8_t*>(rods_.address(rods_.index(id)))
                                                  : at);
    if (id < moving_count_) hwy::Prefetch(motion_ + id);
  }

 private:
  const kernel::RodArray& rods_;
  const kernel::Sphere* motion_;
  std::size_t moving_count_;
  std::uintptr_t spheres_;
  std::size_t sphere_stride_;
  const std::uint8_t *first_[kKinds], *radii_[kKinds], *leaf_rods_;
  bool has_radii_, has_rods_;
};

/// Covers the rounding of squares and of their sum.
constexpr float kGrowth = 1 + 0x1p-20F;

/// Covers the rounding of a distance that is compared with others.
constexpr float kLonger = 1 + 0x1p-18F;

/// Maximum quantization error of a sphere's centre plus rounding error of a ray's position. The factor is sqrt(3) / 2,
/// rounded up: a centre is at most half a step off on each axis.
HWY_INLINE float margin_of(const SphereBvh& bvh, const SphereBvh::Leaf& leaf) {
  return 0.875F * leaf.step + bvh.padding;
}

/// Bounds of the radii of spheres `first` .. of a leaf.
struct RadiusBounds {
  hn::Vec<ChildTag> most, least;
};
HWY_INLINE RadiusBounds radii_of(const SphereBvh& bvh, std::uint32_t leaf, int first) {
  const ChildTag d;
  if (bvh.radii.empty()) return {hn::Set(d, bvh.radius), hn::Set(d, bvh.radius - bvh.spread)};
  const SphereBvh::LeafRadii& own = bvh.radii[leaf];
  const auto most = from_bytes(own.radius + first) * own.step;
  return {most, most - hn::Set(d, own.step + bvh.spread)};
}

/// How rays pass spheres, a pair per lane.
template <class V>
struct Passing {
  V along;          ///< distance along the ray of the point that is closest to the centre
  V offset_square;  ///< squared distance of the centre from the ray, rounded up
};

/// `to_center`  from the ray's origin to the sphere's decoded centre
template <class V>
HWY_INLINE Passing<V> passing(const k::Vec3<V>& to_center, const k::Vec3<V>& direction) {
  const V along = dot(to_center, direction);
  const auto offset = neg_mul_add(direction, along, to_center);
  return {along, dot(offset, offset) * kGrowth};
}

/// Whether a ray may hit a sphere before its limit.
///
/// `outer`    the largest radius that the sphere may have, plus margin_of()
template <class V>
HWY_INLINE auto may_hit(const Passing<V>& p, V outer, V limit) {
  return hn::And(hn::And(p.offset_square <= outer * outer * kGrowth, p.along + outer >= 0), p.along - outer <= limit);
}

/// The half axes of a leaf's rods from `first` on, and the half paths of its spheres.
HWY_INLINE k::Vec3<hn::Vec<ChildTag>> half_axes(const SphereBvh::LeafRods& leaf, int first) {
  const ChildTag d;
  const hn::Rebind<std::int32_t, ChildTag> di;
  const hn::Rebind<std::int8_t, ChildTag> d8;
  const auto half = [&](int axis) {
    return hn::ConvertTo(d, hn::PromoteTo(di, hn::LoadU(d8, leaf.half[axis] + first))) * leaf.step;
  };
  return {half(0), half(1), half(2)};
}

/// Maximum quantization error of the points of a rod's axis plus rounding error of a ray's position.
HWY_INLINE float margin_of(const SphereBvh& bvh, const SphereBvh::Leaf& leaf, const SphereBvh::LeafRods& rods) {
  return margin_of(bvh, leaf) + 0.875F * rods.step;
}

/// margin_of() a leaf whose spheres may move. The factor also covers the rounding of their places at the times of rays.
HWY_INLINE float moving_margin_of(const SphereBvh& bvh, std::uint32_t leaf) {
  return margin_of(bvh, bvh.leaves[leaf]) + (bvh.moves ? 0.876F * bvh.rods[leaf].step : 0);
}

/// Rays and rods, a pair per lane.
template <class V>
struct AtRod {
  const SphereBvh& bvh;
  const SphereBvh::LeafRods& rods;
  float margin;          ///< margin_of() the rods
  k::Vec3<V> to_center;  ///< from the rays' origins to the middles of the rods
  k::Vec3<V> direction;  ///< unit
  k::Vec3<V> half;       ///< half_axes()

  /// Lower bound of the distance of a hit; exact for rays that are parallel to the axis.
  HWY_INLINE V begin(V along) const { return along - reach_along(); }

  /// Whether the ray may hit the rod before its limit. The axis is taken as an infinite line.
  ///
  /// `along`    distance along the ray of the point that is closest to the middle of the rod
  HWY_INLINE auto may_hit(V along, V limit) const {
    const auto normal = k::cross(direction, half);
    const float outer = (rods.radius + margin) * kGrowth;
    const auto near =
        hn::Abs(dot(to_center, normal)) <= hn::Sqrt(dot(normal, normal)) * outer + rods.step * bvh.axis_slack;
    const V reach = reach_along();
    return hn::And(near, hn::And(along + reach >= 0, along - reach <= limit));
  }

  /// An upper bound of the distance of a hit, or infinite if none is certain: the distance at which the ray is closest
  /// to the axis, if that is between the ends. The padding covers the rounding of positions on ray and axis, which are
  /// not nearly parallel.
  ///
  /// `begin`    a lower bound of the distance
  HWY_INLINE V certain_distance(V begin) const {
    const auto normal = k::cross(direction, half);
    const V square = dot(normal, normal);
    const float inner = (rods.least_radius - margin - bvh.padding) / kGrowth;
    const auto crosses =
        hn::And(square > dot(half, half) * 0x1p-6F, hn::Abs(dot(k::cross(to_center, direction), normal)) <= square);
    const auto within =
        hn::Abs(dot(to_center, normal)) + rods.step * bvh.axis_slack <= hn::Sqrt(square) * std::max(inner, 0.0F);
    const V closest = dot(k::cross(to_center, half), normal) / square;
    return select(hn::And(hn::And(crosses, within), begin > 0), (closest + (margin + bvh.padding)) * kLonger,
                  std::numeric_limits<float>::infinity());
  }

 private:
  /// Half the extent of the rod in the direction of the ray, at least.
  HWY_INLINE V reach_along() const { return (hn::Abs(dot(half, direction)) + (rods.radius + margin)) * kLonger; }
};

/// An upper bound of a hit's distance, or `limit` if that is less or no hit is certain.
///
/// `inner`    the smallest radius that the sphere may have, minus the margin
/// `begin`    a lower bound of the distance
template <class V>
HWY_INLINE V certain_limit(const Passing<V>& p, V inner, V begin, V margin, V limit) {
  const V deep = neg_mul_add(p.offset_square, kGrowth, inner * inner);
  const auto pierced = hn::And(inner > 0, hn::And(deep > 0, begin > 0));
  // Slightly below the root, so that the distance is overestimated. The error of the approximate reciprocal square
  // root is below 2^-11; it differs between processors, but does not affect the image.
  const V root = deep * hn::ApproximateReciprocalSqrt(max(deep, 0x1p-100F));
  const V certain = (neg_mul_add(root, 1 - 0x1p-10F, p.along) + margin) * kLonger;
  return min(limit, select(pierced, certain, limit));
}

}  // namespace orrery::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
