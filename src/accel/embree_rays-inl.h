// SPDX-License-Identifier: Apache-2.0
// Rays in Embree's layout, and their hits.
#pragma once

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "accel/embree_scene.h"
#include "kernel/intersect-inl.h"
#include "kernel/opacity-inl.h"
#include "kernel/rod-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::accel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
namespace k = kernel::HWY_NAMESPACE;
using namespace math::HWY_NAMESPACE;  // NOLINT(google-build-using-namespace): SIMD vectors of another room
using k::bits_of;
using k::SetBits;
using k::store_floats;

/// Rays per Embree packet: the number of floats in a register.
constexpr int kWidth = static_cast<int>(hn::MaxLanes(hn::ScalableTag<float>()));

/// Embree's packet of rays without hits.
using EmbreeShadowRays = std::conditional_t<kWidth == 16, RTCRay16, std::conditional_t<kWidth == 8, RTCRay8, RTCRay4>>;

/// Rays in box space, advanced to the sphere that encloses all boxes.
template <class D>
struct BoxRays {
  math::HWY_NAMESPACE::Vec3<hn::Vec<D>> origin;
  hn::Vec<D> start;     ///< distance by which each ray was advanced, box space
  hn::Mask<D> reaches;  ///< false: the ray misses all boxes
};

/// Transforms rays to box space. Rays from far away would lose their float precision to the distance, so they are first
/// advanced, in the packet's precision, to the sphere that encloses all boxes.
///
/// Domain     unit directions
template <class D>
HWY_INLINE BoxRays<D> to_box_space(D d, const k::Rays<D>& ray, const BoxFrame& frame) {
  using T = hn::TFromD<D>;
  const auto scale = set(d, frame.scale);
  const auto middle = set3(d, frame.middle);
  const auto away = ray.origin - middle;
  const auto away_low = difference_error(ray.origin, middle, away) + ray.origin_low;
  const auto origin = away * scale;
  const auto low = away_low * scale;
  const auto zero = hn::Zero(d);
  const auto all = zero == zero;
  const auto reach = set(d, frame.reach);
  const auto outside = dot(origin, origin) > reach * reach;
  if (hn::AllFalse(d, outside)) return {origin + low, zero, all};

  const auto closest = -dot(origin, ray.direction);
  const auto passing = mul_add(ray.direction, closest, origin) + low;
  // The margin covers the rounding of `passing` for a ray from 1e12 reaches away, in single precision from 1e6.
  const auto nearest_square = reach * reach * (sizeof(T) == 8 ? 1.001 : 1.1);
  const auto misses = hn::Or(dot(passing, passing) > nearest_square, closest < 0);
  const auto start = hn::IfThenElseZero(outside, max(closest - reach, 0));
  return {mul_add(ray.direction, start, origin) + low, start, hn::Not(hn::And(outside, misses))};
}

/// Converts distances along rays to Embree's tfar, rounded up so that boxes of other spheres at the same distance are
/// still entered. Distances beyond the range of float become infinite.
template <class D>
HWY_INLINE hn::Vec<D> far_limits(D, hn::Vec<D> distance, double scale, hn::Vec<D> start) {
  using T = hn::TFromD<D>;
  constexpr T kUlp = sizeof(T) == 8 ? T(0x1p-50) : T(0x1p-21);
  const auto at = distance * scale;
  return (mul_add(at, kUlp, at) - start) * (1 + 0x1p-20) + std::numeric_limits<float>::min();
}

/// The results of a packet's rays so far, from lane `first` on: closest hits, or occlusion.
template <class D, class Packet, bool kIsShadow = Packet::kIsShadow>
struct Found {
  hn::Vec<D> distance;
  hn::Vec<k::IdTag<D>> ids;
  hn::Mask<D> is_new;  ///< lanes whose hit has changed since load()

  static HWY_INLINE Found load(D d, const Packet& packet, int first) {
    return {hn::Load(d, packet.distance + first), hn::Load(k::IdTag<D>(), packet.hit + first), hn::FirstN(d, 0)};
  }
  HWY_INLINE void store(D d, Packet& packet, int first) const {
    hn::Store(distance, d, packet.distance + first);
    hn::Store(ids, k::IdTag<D>(), packet.hit + first);
  }
  /// Keeps the closer hit; of two at the same distance, the one with the smaller id.
  HWY_INLINE void take(D d, const k::Distances<D>& found, hn::Vec<k::IdTag<D>> found_ids, hn::Mask<D> lanes) {
    const auto same_place = hn::And(found.value == distance, hn::RebindMask(d, ids > found_ids));
    const auto nearer = hn::And(hn::And(lanes, found.mask), hn::Or(found.value < distance, same_place));
    distance = select(nearer, found.value, distance);
    ids = select(hn::RebindMask(k::IdTag<D>(), nearer), found_ids, ids);
    is_new = hn::Or(is_new, nearer);
  }
  /// Embree's tfar in the lanes with hits, which are lanes `v` on of the query.
  HWY_INLINE hn::Vec<D> limit(D d, const EmbreeQuery<Packet>& query, int v) const {
    return far_limits(d, distance, query.scene->frame.scale, hn::Load(d, query.start + v));
  }
};

