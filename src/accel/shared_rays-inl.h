// SPDX-License-Identifier: Apache-2.0
// Rays that traverse a SphereBvh together. Compiled once per instruction set.
#if defined(ORRERY_ACCEL_SHARED_RAYS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_ACCEL_SHARED_RAYS_INL_H_
#undef ORRERY_ACCEL_SHARED_RAYS_INL_H_
#else
#define ORRERY_ACCEL_SHARED_RAYS_INL_H_
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <cstdint>
#include <limits>

#include "accel/sphere_bvh_rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::accel::HWY_NAMESPACE {

/// A node or leaf that some rays of a packet still have to visit, or a sphere that they may hit.
struct SharedVisit {
  float enter;  ///< lower bound of the entry distance of these rays
  std::uint32_t what;
  unsigned lanes;
};

/// The rays of an Embree packet, traversed together: one pass over a node's children tests all rays. Faster than
/// single-ray traversal if the rays visit the same nodes, such as the camera rays of a pixel.
template <class Packet, kernel::Precision kPrecision>
class SharedRays {
 public:
  HWY_INLINE SharedRays(const SphereBvh& bvh, const EmbreeQuery<Packet>& query, const int* valid, RTCRayN* rays)
      : bvh_(bvh),
        query_(query),
        prefetcher_(bvh, query.scene->spheres),
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

  /// Boxes that some ray may enter, as bits. Uses interval arithmetic over all rays of the packet.
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
      insert(stack, begin, waiting, SharedVisit{nearest, node.first + child, entering});
    }
    if (waiting > 0) prefetcher_.prefetch(stack[waiting - 1].what);
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
    const std::uint32_t* const ids = leaf.ids;
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
      prefetcher_.prefetch_sphere(ids[i]);
      insert(candidates_, 0, candidate_count_, SharedVisit{nearest, ids[i], hitting});
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
        const auto found = k::closest_distance<D, kPrecision>(d, ray, sphere, hn::RebindMask(d, ray.self == ids));
        unsigned hits = 0;
        if constexpr (kShadows) {
          hits = part & bits_of(d, hn::And(found.mask, found.value < hn::Load(d, packet.distance + first)));
          for (unsigned rest = hits; rest != 0; rest &= rest - 1) {
            const int i = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(rest));
            packet.occluded[first + i] = static_cast<hn::TFromD<decltype(du)>>(~hn::TFromD<decltype(du)>{0});
            limit_[v + i] = -1;
          }
        } else {
          auto closest = ClosestHit<D>::load(d, packet, first);
          closest.take(d, found, ids, found.mask);
          hits = part & bits_of(d, closest.is_new);
          if (hits == 0) continue;
          alignas(64) float limits[hn::MaxLanes(hn::ScalableTag<float>())];
          store_float(d, far_limits(d, closest.distance, scene.frame.scale, hn::Load(d, query_.start + v)), limits);
          // Lanes outside `part` may have no ray.
          HWY_ALIGN DistanceOf<Packet> distance[hn::MaxLanes(D())];
          hn::Store(closest.distance, d, distance);
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
  Prefetcher prefetcher_;
  float shortest_;
  const float *direction_[3], *origin_[3];
  alignas(64) float limit_[kWidth];
  alignas(64) float inverse_[3][kWidth];
  alignas(64) float shift_[3][kWidth];  ///< box space to distance: bound * inverse + shift
  // Bounds of the rays' origins, at the nearer and the farther side of boxes, and of their inverse directions.
  float near_origin_[3], far_origin_[3], least_inverse_[3], greatest_inverse_[3];
  int near_[3];        ///< the bound of a box that rays enter at
  bool straddles_[3];  ///< rays have both signs along this axis: no bound
  unsigned lanes_ = 0, changed_ = 0;
  int candidate_count_ = 0;
  SharedVisit candidates_[kMaxCandidates];
};

}  // namespace orrery::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
