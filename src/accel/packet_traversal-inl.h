// SPDX-License-Identifier: Apache-2.0
// Traversal of a SphereBvh by the rays of a packet together.
#pragma once

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "accel/sphere_bvh-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::accel::HWY_NAMESPACE {

/// A node or leaf that some rays of a packet still have to visit, or a sphere that they may hit.
struct PacketVisit {
  float enter;  ///< lower bound of the entry distance of these rays
  std::uint32_t what;
  unsigned lanes;
};

/// The rays of an Embree packet, traversed together: one pass over a node's children tests all rays. Faster than
/// single-ray traversal if the rays visit the same nodes, such as the camera rays of a pixel.
template <class Packet, kernel::Precision kPrecision>
class PacketTraversal {
 public:
  HWY_INLINE PacketTraversal(const SphereBvh& bvh, const EmbreeQuery<Packet>& query, const int* valid, RTCRayN* rays)
      : bvh_(bvh),
        query_(query),
        prefetcher_(bvh, *query.scene),
        direction_{&RTCRayN_dir_x(rays, kWidth, 0), &RTCRayN_dir_y(rays, kWidth, 0), &RTCRayN_dir_z(rays, kWidth, 0)},
        origin_{&RTCRayN_org_x(rays, kWidth, 0), &RTCRayN_org_y(rays, kWidth, 0), &RTCRayN_org_z(rays, kWidth, 0)} {
    const auto smallest = hn::Set(d_, kSmallestDirection), one = hn::Set(d_, 1.0F);
    hn::Store(hn::LoadU(d_, &RTCRayN_tfar(rays, kWidth, 0)), d_, limit_);
    for (int k = 0; k < 3; ++k) {
      const auto x = hn::LoadU(d_, direction_[k]);
      const auto inverse = one / hn::CopySign(max(hn::Abs(x), smallest), x);
      hn::Store(inverse, d_, inverse_[k]);
      hn::Store(-(hn::LoadU(d_, origin_[k]) * inverse), d_, shift_[k]);
    }
    for (int i = 0; i < kWidth; ++i) {
      lanes_ |= valid[i] != 0 ? 1u << i : 0u;
      if (bvh.moves)
        path_place_[i] = valid[i] != 0 ? static_cast<float>(2 * query.packet->time[query.first + i] - 1) : 0;
    }
    const auto active = mask_of(d_, lanes_);
    const auto infinite = hn::Set(d_, std::numeric_limits<float>::infinity());
    const auto least = [&](auto v) { return hn::GetLane(hn::MinOfLanes(d_, select(active, v, infinite))); };
    for (int k = 0; k < 3; ++k) {
      const auto o = hn::LoadU(d_, origin_[k]), inverse = hn::Load(d_, inverse_[k]);
      const float low = least(o), high = -least(-o);
      least_inverse_[k] = least(inverse);
      greatest_inverse_[k] = -least(-inverse);
      const bool forward = least_inverse_[k] > 0;
      straddles_[k] = !forward && greatest_inverse_[k] > 0;
      near_[k] = forward ? 0 : 1;
      near_origin_[k] = forward ? high : low;
      far_origin_[k] = forward ? low : high;
    }
  }

  /// `limits`   out: per lane, the distance beyond which nothing was searched
  /// Result     lanes with a new hit, as bits
  HWY_INLINE unsigned trace(float (&limits)[kWidth]) {
    PacketVisit stack[SphereBvh::kStackSize];
    int waiting = 0;
    stack[waiting++] = {0, bvh_.root(), lanes_};
    while (waiting > 0) {
      const PacketVisit visit = stack[--waiting];
      const unsigned lanes = visit.lanes & within(visit.enter);
      if (lanes == 0) continue;
      if ((visit.what & SphereBvh::kLeafBit) == 0) {
        visit_node(bvh_.nodes[visit.what], lanes, stack, waiting);
      } else {
        visit_leaf(visit.what & kIndexMask, lanes);
        if (candidate_count_ > kMaxCandidates - static_cast<int>(SphereBvh::kArity)) intersect_candidates();
      }
    }
    intersect_candidates();
    std::copy_n(limit_, kWidth, limits);
    return changed_;
  }

 private:
  using Wide = hn::ScalableTag<float>;  // kWidth lanes

  /// Boxes that some ray may enter, as bits. Uses interval arithmetic over all rays of the packet.
  HWY_INLINE unsigned entered_by_any(const float (&bound)[2][3][SphereBvh::kArity], unsigned count) const {
    const ChildTag d;
    unsigned bits = 0;
    for (int v = 0; v < static_cast<int>(SphereBvh::kArity); v += kChildLanes) {
      auto enter = hn::Zero(d), leave = hn::Set(d, std::numeric_limits<float>::infinity());
      for (int k = 0; k < 3; ++k) {
        if (straddles_[k]) continue;
        const auto low = hn::Set(d, least_inverse_[k]), high = hn::Set(d, greatest_inverse_[k]);
        const auto a = hn::Load(d, bound[near_[k]][k] + v) - near_origin_[k];
        const auto b = hn::Load(d, bound[1 - near_[k]][k] + v) - far_origin_[k];
        enter = max(enter, min(a * low, a * high));
        leave = min(leave, max(b * low, b * high));
      }
      bits |= bits_of(d, enter <= leave) << v;
    }
    return bits & ((1u << count) - 1u);
  }

