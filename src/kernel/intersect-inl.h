// SPDX-License-Identifier: Apache-2.0
// Ray-sphere intersection.
#pragma once

#include <hwy/highway.h>

#include "kernel/precision.h"
#include "kernel/ray_packet.h"
#include "math/functions-inl.h"
#include "math/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using namespace math::HWY_NAMESPACE;  // NOLINT(google-build-using-namespace): SIMD vectors of another room

/// Unsigned lanes as wide as D's, for ids and random bits.
template <class D>
using IdTag = hn::RebindToUnsigned<D>;

/// One ray per lane; see PacketRays.
template <class D>
struct Rays {
  using V = hn::Vec<D>;
  Vec3<V> origin, origin_low, offset, direction;
  V inverse_square;
  hn::Vec<IdTag<D>> self;
};

/// Loads the rays of a packet from `first` on.
template <class D, class Packet>
HWY_INLINE Rays<D> load_rays(D d, const Packet& p, int first) {
  const auto at = [&](const auto& component) { return load3(d, component, first); };
  return {at(p.origin),
          at(p.origin_low),
          at(p.offset),
          at(p.direction),
          hn::Load(d, p.inverse_square + first),
          hn::Load(IdTag<D>(), p.self + first)};
}

/// Stores rays into a packet from `first` on.
///
/// `base`     centre of the sphere that a ray leaves, or the camera's position
/// `offset`   from there to the ray's origin
template <class D, class Packet>
HWY_INLINE void store_rays(D d, const Vec3<hn::Vec<D>>& base, const Vec3<hn::Vec<D>>& offset,
                           const Vec3<hn::Vec<D>>& direction, hn::Vec<IdTag<D>> self, Packet& p, int first) {
  const auto origin = base + offset;
  store3(d, origin, p.origin, first);
  store3(d, sum_error(base, offset, origin), p.origin_low, first);
  store3(d, offset, p.offset, first);
  store3(d, direction, p.direction, first);
  hn::Store(1 / dot(direction, direction), d, p.inverse_square + first);
  hn::Store(self, IdTag<D>(), p.self + first);
}

/// One sphere per lane, or one sphere broadcast to all lanes.
template <class D>
struct Spheres {
  Vec3<hn::Vec<D>> center;
  hn::Vec<D> radius;
};

template <class D>
HWY_INLINE Spheres<D> broadcast(D d, const Sphere& s) {
  return {{set(d, s.x), set(d, s.y), set(d, s.z)}, set(d, s.radius)};
}

/// Spheres that have changed by `time` times `change`.
template <class D>
HWY_INLINE Spheres<D> moved(const Spheres<D>& at_opening, const Spheres<D>& change, hn::Vec<D> time) {
  return {mul_add(change.center, time, at_opening.center), mul_add(change.radius, time, at_opening.radius)};
}

/// A sphere at the times of a packet's rays from `first` on.
///
/// Domain     `scene` has spheres, motion and moving_count as SceneView has them
template <class D, class Scene, class Packet>
HWY_INLINE Spheres<D> sphere_at(D d, const Scene& scene, std::uint32_t id, const Packet& packet, int first) {
  const auto at_opening = broadcast(d, scene.spheres[id]);
  if (id >= scene.moving_count) return at_opening;
  return moved<D>(at_opening, broadcast(d, scene.motion[id]), hn::Load(d, packet.time + first));
}

