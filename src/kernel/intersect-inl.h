// SPDX-License-Identifier: Apache-2.0
// Where a ray meets a sphere. Compiled once per instruction set, for any number of lanes, in double or float.
#if defined(ORRERY_KERNEL_INTERSECT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_KERNEL_INTERSECT_INL_H_
#undef ORRERY_KERNEL_INTERSECT_INL_H_
#else
#define ORRERY_KERNEL_INTERSECT_INL_H_
#endif

#include <hwy/highway.h>

#include "kernel/precision.h"
#include "kernel/ray_packet.h"
#include "math/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using namespace math::HWY_NAMESPACE;  // NOLINT(google-build-using-namespace): one room's lanes in another's text

/// Unsigned lanes as wide as D's: ids and random bits beside the numbers they belong to.
template <class D>
using IdTag = hn::RebindToUnsigned<D>;

/// One ray a lane; see RayPacketOf.
template <class D>
struct Rays {
  using V = hn::Vec<D>;
  Vec3<V> origin, origin_low, offset, direction;
  V inverse_square;
  hn::Vec<IdTag<D>> self;
};

/// Lanes `first` .. of a packet.
template <class D, class Packet>
HWY_INLINE Rays<D> load_rays(D d, const Packet& p, int first) {
  const auto at = [&](const auto& component) {
    return load3(d, component[0] + first, component[1] + first, component[2] + first);
  };
  return {at(p.origin),
          at(p.origin_low),
          at(p.offset),
          at(p.direction),
          hn::Load(d, p.inverse_square + first),
          hn::Load(IdTag<D>(), p.self + first)};
}

/// One sphere a lane, or the same in all.
template <class D>
struct Spheres {
  Vec3<hn::Vec<D>> center;
  hn::Vec<D> radius;
};

template <class D>
HWY_INLINE Spheres<D> broadcast(D d, const Sphere& s) {
  using T = hn::TFromD<D>;
  return {{hn::Set(d, static_cast<T>(s.x)), hn::Set(d, static_cast<T>(s.y)), hn::Set(d, static_cast<T>(s.z))},
          hn::Set(d, static_cast<T>(s.radius))};
}

/// A sphere at the times of the rays `first` .. of a packet.
///
/// Domain     `scene` has spheres, motion and moving_count as SceneView has them; something moves where kMoves
template <bool kMoves, class D, class Scene, class Packet>
HWY_INLINE Spheres<D> sphere_at(D d, const Scene& scene, std::uint32_t id, const Packet& packet, int first) {
  const auto at_opening = broadcast(d, scene.spheres[id]);
  if (!kMoves || id >= scene.moving_count) return at_opening;
  const auto change = broadcast(d, scene.motion[id]);
  const auto time = hn::Load(d, packet.time + first);
  return {mul_add(change.center, time, at_opening.center), hn::MulAdd(change.radius, time, at_opening.radius)};
}