  /// Lanes whose limit is not before a distance.
  HWY_INLINE unsigned within(float distance) const { return bits_of(d_, hn::Load(d_, limit_) >= distance); }

  HWY_INLINE void visit_node(const SphereBvh::Node& node, unsigned lanes, PacketVisit* stack, int& waiting) const {
    // Decode the boxes of the children.
    alignas(64) float bound[2][3][SphereBvh::kArity];
    const ChildTag dc;
    for (int side = 0; side < 2; ++side)
      for (int k = 0; k < 3; ++k)
        for (int v = 0; v < static_cast<int>(SphereBvh::kArity); v += kChildLanes)
          hn::Store(mul_add(from_bytes(node.bound[side][k] + v), node.step[k], node.origin[k]), dc, bound[side][k] + v);
    // Test each child that some ray may enter with all rays.
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
        const auto a = mul_add(bound[0][k][child], inverse[k], shift[k]);
        const auto b = mul_add(bound[1][k][child], inverse[k], shift[k]);
        enter = max(enter, min(a, b));
        leave = min(leave, max(a, b));
      }
      const auto hits = enter <= leave;
      const unsigned entering = bits_of(d_, hits) & lanes;
      if (entering == 0) continue;
      const float nearest = hn::GetLane(hn::MinOfLanes(d_, select(hits, enter, infinite)));
      insert(stack, begin, waiting, PacketVisit{nearest, node.first + child, entering});
    }
    if (waiting > 0) prefetcher_.prefetch(stack[waiting - 1].what);
  }

  HWY_INLINE void visit_leaf(std::uint32_t index, unsigned lanes) {
    const SphereBvh::Leaf& leaf = bvh_.leaves[index];
    // Decode the spheres and their boxes, then the axes of the rods.
    alignas(64) float center[3][SphereBvh::kArity], outer[SphereBvh::kArity], inner[SphereBvh::kArity];
    alignas(64) float bound[2][3][SphereBvh::kArity];
    const ChildTag dc;
    const float leaf_margin = moving_margin_of(bvh_, index);
    const auto margin = hn::Set(dc, leaf_margin);
    for (int v = 0; v < static_cast<int>(SphereBvh::kArity); v += kChildLanes) {
      const auto radii = radii_of(bvh_, index, v);
      const auto most = radii.most + margin;
      hn::Store(most, dc, outer + v);
      hn::Store(radii.least - margin, dc, inner + v);
      for (int k = 0; k < 3; ++k) {
        const auto c = mul_add(from_bytes(leaf.center[k] + v), leaf.step, leaf.origin[k]);
        hn::Store(c, dc, center[k] + v);
        hn::Store(c - most, dc, bound[0][k] + v);
        hn::Store(c + most, dc, bound[1][k] + v);
      }
    }
    const auto load = [&](const float* const* x) {
      return k::Vec3<hn::Vec<Wide>>{hn::LoadU(d_, x[0]), hn::LoadU(d_, x[1]), hn::LoadU(d_, x[2])};
    };
    const auto direction = load(direction_), origin = load(origin_);
    const auto wide_margin = hn::Set(d_, leaf_margin);
    const auto infinite = hn::Set(d_, std::numeric_limits<float>::infinity());
    const SphereBvh::LeafRods* const rods = bvh_.has_rods_in(index) ? &bvh_.rods[index] : nullptr;
    alignas(64) float half[3][SphereBvh::kArity];
    const float rod_margin = rods != nullptr ? margin_of(bvh_, leaf, *rods) : 0;
    if (rods != nullptr || bvh_.moves)
      for (int v = 0; v < static_cast<int>(SphereBvh::kArity); v += kChildLanes) {
        const auto axes = half_axes(bvh_.rods[index], v);
        const hn::Vec<ChildTag> halves[3] = {axes.x, axes.y, axes.z};
        for (int k = 0; k < 3; ++k) {
          hn::Store(halves[k], dc, half[k] + v);
          if (!bvh_.moves) continue;
          hn::Store(hn::Load(dc, bound[0][k] + v) - hn::Abs(halves[k]), dc, bound[0][k] + v);
          hn::Store(hn::Load(dc, bound[1][k] + v) + hn::Abs(halves[k]), dc, bound[1][k] + v);
        }
      }
    // Test each sphere or rod whose box some ray may enter with all rays.
    const bool has_opacity = query_.scene->view.opacity != nullptr;
    auto limit = hn::Load(d_, limit_);
    for (const int i : SetBits(entered_by_any(bound, bvh_.count_in(index)))) {
      const std::uint32_t id = leaf.ids[i];
      const bool is_rod = rods != nullptr && (rods->rods >> i & 1u) != 0;
      const auto vector_at = [&](const float(&from)[3][SphereBvh::kArity]) {
        return k::Vec3<hn::Vec<Wide>>{hn::Set(d_, from[0][i]), hn::Set(d_, from[1][i]), hn::Set(d_, from[2][i])};
      };
      auto at = vector_at(center);
      if (bvh_.moves && !is_rod) at = mul_add(vector_at(half), hn::Load(d_, path_place_), at);
      const auto passed = passing(at - origin, direction);
      const auto radius = hn::Set(d_, outer[i]);
      auto hit = may_hit(passed, radius, limit);
      const auto at_rod = [&] {
        return AtRod<hn::Vec<Wide>>{bvh_, *rods, rod_margin, at - origin, direction, vector_at(half)};
      };
      if (is_rod) hit = hn::And(hit, at_rod().may_hit(passed.along, limit));
      unsigned hitting = bits_of(d_, hit) & lanes;
      if constexpr (Packet::kIsShadow) {
        for (const int lane : SetBits(hitting)) {
          if (query_.packet->target[query_.first + lane] == id) hitting &= ~(1u << lane);
        }
        hit = mask_of(d_, hitting);
      }
      if (hitting == 0) continue;
      if (has_opacity) {
        // The halves of a rod may have different opacities: its opacity is known only with the hit.
        if (!is_rod)
          hit = hn::And(hit, k::visible_lanes(d_, *query_.packet, query_.first, query_.scene->view.opacity[id]));
        hitting &= bits_of(d_, hit);
        if (hitting == 0) continue;
      }
      // Shorten the rays that certainly hit it, and keep it as a candidate.
      const auto begin = is_rod ? at_rod().begin(passed.along) : passed.along - radius;
      const auto nearer = is_rod ? has_opacity ? limit : min(limit, at_rod().certain_distance(begin))
                                 : certain_limit(passed, hn::Set(d_, inner[i]), begin, wide_margin, limit);
      limit = select(hit, nearer, limit);
      const float nearest = hn::GetLane(hn::MinOfLanes(d_, select(hit, begin, infinite)));
      prefetcher_.prefetch_candidate(id);
      insert(candidates_, 0, candidate_count_, PacketVisit{nearest, id, hitting});
    }
    hn::Store(limit, d_, limit_);
  }

  /// Intersects the candidates, nearest first.
  HWY_INLINE void intersect_candidates() {
    const hn::ScalableTag<typename Packet::Number> d;
    using D = std::remove_const_t<decltype(d)>;
    const k::IdTag<D> du;
    constexpr int kStep = static_cast<int>(hn::MaxLanes(D()));
    Packet& packet = *query_.packet;
    while (candidate_count_ > 0) {
      const PacketVisit candidate = candidates_[--candidate_count_];
      const unsigned lanes = candidate.lanes & within(candidate.enter);
      if (lanes == 0) continue;
      const auto ids = hn::Set(du, static_cast<typename Packet::Id>(candidate.what));
      const kernel::RodArray& rods = query_.scene->view.rods;
      const bool is_rod = rods.contains(candidate.what);
      const bool moves = candidate.what < query_.scene->view.moving_count;
      const auto at_opening = k::broadcast(d, query_.scene->view.spheres[is_rod ? 0 : candidate.what]);
      for (int v = 0; v < kWidth; v += kStep) {
        const unsigned part = lanes >> v & ((1u << kStep) - 1u);
        if (part == 0) continue;
        const int first = query_.first + v;
        auto found = Found<D, Packet>::load(d, packet, first);
        const auto ray = k::load_rays(d, packet, first);
        if (is_rod) {
          const auto rod = k::broadcast(d, rods[rods.index(candidate.what)]);
          intersect_rods<kPrecision>(d, *query_.scene, packet, first, ray, rod, ids, mask_of(d, part), found);
        } else {
          const auto sphere = moves ? k::sphere_at(d, query_.scene->view, candidate.what, packet, first) : at_opening;
          intersect<kPrecision>(d, ray, sphere, ids, mask_of(d, part), found);
        }
        if (hn::AllFalse(d, found.is_new)) continue;
        found.store(d, packet, first);
        store_float_lanes(d, found.limit(d, query_, v), found.is_new, limit_ + v);
        changed_ |= bits_of(d, found.is_new) << v;
      }
    }
  }

  const Wide d_{};
  const SphereBvh& bvh_;
  const EmbreeQuery<Packet>& query_;
  Prefetcher prefetcher_;
  const float *direction_[3], *origin_[3];
  alignas(64) float limit_[kWidth];
  alignas(64) float path_place_[kWidth];  ///< as SingleRay::path_place, if spheres move
  alignas(64) float inverse_[3][kWidth];
  alignas(64) float shift_[3][kWidth];  ///< box space to distance: bound * inverse + shift
  // Bounds of the rays' origins, at the nearer and the farther side of boxes, and of their inverse directions.
  float near_origin_[3], far_origin_[3], least_inverse_[3], greatest_inverse_[3];
  int near_[3];        ///< the bound of a box that rays enter at
  bool straddles_[3];  ///< rays have both signs along this axis: no bound
  unsigned lanes_ = 0, changed_ = 0;
  int candidate_count_ = 0;
  PacketVisit candidates_[kMaxCandidates];
};

}  // namespace orrery::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
