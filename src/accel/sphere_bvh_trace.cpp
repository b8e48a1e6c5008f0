// SPDX-License-Identifier: Apache-2.0
// Embree's callbacks for a BVH of many spheres, which is one primitive. Compiled once per instruction set.
#include <algorithm>
#include <functional>
#include <limits>
#include <type_traits>
#include <utility>

#include "accel/embree_scene.h"
#include "accel/sphere_bvh.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "accel/sphere_bvh_trace.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target:
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "accel/embree_rays-inl.h"
#include "kernel/gather-inl.h"
#include "math/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::accel::HWY_NAMESPACE {

/// Floats of a vector of children or of a leaf's spheres.
using ChildTag = hn::CappedTag<float, SphereBvh::kArity>;
constexpr int kChildLanes = static_cast<int>(hn::MaxLanes(ChildTag()));

/// Components of a direction smaller than this are replaced by it: over the length of a frame that is far less than the
/// padding, and its reciprocal is finite.
constexpr float kSmallestDirection = 0x1p-80F;

/// A sphere that a ray may hit, and a lower bound of the distance there.
struct Candidate {
  float enter;
  std::uint32_t id;
};

/// Candidates of a ray that wait to be intersected; one leaf more must fit.
constexpr int kMaxCandidates = 2 * static_cast<int>(SphereBvh::kArity);

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

HWY_INLINE hn::Vec<ChildTag> from_bytes(const std::uint8_t* bytes) {
  const ChildTag d;
  const hn::Rebind<std::int32_t, ChildTag> di;
  const hn::Rebind<std::uint8_t, ChildTag> d8;
  return hn::ConvertTo(d, hn::PromoteTo(di, hn::LoadU(d8, bytes)));
}

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

/// What a reference refers to: its upper two bits.
enum Kind : unsigned { kNode = 0, kEnd = 1, kLeaf = 2, kKinds = 3 };
constexpr int kIndexWidth = 30;
constexpr std::uint32_t kIndexMask = (1u << kIndexWidth) - 1;
constexpr std::uint32_t kEndOfStack = kEnd << kIndexWidth;
static_assert(SphereBvh::kLeafBit == std::uint32_t{kLeaf} << kIndexWidth);

/// The cache lines of nodes and leaves. Which kind a ray visits next is hard to predict, so nothing branches on it.
class Prefetcher {
 public:
  explicit Prefetcher(const SphereBvh& bvh) : has_radii_(!bvh.radii.empty()) {
    const auto at = [](const auto* p) { return reinterpret_cast<const std::uint8_t*>(p); };
    first_[kNode] = second_[kNode] = third_[kNode] = at(bvh.nodes.data());
    second_[kNode] += 64;
    first_[kEnd] = second_[kEnd] = third_[kEnd] = first_[kNode];
    first_[kLeaf] = at(bvh.leaves.data());
    second_[kLeaf] = at(bvh.ids.data());
    third_[kLeaf] = at(bvh.radii.data());
  }
  HWY_INLINE void prefetch(std::uint32_t reference) const {
    static constexpr std::size_t kFirst[kKinds] = {sizeof(SphereBvh::Node), 0, sizeof(SphereBvh::Leaf)};
    static constexpr std::size_t kSecond[kKinds] = {sizeof(SphereBvh::Node), 0,
                                                    SphereBvh::kArity * sizeof(std::uint32_t)};
    static constexpr std::size_t kThird[kKinds] = {0, 0, sizeof(SphereBvh::LeafRadii)};
    const unsigned kind = reference >> kIndexWidth;
    const std::size_t index = reference & kIndexMask;
    hwy::Prefetch(first_[kind] + index * kFirst[kind]);
    hwy::Prefetch(second_[kind] + index * kSecond[kind]);
    if (has_radii_) hwy::Prefetch(third_[kind] + index * kThird[kind]);
  }

 private:
  const std::uint8_t *first_[kKinds], *second_[kKinds], *third_[kKinds];
  bool has_radii_;
};