template <class D, class Packet>
struct Found<D, Packet, true> {
  hn::Vec<D> distance;  ///< maximum
  hn::Vec<k::IdTag<D>> targets, occluded;
  hn::Mask<D> is_new;

  static HWY_INLINE Found load(D d, const Packet& packet, int first) {
    const k::IdTag<D> du;
    return {hn::Load(d, packet.distance + first), hn::Load(du, packet.target + first),
            hn::Load(du, packet.occluded + first), hn::FirstN(d, 0)};
  }
  HWY_INLINE void store(D, Packet& packet, int first) const {
    hn::Store(occluded, k::IdTag<D>(), packet.occluded + first);
  }
  HWY_INLINE void take(D d, const k::Distances<D>& found, hn::Vec<k::IdTag<D>> found_ids, hn::Mask<D> lanes) {
    const k::IdTag<D> du;
    const auto is_target = hn::RebindMask(d, targets == found_ids);
    const auto hits = hn::And(hn::And(hn::AndNot(is_target, lanes), found.mask), found.value < distance);
    occluded = hn::Or(occluded, hn::VecFromMask(du, hn::RebindMask(du, hits)));
    is_new = hn::Or(is_new, hits);
  }
  HWY_INLINE hn::Vec<D> limit(D d, const EmbreeQuery<Packet>&, int) const {
    return hn::Set(d, -std::numeric_limits<hn::TFromD<D>>::infinity());
  }
};

/// Intersects rays with spheres, one per lane.
template <kernel::Precision kPrecision, class D, class Packet>
HWY_INLINE void intersect(D d, const k::Rays<D>& ray, const k::Spheres<D>& spheres, hn::Vec<k::IdTag<D>> ids,
                          hn::Mask<D> lanes, Found<D, Packet>& found) {
  const auto is_self = hn::RebindMask(d, ray.self == ids);
  found.take(d, k::closest_distance<D, kPrecision>(d, ray, spheres, is_self), ids, lanes);
}

/// Intersects rays with the same sphere.
///
/// kPlain     EmbreeScene::is_plain()
template <kernel::Precision kPrecision, bool kPlain, class D, class Packet>
HWY_INLINE void intersect_sphere(D d, const EmbreeScene& scene, const Packet& packet, int first, const k::Rays<D>& ray,
                                 std::uint32_t id, hn::Mask<D> lanes, Found<D, Packet>& found) {
  const auto ids = hn::Set(k::IdTag<D>(), static_cast<typename Packet::Id>(id));
  if constexpr (kPlain) {
    intersect<kPrecision>(d, ray, k::broadcast(d, scene.view.spheres[id]), ids, lanes, found);
  } else {
    if (scene.view.opacity != nullptr)
      lanes = hn::And(lanes, k::visible_lanes(d, packet, first, scene.view.opacity[id]));
    if (!hn::AllFalse(d, lanes))
      intersect<kPrecision>(d, ray, k::sphere_at(d, scene.view, id, packet, first), ids, lanes, found);
  }
}

/// Intersects rays with rods, one per lane, at the times of the rays. The halves that they enter have the opacity.
///
/// `first`    lane of the packet
/// `ids`      of the rods' first halves
template <kernel::Precision kPrecision, class D, class Packet>
HWY_INLINE void intersect_rods(D d, const EmbreeScene& scene, const Packet& packet, int first, const k::Rays<D>& ray,
                               const k::Rods<D>& rod, hn::Vec<k::IdTag<D>> ids, hn::Mask<D> lanes,
                               Found<D, Packet>& found) {
  auto may = hn::And(lanes, k::may_hit(ray, rod));
  if (hn::AllFalse(d, may)) return;
  const k::IdTag<D> du;
  const auto entry = k::closest_entry<D, kPrecision>(d, ray, rod);
  const auto of_halves = ids + hn::IfThenElseZero(hn::RebindMask(du, entry.second_half), set(du, 1));
  if (scene.view.opacity != nullptr)
    may = k::visible_objects(d, packet.threshold + first, of_halves, may, scene.view.opacity);
  found.take(d, {entry.distance, entry.hits}, of_halves, may);
}

/// Intersects rays with the same rod.
template <kernel::Precision kPrecision, class D, class Packet>
HWY_INLINE void intersect_rod(D d, const EmbreeScene& scene, const Packet& packet, int first, const k::Rays<D>& ray,
                              std::size_t rod, hn::Mask<D> lanes, Found<D, Packet>& found) {
  intersect_rods<kPrecision>(d, scene, packet, first, ray, k::rod_at(d, scene.view.rods, rod, packet, first),
                             set(k::IdTag<D>(), scene.view.rods.id(rod)), lanes, found);
}

/// Converts one bit per lane to a mask.
template <class D>
HWY_INLINE hn::Mask<D> mask_of(D d, unsigned lanes) {
  const hn::RebindToUnsigned<D> du;
  using U = hn::TFromD<decltype(du)>;
  const auto bit = hn::Shl(hn::Set(du, U{1}), hn::Iota(du, 0));
  return hn::RebindMask(d, hn::TestBit(hn::Set(du, U{lanes}), bit));
}