/// The chord that a sphere cuts out of a ray's line, seen from the sphere's centre.
template <class D>
struct Chord {
  using V = hn::Vec<D>;
  V middle;           ///< distance of the chord's middle, in lengths of the direction
  V discriminant;     ///< radius^2 - |to_center|^2; the line meets the sphere where this is >= 0
  Vec3<V> to_center;  ///< from the middle to the sphere's centre; perpendicular to the direction
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE V discriminant(const V& radius, const Vec3<V>& to_center) {
  return hn::NegMulAdd(
      to_center.z, to_center.z,
      hn::NegMulAdd(to_center.y, to_center.y, hn::NegMulAdd(to_center.x, to_center.x, radius * radius)));
}

/// The perpendicular form: only differences are ever squared, so nothing large cancels.
///
/// Reference  haines2019, ch. 7
template <class D>
HWY_INLINE Chord<D> plain_chord(const Rays<D>& ray, const Spheres<D>& sphere) {
  const auto to_sphere = sphere.center - ray.origin;
  const auto middle = dot(to_sphere, ray.direction) * ray.inverse_square;
  const auto to_center = neg_mul_add(ray.direction, middle, to_sphere);
  return {middle, discriminant<D>(sphere.radius, to_center), to_center};
}

/// The same, with what rounding took from the difference, and a second projection.
///
/// Precision  test Extremes.HitOrMissAndHitPointError, against MPFR
template <class D>
HWY_INLINE Chord<D> compensated(const Rays<D>& ray, const Spheres<D>& sphere, const Chord<D>& plain) {
  const auto lost = difference_error(sphere.center, ray.origin, sphere.center - ray.origin);
  auto to_center = plain.to_center + (lost - ray.origin_low);
  // A far origin leaves a component along the ray in what should be perpendicular to it: take it out once more.
  const auto rest = dot(to_center, ray.direction) * ray.inverse_square;
  to_center = neg_mul_add(ray.direction, rest, to_center);
  return {plain.middle + rest, discriminant<D>(sphere.radius, to_center), to_center};
}

template <class D, bool kCompensated>
HWY_INLINE Chord<D> chord(const Rays<D>& ray, const Spheres<D>& sphere) {
  const auto plain = plain_chord(ray, sphere);
  if constexpr (kCompensated) return compensated(ray, sphere, plain);
  return plain;
}

/// Lanes whose lines may meet their spheres; the others surely do not, whatever compensation adds.
///
/// The plain form errs by less than 2^-47 (|to_sphere|^2 + |center|^2): the difference by 2^-53 of itself and of the
/// origin, which is no farther from home than both together; the projection by some 2^-51 of the difference.
template <class D>
HWY_INLINE hn::Mask<D> may_meet(D d, const Rays<D>& ray, const Spheres<D>& sphere, const Chord<D>& plain) {
  const auto to_sphere = sphere.center - ray.origin;
  const auto reach = dot(to_sphere, to_sphere) + dot(sphere.center, sphere.center);
  const auto margin = hn::Set(d, static_cast<hn::TFromD<D>>(0x1p-45));
  return hn::MulAdd(reach, margin, plain.discriminant) >= hn::Zero(d);
}

/// Distances along the ray, in lengths of its direction; only lanes in `mask` have one.
template <class D>
struct Distances {
  hn::Vec<D> value;
  hn::Mask<D> mask;
};

/// The nearest point beyond the origin where each ray meets its sphere.
///
/// A ray that starts on the sphere itself meets it again at one place only, the other end of the chord; its own
/// start is divided out of the quadratic and can't come back as a rounding error. Every other sphere: strictly > 0.
template <class D, Precision kPrecision>
HWY_INLINE Distances<D> nearest(D d, const Rays<D>& ray, const Spheres<D>& sphere, hn::Mask<D> is_self) {
  using T = hn::TFromD<D>;
  const auto zero = hn::Zero(d);
  if constexpr (kPrecision == Precision::kBook) {
    const auto oc = ray.origin - sphere.center;
    const auto a = dot(ray.direction, ray.direction);
    const auto half_b = dot(oc, ray.direction);
    const auto c = dot(oc, oc) - sphere.radius * sphere.radius;
    const auto discriminant = half_b * half_b - a * c;
    const auto meets = discriminant >= zero;
    if (hn::MaxLanes(D()) == 1 && hn::AllFalse(d, meets)) return {zero, meets};
    const auto root = hn::Sqrt(hn::Max(discriminant, zero));
    const auto t_min = hn::Set(d, static_cast<T>(kBookShortestDistance));
    const auto entry = (hn::Neg(half_b) - root) / a;
    const auto exit = (root - half_b) / a;
    const auto t = hn::IfThenElse(entry >= t_min, entry, exit);
    return {t, hn::And(meets, t >= t_min)};
  } else {
    auto c = plain_chord(ray, sphere);
    if constexpr (kPrecision == Precision::kExact) {
      // A ray of the naive list misses nearly all spheres, and compensation takes longer than all that came before.
      if (hn::MaxLanes(D()) == 1 && hn::AllFalse(d, hn::Or(is_self, may_meet(d, ray, sphere, c))))
        return {zero, is_self};
      c = compensated(ray, sphere, c);
    }
    const auto meets = hn::Or(is_self, c.discriminant >= zero);
    // A ray of the naive list misses nearly all spheres, and a root takes as long as all that came before.
    if (hn::MaxLanes(D()) == 1 && hn::AllFalse(d, meets)) return {zero, meets};
    const auto half = hn::Sqrt(hn::Max(c.discriminant, zero) * ray.inverse_square);
    const auto entry = c.middle - half;
    const auto exit = c.middle + half;
    const auto other_end = dot(ray.direction, ray.offset) * ray.inverse_square * hn::Set(d, static_cast<T>(-2));
    const auto t = hn::IfThenElse(is_self, other_end, hn::IfThenElse(entry > zero, entry, exit));
    return {t, hn::And(meets, t > zero)};
  }
}

/// Where a ray meets its sphere, seen from the sphere's centre.
template <class V>
struct HitPoint {
  Vec3<V> offset;   ///< to the point; its length is one radius (to rounding)
  Vec3<V> outward;  ///< the same as a unit vector
};

/// A distance to the other end of the own chord, as `nearest` computes it, freed of most of its rounding: what is not
/// perpendicular to the ray in the chord's middle is taken out, as `chord` does for other spheres.
template <class D, Precision kPrecision>
HWY_INLINE hn::Vec<D> own_distance(D d, const Rays<D>& ray, hn::Vec<D> distance) {
  if constexpr (kPrecision != Precision::kExact) return distance;
  using T = hn::TFromD<D>;
  const auto middle = mul_add(ray.direction, distance * hn::Set(d, static_cast<T>(0.5)), ray.offset);
  const auto rest = dot(middle, ray.direction) * ray.inverse_square;
  return hn::NegMulAdd(rest, hn::Set(d, static_cast<T>(2)), distance);
}

/// The point that belongs to a distance of `nearest`.
///
/// Domain     lanes where `nearest` found this sphere
template <class D, Precision kPrecision>
HWY_INLINE HitPoint<hn::Vec<D>> hit_point(D d, const Rays<D>& ray, const Spheres<D>& sphere, hn::Mask<D> is_self,
                                          hn::Vec<D> distance) {
  const auto zero = hn::Zero(d), one = hn::Set(d, static_cast<hn::TFromD<D>>(1));
  if constexpr (kPrecision == Precision::kBook) {
    const auto m = mul_add(ray.direction, distance, ray.origin) - sphere.center;
    return {m, m * (one / sphere.radius)};
  } else {
    const auto c = chord<D, kPrecision == Precision::kExact>(ray, sphere);
    const auto half = hn::Sqrt(hn::Max(c.discriminant, zero) * ray.inverse_square);
    const auto along = hn::IfThenElse(c.middle - half > zero, hn::Neg(half), half);
    const auto other = mul_add(ray.direction, along, negated(c.to_center));
    const auto own = mul_add(ray.direction, own_distance<D, kPrecision>(d, ray, distance), ray.offset);
    const auto m = select(is_self, own, other);
    const auto length = hn::Sqrt(dot(m, m));
    return {m * (sphere.radius / length), m * (one / length)};
  }
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