HWY_INLINE void prefetch_reference(const SphereBvh& bvh, std::uint32_t reference) {
  const std::size_t index = reference & kIndexMask;
  const auto* const at = (reference & SphereBvh::kLeafBit) != 0 ? static_cast<const void*>(&bvh.leaves[index])
                                                                : static_cast<const void*>(&bvh.nodes[index]);
  hwy::Prefetch(static_cast<const std::uint8_t*>(at));
  hwy::Prefetch(static_cast<const std::uint8_t*>(at) + 64);
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

/// Covers the rounding of squares and of their sum.
constexpr float kGrowth = 1 + 0x1p-20F;

/// Covers the rounding of a distance that is compared with others.
constexpr float kLonger = 1 + 0x1p-18F;

/// How far a sphere's centre may be from its code, and a ray from where it is computed. The factor is sqrt(3) / 2,
/// rounded up: a centre is half a step off on each axis.
HWY_INLINE float margin_of(const SphereBvh& bvh, const SphereBvh::Leaf& leaf) {
  return 0.875F * leaf.step + bvh.padding;
}

/// Bounds of the radii of spheres `first` .. of a leaf.
struct RadiusBounds {
  hn::Vec<ChildTag> most, least;
};
HWY_INLINE RadiusBounds radii_of(const SphereBvh& bvh, std::uint32_t leaf, int first) {
  const ChildTag d;
  if (bvh.radii.empty()) {
    const auto radius = hn::Set(d, bvh.radius);
    return {radius, radius};
  }
  const SphereBvh::LeafRadii& own = bvh.radii[leaf];
  const auto step = hn::Set(d, own.step), most = from_bytes(own.radius + first) * step;
  return {most, most - step};
}

/// The distance from which on a hit is certain, in box space: the book's arithmetic ignores near hits.
template <kernel::Precision kPrecision>
HWY_INLINE float shortest_certain(const SphereBvh& bvh, const BoxFrame& frame) {
  if (kPrecision != kernel::Precision::kBook) return 0;
  return static_cast<float>(kernel::kBookShortestDistance * frame.scale) * kLonger + bvh.padding;
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

HWY_INLINE void prefetch_sphere(const kernel::SphereArray& spheres, std::uint32_t id) {
  hwy::Prefetch(static_cast<const std::uint8_t*>(spheres.address(id)));
}

/// Adds spheres of a leaf to the candidates of a ray.
HWY_INLINE void add_candidates(unsigned bits, const std::uint32_t* ids, const float* enter,
                               const kernel::SphereArray& spheres, SingleRay& ray) {
  for (; bits != 0; bits &= bits - 1) {
    const auto i = hwy::Num0BitsBelowLS1Bit_Nonzero32(bits);
    if (enter[i] > ray.limit) continue;
    const Candidate found{enter[i], ids[i]};
    prefetch_sphere(spheres, found.id);
    int at = ray.candidates++;
    for (; at > 0 && ray.spheres[at - 1].enter < found.enter; --at) ray.spheres[at] = ray.spheres[at - 1];
    ray.spheres[at] = found;
  }
}

/// Intersects the candidates of rays, which are lanes of the query, and stores the results in the packet.
///
/// Result     lanes with a new hit, as bits
template <class D, class Packet, kernel::Precision kPrecision>
HWY_INLINE unsigned intersect_candidates(D d, const EmbreeQuery<Packet>& query, SingleRay* const (&ray_of)[kWidth]) {
  using Id = hn::TFromD<k::IdTag<D>>;
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
template <class D, class Packet, kernel::Precision kPrecision>
HWY_INLINE unsigned trace_rays(D d, const SphereBvh& bvh, const EmbreeQuery<Packet>& query,
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
    if (full) changed |= intersect_candidates<D, Packet, kPrecision>(d, query, ray_of);
  }
  return changed | intersect_candidates<D, Packet, kPrecision>(d, query, ray_of);
}

/// Sets up a ray of Embree's packet.
template <class EmbreeRays>
HWY_INLINE void begin(SingleRay& ray, EmbreeRays* rays, unsigned i, const SphereBvh& bvh, std::uint32_t self) {
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

/// Traces the valid rays of Embree's packet, each on its own way. Embree passes packets only, as scene.has_bvh asks.
///
/// `ray_of`   out: the ray of each lane; null where the lane is not valid
/// Result     lanes with a new hit, as bits
template <class Packet, kernel::Precision kPrecision>
HWY_INLINE unsigned trace_valid(const SphereBvh& bvh, const EmbreeQuery<Packet>& query, const int* valid, RTCRayN* rays,
                                SingleRay (&states)[kWidth], SingleRay* (&ray_of)[kWidth]) {
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
  return trace_rays<hn::ScalableTag<DistanceOf<Packet>>, Packet, kPrecision>({}, bvh, query, ray_of);
}

/// A node or leaf that some rays of a packet have still to visit, or a sphere that they may hit.
struct SharedVisit {
  float enter;  ///< a lower bound of the distance there, for all of these rays
  std::uint32_t what;
  unsigned lanes;
};

/// Inserts a visit so that the nearest is the last.
HWY_INLINE void insert(SharedVisit* visits, int begin, int& end, const SharedVisit& visit) {
  int at = end++;
  for (; at > begin && visits[at - 1].enter < visit.enter; --at) visits[at] = visits[at - 1];
  visits[at] = visit;
}

/// The rays of an Embree packet, which visit nodes together: one pass over a node's children for all rays. Faster than
/// each on its own way if they visit the same nodes, such as the camera rays of a pixel.
template <class Packet, kernel::Precision kPrecision>
class SharedRays {
 public:
  HWY_INLINE SharedRays(const SphereBvh& bvh, const EmbreeQuery<Packet>& query, const int* valid, RTCRayN* rays)
      : bvh_(bvh),
        query_(query),
        shortest_(shortest_certain<kPrecision>(bvh, query.scene->frame)),
        direction_{&RTCRayN_dir_x(rays, kWidth, 0), &RTCRayN_dir_y(rays, kWidth, 0), &RTCRayN_dir_z(rays, kWidth, 0)},
        origin_{&RTCRayN_org_x(rays, kWidth, 0), &RTCRayN_org_y(rays, kWidth, 0), &RTCRayN_org_z(rays, kWidth, 0)} {
    const auto smallest = hn::Set(d_, kSmallestDirection), one = hn::Set(d_, 1.0F);
    hn::Store(hn::LoadU(d_, &RTCRayN_tfar(rays, kWidth, 0)), d_, limit_);
    for (int k = 0; k < 3; ++k) {
      const auto x = hn::LoadU(d_, direction_[k]);
      const auto inverse = one / hn::CopySign(hn::Max(hn::Abs(x), smallest), x);
      hn::Store(inverse, d_, inverse_[k]);
      hn::Store(hn::Neg(hn::LoadU(d_, origin_[k]) * inverse), d_, shift_[k]);
    }
    for (int i = 0; i < kWidth; ++i) lanes_ |= valid[i] != 0 ? 1u << i : 0u;
    const auto active = mask_of(lanes_);
    const auto infinite = hn::Set(d_, std::numeric_limits<float>::infinity());
    const auto least = [&](auto v) { return hn::GetLane(hn::MinOfLanes(d_, hn::IfThenElse(active, v, infinite))); };
    for (int k = 0; k < 3; ++k) {
      const auto o = hn::LoadU(d_, origin_[k]), inverse = hn::Load(d_, inverse_[k]);
      const float low = least(o), high = -least(hn::Neg(o));
      least_inverse_[k] = least(inverse);
      greatest_inverse_[k] = -least(hn::Neg(inverse));
      const bool forward = least_inverse_[k] > 0;
      straddles_[k] = !forward && greatest_inverse_[k] > 0;
      near_[k] = forward ? 0 : 1;
      near_origin_[k] = forward ? high : low;
      far_origin_[k] = forward ? low : high;
    }
  }

  /// Result     lanes with a new hit, as bits
  HWY_INLINE unsigned trace() {
    SharedVisit stack[SphereBvh::kStackSize];
    int waiting = 0;
    stack[waiting++] = {0, bvh_.root(), lanes_};
    while (waiting > 0) {
      const SharedVisit visit = stack[--waiting];
      const unsigned lanes = visit.lanes & within(visit.enter);
      if (lanes == 0) continue;
      if ((visit.what & SphereBvh::kLeafBit) == 0) {
        visit_node(bvh_.nodes[visit.what], lanes, stack, waiting);
      } else {
        visit_leaf(visit.what & kIndexMask, lanes);
        if (candidate_count_ > kMaxCandidates - static_cast<int>(SphereBvh::kArity)) intersect();
      }
    }
    intersect();
    return changed_;
  }

  const float* limits() const { return limit_; }

 private:
  using Wide = hn::ScalableTag<float>;  // kWidth lanes
  static constexpr bool kShadows = requires(Packet p) { p.occluded; };

  /// Boxes that some ray may enter, as bits, by interval arithmetic over all rays of the packet.
  HWY_INLINE unsigned entered_by_any(const float (&bound)[2][3][SphereBvh::kArity], unsigned count) const {
    const ChildTag d;
    unsigned bits = 0;
    for (int v = 0; v < static_cast<int>(SphereBvh::kArity); v += kChildLanes) {
      auto enter = hn::Zero(d), leave = hn::Set(d, std::numeric_limits<float>::infinity());
      for (int k = 0; k < 3; ++k) {
        if (straddles_[k]) continue;
        const auto low = hn::Set(d, least_inverse_[k]), high = hn::Set(d, greatest_inverse_[k]);
        const auto a = hn::Load(d, bound[near_[k]][k] + v) - hn::Set(d, near_origin_[k]);
        const auto b = hn::Load(d, bound[1 - near_[k]][k] + v) - hn::Set(d, far_origin_[k]);
        enter = hn::Max(enter, hn::Min(a * low, a * high));
        leave = hn::Min(leave, hn::Max(b * low, b * high));
      }
      bits |= bits_of(d, enter <= leave) << v;
    }
    return bits & ((1u << count) - 1u);
  }

  /// Lanes whose limit is not before a distance.
  HWY_INLINE unsigned within(float distance) const {
    return bits_of(d_, hn::Load(d_, limit_) >= hn::Set(d_, distance));
  }

  HWY_INLINE void visit_node(const SphereBvh::Node& node, unsigned lanes, SharedVisit* stack, int& waiting) const {
    alignas(64) float bound[2][3][SphereBvh::kArity];
    const ChildTag dc;
    for (int side = 0; side < 2; ++side)
      for (int k = 0; k < 3; ++k)
        for (int v = 0; v < static_cast<int>(SphereBvh::kArity); v += kChildLanes)
          hn::Store(
              hn::MulAdd(from_bytes(node.bound[side][k] + v), hn::Set(dc, node.step[k]), hn::Set(dc, node.origin[k])),
              dc, bound[side][k] + v);
    hn::Vec<Wide> inverse[3], shift[3];
    for (int k = 0; k < 3; ++k) {
      inverse[k] = hn::Load(d_, inverse_[k]);
      shift[k] = hn::Load(d_, shift_[k]);
    }
    const auto limit = hn::Load(d_, limit_), zero = hn::Zero(d_);
    const auto infinite = hn::Set(d_, std::numeric_limits<float>::infinity());
    const int begin = waiting;
    for (unsigned rest = entered_by_any(bound, node.count); rest != 0; rest &= rest - 1) {
      const auto child = static_cast<std::uint32_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(rest));
      auto enter = zero, leave = limit;
      for (int k = 0; k < 3; ++k) {
        const auto a = hn::MulAdd(hn::Set(d_, bound[0][k][child]), inverse[k], shift[k]);
        const auto b = hn::MulAdd(hn::Set(d_, bound[1][k][child]), inverse[k], shift[k]);
        enter = hn::Max(enter, hn::Min(a, b));
        leave = hn::Min(leave, hn::Max(a, b));
      }
      const auto hits = enter <= leave;
      const unsigned entering = bits_of(d_, hits) & lanes;
      if (entering == 0) continue;
      const float nearest = hn::GetLane(hn::MinOfLanes(d_, hn::IfThenElse(hits, enter, infinite)));
      insert(stack, begin, waiting, {nearest, node.first + child, entering});
    }
    if (waiting > 0) prefetch_reference(bvh_, stack[waiting - 1].what);
  }

  HWY_INLINE void visit_leaf(std::uint32_t index, unsigned lanes) {
    const SphereBvh::Leaf& leaf = bvh_.leaves[index];
    alignas(64) float center[3][SphereBvh::kArity], outer[SphereBvh::kArity], inner[SphereBvh::kArity];
    alignas(64) float bound[2][3][SphereBvh::kArity];
    const ChildTag dc;
    const auto margin = hn::Set(dc, margin_of(bvh_, leaf));
    for (int v = 0; v < static_cast<int>(SphereBvh::kArity); v += kChildLanes) {
      const auto radii = radii_of(bvh_, index, v);
      const auto most = radii.most + margin;
      hn::Store(most, dc, outer + v);
      hn::Store(radii.least - margin, dc, inner + v);
      for (int k = 0; k < 3; ++k) {
        const auto c = hn::MulAdd(from_bytes(leaf.center[k] + v), hn::Set(dc, leaf.step), hn::Set(dc, leaf.origin[k]));
        hn::Store(c, dc, center[k] + v);
        hn::Store(c - most, dc, bound[0][k] + v);
        hn::Store(c + most, dc, bound[1][k] + v);
      }
    }
    const auto load = [&](const float* x) { return hn::LoadU(d_, x); };
    const auto dx = load(direction_[0]), dy = load(direction_[1]), dz = load(direction_[2]);
    const auto ox = load(origin_[0]), oy = load(origin_[1]), oz = load(origin_[2]);
    const auto zero = hn::Zero(d_), growth = hn::Set(d_, kGrowth);
    const auto infinite = hn::Set(d_, std::numeric_limits<float>::infinity());
    auto limit = hn::Load(d_, limit_);
    const std::uint32_t* const ids = &bvh_.ids[std::size_t{index} * SphereBvh::kArity];
    for (unsigned rest = entered_by_any(bound, bvh_.count_in(index)); rest != 0; rest &= rest - 1) {
      const auto i = hwy::Num0BitsBelowLS1Bit_Nonzero32(rest);
      const auto x = hn::Set(d_, center[0][i]) - ox, y = hn::Set(d_, center[1][i]) - oy,
                 z = hn::Set(d_, center[2][i]) - oz;
      const auto along = hn::MulAdd(x, dx, hn::MulAdd(y, dy, z * dz));
      const auto px = hn::NegMulAdd(along, dx, x), py = hn::NegMulAdd(along, dy, y), pz = hn::NegMulAdd(along, dz, z);
      const auto offset_square = hn::MulAdd(px, px, hn::MulAdd(py, py, pz * pz)) * growth;
      const auto radius = hn::Set(d_, outer[i]), begin = along - radius;
      const auto may_hit =
          hn::And(hn::And(offset_square <= radius * radius * growth, along + radius >= zero), begin <= limit);
      unsigned hitting = bits_of(d_, may_hit) & lanes;
      if constexpr (kShadows) hitting = hitting == 0 ? 0 : without_target(hitting, ids[i]);
      if (hitting == 0) continue;
      const auto low = hn::Set(d_, inner[i]);
      const auto deep = hn::NegMulAdd(offset_square, growth, low * low);
      if (inner[i] > 0) {
        auto pierced = hn::And(hn::And(may_hit, deep > zero), begin > hn::Set(d_, shortest_));
        if constexpr (kShadows) pierced = hn::And(pierced, mask_of(hitting));
        const auto certain =
            ((along - hn::Sqrt(hn::Max(deep, zero))) + hn::Set(d_, margin_of(bvh_, leaf))) * hn::Set(d_, kLonger);
        limit = hn::Min(limit, hn::IfThenElse(pierced, certain, limit));
      }
      const float nearest = hn::GetLane(hn::MinOfLanes(d_, hn::IfThenElse(may_hit, begin, infinite)));
      prefetch_sphere(query_.scene->spheres, ids[i]);
      insert(candidates_, 0, candidate_count_, {nearest, ids[i], hitting});
    }
    hn::Store(limit, d_, limit_);
  }

  HWY_INLINE hn::Mask<Wide> mask_of(unsigned lanes) const {
    const hn::RebindToUnsigned<Wide> du;
    const auto bit = hn::Shl(hn::Set(du, 1u), hn::Iota(du, 0));
    return hn::RebindMask(d_, hn::TestBit(hn::Set(du, lanes), bit));
  }

  /// Lanes whose target is not this sphere.
  HWY_INLINE unsigned without_target(unsigned lanes, std::uint32_t id) const {
    for (unsigned rest = lanes; rest != 0; rest &= rest - 1) {
      const int i = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(rest));
      if (query_.packet->target[query_.first + i] == id) lanes &= ~(1u << i);
    }
    return lanes;
  }

  /// Intersects the candidates, nearest first.
  HWY_INLINE void intersect() {
    using D = hn::ScalableTag<DistanceOf<Packet>>;
    const D d;
    const k::IdTag<D> du;
    const int step = static_cast<int>(hn::Lanes(d));
    Packet& packet = *query_.packet;
    const EmbreeScene& scene = *query_.scene;
    while (candidate_count_ > 0) {
      const SharedVisit candidate = candidates_[--candidate_count_];
      const unsigned lanes = candidate.lanes & within(candidate.enter);
      if (lanes == 0) continue;
      const auto ids = hn::Set(du, static_cast<hn::TFromD<decltype(du)>>(candidate.what));
      const auto sphere = k::broadcast(d, scene.spheres[candidate.what]);
      for (int v = 0; v < kWidth; v += step) {
        const unsigned part = lanes >> v & ((1u << step) - 1u);
        if (part == 0) continue;
        const int first = query_.first + v;
        const auto ray = k::load_rays(d, packet, first);
        const auto found = k::nearest<D, kPrecision>(d, ray, sphere, hn::RebindMask(d, ray.self == ids));
        unsigned hits = 0;
        if constexpr (kShadows) {
          hits = part & bits_of(d, hn::And(found.mask, found.value < hn::Load(d, packet.distance + first)));
          for (unsigned rest = hits; rest != 0; rest &= rest - 1) {
            const int i = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(rest));
            packet.occluded[first + i] = static_cast<hn::TFromD<decltype(du)>>(~hn::TFromD<decltype(du)>{0});
            limit_[v + i] = -1;
          }
        } else {
          auto nearest = ClosestHit<D>::load(d, packet, first);
          nearest.take(d, found, ids, found.mask);
          hits = part & bits_of(d, nearest.is_new);
          if (hits == 0) continue;
          alignas(64) float limits[hn::MaxLanes(hn::ScalableTag<float>())];
          store_float(d, far_limits(d, nearest.distance, scene.frame.scale, hn::Load(d, query_.start + v)), limits);
          // Lanes outside of `part` may belong to no ray.
          HWY_ALIGN DistanceOf<Packet> distance[hn::MaxLanes(D())];
          hn::Store(nearest.distance, d, distance);
          for (unsigned rest = hits; rest != 0; rest &= rest - 1) {
            const int i = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(rest));
            limit_[v + i] = limits[i];
            packet.distance[first + i] = distance[i];
            packet.hit[first + i] = candidate.what;
          }
        }
        changed_ |= hits << v;
      }
    }
  }

  const Wide d_{};
  const SphereBvh& bvh_;
  const EmbreeQuery<Packet>& query_;
  float shortest_;
  const float *direction_[3], *origin_[3];
  alignas(64) float limit_[kWidth];
  alignas(64) float inverse_[3][kWidth];
  alignas(64) float shift_[3][kWidth];  ///< box space to distance: bound * inverse + shift
  // Bounds of the rays' origins, at the nearer and the farther side of boxes, and of their inverse directions.
  float near_origin_[3], far_origin_[3], least_inverse_[3], greatest_inverse_[3];
  int near_[3];        ///< the bound of a box that rays enter at
  bool straddles_[3];  ///< rays go both ways along this axis: nothing is known
  unsigned lanes_ = 0, changed_ = 0;
  int candidate_count_ = 0;
  SharedVisit candidates_[kMaxCandidates];
};