/// The chord along which a ray's line passes through a sphere.
template <class D>
struct Chord {
  using V = hn::Vec<D>;
  V middle;           ///< distance to the chord's midpoint, as a multiple of the direction's length
  V discriminant;     ///< radius^2 - |to_center|^2; the line intersects the sphere if this is >= 0
  Vec3<V> to_center;  ///< from the midpoint to the sphere's centre; perpendicular to the direction
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE V discriminant(const V& radius, const Vec3<V>& to_center) {
  return neg_mul_add(to_center.z, to_center.z,
                     neg_mul_add(to_center.y, to_center.y, neg_mul_add(to_center.x, to_center.x, radius * radius)));
}

/// The chord in perpendicular form: only differences are squared, so no large terms cancel.
///
/// Reference  haines2019, ch. 7
template <class D>
HWY_INLINE Chord<D> plain_chord(const Rays<D>& ray, const Spheres<D>& sphere) {
  const auto to_sphere = sphere.center - ray.origin;
  const auto middle = dot(to_sphere, ray.direction) * ray.inverse_square;
  const auto to_center = neg_mul_add(ray.direction, middle, to_sphere);
  return {middle, discriminant<D>(sphere.radius, to_center), to_center};
}

/// Where a ray's line passes a point: the distance, as a multiple of the direction's length, and the vector to the
/// point, which is perpendicular to the direction.
template <class D>
struct Passage {
  hn::Vec<D> distance;
  Vec3<hn::Vec<D>> to_point;
};

/// Refines a passage by what rounding lost of the vector from the ray's origin to the point, and projects once more.
///
/// `lost`     the vector to the point, minus the one from which the passage was computed
template <class D>
HWY_INLINE Passage<D> refined(const Rays<D>& ray, const Passage<D>& plain, const Vec3<hn::Vec<D>>& lost) {
  auto to_point = plain.to_point + lost;
#if !HWY_NATIVE_FMA
  // The projection subtracted rounded products, which may be as large as the distance.
  const auto product_error = [&](auto x) {
    return math::HWY_NAMESPACE::product_error(D(), x, plain.distance, x * plain.distance);
  };
  const auto& along = ray.direction;
  to_point = to_point - Vec3<hn::Vec<D>>{product_error(along.x), product_error(along.y), product_error(along.z)};
#endif
  // With a distant origin, the vector keeps a component along the ray; project it out once more.
  const auto rest = dot(to_point, ray.direction) * ray.inverse_square;
  return {plain.distance + rest, neg_mul_add(ray.direction, rest, to_point)};
}

/// Refines a plain chord with the rounding errors of the difference and of the projection, and a second projection.
///
/// Precision  test Extremes.HitOrMissAndHitPointError, against MPFR
template <class D>
HWY_INLINE Chord<D> compensated(const Rays<D>& ray, const Spheres<D>& sphere, const Chord<D>& plain) {
  const auto lost = difference_error(sphere.center, ray.origin, sphere.center - ray.origin);
  const auto at = refined<D>(ray, {plain.middle, plain.to_center}, lost - ray.origin_low);
  return {at.distance, discriminant<D>(sphere.radius, at.to_point), at.to_point};
}

template <class D, bool kCompensated>
HWY_INLINE Chord<D> chord(const Rays<D>& ray, const Spheres<D>& sphere) {
  const auto plain = plain_chord(ray, sphere);
  if constexpr (kCompensated) return compensated(ray, sphere, plain);
  return plain;
}

/// Conservative test of the uncompensated discriminant: lanes that fail it miss even after compensation.
///
/// With centre c and rounded origin o, the error of to_center has two parts: the subtraction, with the rounding error
/// of the origin, contributes at most 2^-53 (|c-o| + |o|), where |o| <= |c-o| + |c|; the projection about 2^-51 |c-o|.
/// Since |to_center| <= |c-o|, the error of the discriminant is at most 2 |c-o| times their sum, plus its own rounding
/// near zero, where the radius is about |to_center|: less than 2^-47 (|c-o|^2 + |c|^2) in total. The margin is four
/// times that.
template <class D>
HWY_INLINE hn::Mask<D> may_intersect(D d, const Rays<D>& ray, const Spheres<D>& sphere, const Chord<D>& plain) {
  const auto to_sphere = sphere.center - ray.origin;
  const auto reach = dot(to_sphere, to_sphere) + dot(sphere.center, sphere.center);
  const auto margin = set(d, 0x1p-45);
  return mul_add(reach, margin, plain.discriminant) >= 0;
}

/// Distances along rays, as multiples of their directions' lengths; valid in the lanes of `mask`.
template <class D>
struct Distances {
  hn::Vec<D> value;
  hn::Mask<D> mask;
};

/// The closest intersection of each ray with its sphere beyond the ray's origin.
///
/// A ray that starts on the sphere can hit it again only at the other end of the chord: the root at its origin is
/// divided out of the quadratic, so that rounding errors cannot produce a self-intersection. For all other spheres the
/// distance is strictly positive.
template <class D, Precision kPrecision>
HWY_INLINE Distances<D> closest_distance(D d, const Rays<D>& ray, const Spheres<D>& sphere, hn::Mask<D> is_self) {
  const auto zero = hn::Zero(d);
  if constexpr (kPrecision == Precision::kBook) {
    const auto oc = ray.origin - sphere.center;
    const auto a = dot(ray.direction, ray.direction);
    const auto half_b = dot(oc, ray.direction);
    const auto c = dot(oc, oc) - sphere.radius * sphere.radius;
    const auto discriminant = half_b * half_b - a * c;
    const auto hits = discriminant >= 0;
    if (hn::MaxLanes(D()) == 1 && hn::AllFalse(d, hits)) return {zero, hits};
    const auto root = hn::Sqrt(max(discriminant, 0));
    // In multiples of the direction's length, which is 1 except for shadow rays.
    const auto t_min = kBookShortestDistance * hn::Sqrt(ray.inverse_square);
    const auto entry = (-half_b - root) / a;
    const auto exit = (root - half_b) / a;
    const auto t = select(entry >= t_min, entry, exit);
    return {t, hn::And(hits, t >= t_min)};
  } else {
    auto c = plain_chord(ray, sphere);
    if constexpr (kPrecision == Precision::kExact) {
      // In the naive list a ray misses nearly all spheres, and compensation costs more than everything before it.
      if (hn::MaxLanes(D()) == 1 && hn::AllFalse(d, hn::Or(is_self, may_intersect(d, ray, sphere, c))))
        return {zero, is_self};
      c = compensated(ray, sphere, c);
    }
    const auto hits = hn::Or(is_self, c.discriminant >= 0);
    // In the naive list a ray misses nearly all spheres, and the root costs as much as everything before it.
    if (hn::MaxLanes(D()) == 1 && hn::AllFalse(d, hits)) return {zero, hits};
    const auto half = hn::Sqrt(max(c.discriminant, 0) * ray.inverse_square);
    const auto entry = c.middle - half;
    const auto exit = c.middle + half;
    const auto other_end = dot(ray.direction, ray.offset) * ray.inverse_square * -2;
    const auto t = select(is_self, other_end, select(entry > 0, entry, exit));
    return {t, hn::And(hits, t > 0)};
  }
}

/// A hit point relative to the sphere's centre.
template <class V>
struct HitPoint {
  Vec3<V> offset;   ///< from the centre to the point; its length is the radius, to rounding
  Vec3<V> outward;  ///< the offset as a unit vector
};

/// Refines the distance to the other end of the chord for a ray that starts on the sphere: removes the component of
/// to_center along the ray, as `compensated` does for other spheres.
template <class D, Precision kPrecision>
HWY_INLINE hn::Vec<D> own_distance(const Rays<D>& ray, hn::Vec<D> distance) {
  if constexpr (kPrecision != Precision::kExact) return distance;
  const auto middle = mul_add(ray.direction, distance * 0.5, ray.offset);
  const auto rest = dot(middle, ray.direction) * ray.inverse_square;
  return neg_mul_add(rest, 2, distance);
}

/// The hit point at a distance that `closest_distance` returned.
///
/// Domain     lanes whose rays hit this sphere
template <class D, Precision kPrecision>
HWY_INLINE HitPoint<hn::Vec<D>> hit_point(const Rays<D>& ray, const Spheres<D>& sphere, hn::Mask<D> is_self,
                                          hn::Vec<D> distance) {
  if constexpr (kPrecision == Precision::kBook) {
    const auto m = mul_add(ray.direction, distance, ray.origin) - sphere.center;
    return {m, m * (1 / sphere.radius)};
  } else {
    const auto c = chord<D, kPrecision == Precision::kExact>(ray, sphere);
    const auto half = hn::Sqrt(max(c.discriminant, 0) * ray.inverse_square);
    const auto along = select(c.middle - half > 0, -half, half);
    const auto other = mul_add(ray.direction, along, negated(c.to_center));
    const auto own = mul_add(ray.direction, own_distance<D, kPrecision>(ray, distance), ray.offset);
    const auto m = select(is_self, own, other);
    const auto length = hn::Sqrt(dot(m, m));
    return {m * (sphere.radius / length), m * (1 / length)};
  }
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