/// Converts Embree's valid flags to a mask.
template <class D>
HWY_INLINE hn::Mask<D> is_valid(D d, hn::Vec<hn::Rebind<std::int32_t, D>> flags) {
  if constexpr (sizeof(hn::TFromD<D>) == 8) {
    const hn::RebindToSigned<D> wide;
    return hn::RebindMask(d, hn::PromoteTo(wide, flags) < hn::Zero(wide));
  } else {
    return hn::RebindMask(d, flags < hn::Zero(hn::Rebind<std::int32_t, D>()));
  }
}

/// Converts a mask to Embree's valid flags.
template <class D>
HWY_INLINE hn::Vec<hn::Rebind<std::int32_t, D>> flags_of(D, hn::Mask<D> mask) {
  const hn::RebindToUnsigned<D> wide;
  const hn::Rebind<std::int32_t, D> di;
  const auto flags = hn::VecFromMask(wide, hn::RebindMask(wide, mask));
  if constexpr (sizeof(hn::TFromD<D>) == 8) {
    return hn::BitCast(di, hn::TruncateTo(hn::Rebind<std::uint32_t, D>(), flags));
  } else {
    return hn::BitCast(di, flags);
  }
}

/// Stores the lanes of a mask as floats, and nothing in the others. Embree loads whole vectors soon afterwards, which
/// would have to wait for stores of single lanes.
template <class D>
HWY_INLINE void store_float_lanes(D d, hn::Vec<D> value, hn::Mask<D> lanes, float* to) {
  const hn::Rebind<float, D> df;
  if constexpr (sizeof(hn::TFromD<D>) == 8) {
    hn::BlendedStore(hn::DemoteTo(df, value), hn::RebindMask(df, flags_of(d, lanes) < 0), df, to);
  } else {
    hn::BlendedStore(value, lanes, df, to);
  }
}

/// Sets Embree's hits to none. Its callbacks leave them so.
template <class Rays>
HWY_INLINE void reset_hits(Rays& rays) {
  if constexpr (requires { rays.hit.geomID[0]; }) {
    for (int i = 0; i < kWidth; ++i) rays.hit.geomID[i] = rays.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  } else if constexpr (requires { rays.hit; }) {
    rays.hit.geomID = rays.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  }
}

/// Sets the members that are the same in all queries.
template <class EmbreeRay>
HWY_INLINE void set_constants(EmbreeRay& rays) {
  for (int i = 0; i < kWidth; ++i) {
    rays.tnear[i] = 0;
    rays.time[i] = 0;
    rays.mask[i] = ~0u;
    rays.id[i] = static_cast<unsigned>(i);
    rays.flags[i] = 0;
  }
}

/// Sets Embree's rays to rays `first` .. of the query's packet in box space, and which of them can hit a box before
/// their maximum distance.
template <class Packet, class EmbreeRay>
HWY_INLINE void set_rays(EmbreeQuery<Packet>& query, EmbreeRay& rays, int* valid) {
  const hn::ScalableTag<typename Packet::Number> d;
  const int step = static_cast<int>(hn::Lanes(d));
  const Packet& packet = *query.packet;
  const EmbreeScene& scene = *query.scene;
  for (int v = 0; v < kWidth; v += step) {
    const int first = query.first + v;
    auto ray = k::load_rays(d, packet, first);
    auto distance = hn::Load(d, packet.distance + first);
    if constexpr (Packet::kIsShadow) {  // directions of any length
      const auto per_length = hn::Sqrt(ray.inverse_square);
      ray.direction = ray.direction * per_length;
      distance = distance / per_length;
    }
    const auto box = to_box_space(d, ray, scene.frame);
    const auto limit = far_limits(d, distance, scene.frame.scale, box.start);
    store_floats(d, box.origin.x, rays.org_x + v);
    store_floats(d, box.origin.y, rays.org_y + v);
    store_floats(d, box.origin.z, rays.org_z + v);
    store_floats(d, ray.direction.x, rays.dir_x + v);
    store_floats(d, ray.direction.y, rays.dir_y + v);
    store_floats(d, ray.direction.z, rays.dir_z + v);
    store_floats(d, limit, rays.tfar + v);
    if (scene.moves()) store_floats(d, hn::Load(d, packet.time + first), rays.time + v);
    hn::Store(box.start, d, query.start + v);
    // If a known hit is in front of all boxes, there is nothing to find, and Embree does not accept a negative limit.
    const auto active = hn::FirstN(d, static_cast<std::size_t>(std::max(0, packet.count - first)));
    const auto lanes = hn::And(hn::And(active, box.reaches), limit > 0);
    hn::StoreU(flags_of(d, lanes), hn::Rebind<std::int32_t, decltype(d)>(), valid + v);
  }
  if constexpr (Packet::kIsShadow) {
    for (int i = 0; i < kWidth; ++i)
      if (packet.occluded[query.first + i] != 0) valid[i] = 0;
  }
}

}  // namespace orrery::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