/// Whether the rays of a packet visit nodes together.
template <class Packet>
HWY_INLINE bool are_together(const EmbreeQuery<Packet>& query) {
  const bool from_camera = query.packet->self[0] == kernel::kNoSphere;
  const Traversals& chosen = query.scene->traversals;
  return (from_camera ? chosen.camera : chosen.bounced) == Traversal::kPacket;
}

/// Embree's callback for closest hits.
template <class Packet, kernel::Precision kPrecision>
void intersect_bvh(const RTCIntersectFunctionNArguments* arguments) {
  const auto& query = *reinterpret_cast<const EmbreeQuery<Packet>*>(arguments->context);
  const auto& bvh = *static_cast<const SphereBvh*>(arguments->geometryUserPtr);
  RTCRayN* const rays = RTCRayHitN_RayN(arguments->rayhit, kWidth);
  const auto store = [&](unsigned hits, auto limit_of) {
    for (int i = 0; i < kWidth; ++i) {
      const bool is_new = (hits >> i & 1u) != 0;
      arguments->valid[i] = is_new ? -1 : 0;
      if (is_new) RTCRayN_tfar(rays, kWidth, static_cast<unsigned>(i)) = limit_of(i);
    }
  };
  if (are_together(query)) {
    SharedRays<Packet, kPrecision> shared(bvh, query, arguments->valid, rays);
    store(shared.trace(), [&](int i) { return shared.limits()[i]; });
  } else {
    SingleRay states[kWidth];
    SingleRay* ray_of[kWidth] = {};
    store(trace_valid<Packet, kPrecision>(bvh, query, arguments->valid, rays, states, ray_of),
          [&](int i) { return ray_of[i]->limit; });
  }
}

/// Embree's callback for occlusion.
template <class Packet, kernel::Precision kPrecision>
void occluded_by_bvh(const RTCOccludedFunctionNArguments* arguments) {
  const auto& query = *reinterpret_cast<const EmbreeQuery<Packet>*>(arguments->context);
  const auto& bvh = *static_cast<const SphereBvh*>(arguments->geometryUserPtr);
  unsigned hits = 0;
  if (are_together(query)) {
    hits = SharedRays<Packet, kPrecision>(bvh, query, arguments->valid, arguments->ray).trace();
  } else {
    SingleRay states[kWidth];
    SingleRay* ray_of[kWidth] = {};
    hits = trace_valid<Packet, kPrecision>(bvh, query, arguments->valid, arguments->ray, states, ray_of);
  }
  for (unsigned i = 0; i < kWidth; ++i)
    if ((hits >> i & 1u) != 0) RTCRayN_tfar(arguments->ray, kWidth, i) = -std::numeric_limits<float>::infinity();
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
