// SPDX-License-Identifier: Apache-2.0
// Ray-rod intersection.
//
// The distance at which a ray enters the sphere around a point of the axis is a convex function of that point. So the
// rod's entry is that of the infinite cylinder, if that lies between the ends, or else that of the sphere at the end
// beyond which it lies: no second root is computed, and an entry through an end has the bits of the sphere there.
// Because a rod is opaque and convex, only the entry counts: a ray that leaves a rod, or another one that touches or
// overlaps it, needs neither an id nor an epsilon to avoid a hit at its own origin.
// Reference: docs/decisions/0034
#pragma once

#include <hwy/highway.h>

#include <cstddef>
#include <limits>

#include "kernel/gather-inl.h"
#include "kernel/intersect-inl.h"
#include "kernel/rod.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// One rod per lane, or one rod broadcast to all lanes.
template <class D>
struct Rods {
  Vec3<hn::Vec<D>> a, b;
  hn::Vec<D> radius;
};

template <class D>
HWY_INLINE Rods<D> broadcast(D d, const Rod& rod) {
  return {set3(d, rod.a), set3(d, rod.b), set(d, rod.radius)};
}

/// Loads a rod per lane from rows in memory.
template <class D, class RodOfLane>
HWY_INLINE Rods<D> gather_plain_rods(D d, RodOfLane rod_of_lane) {
  hn::Vec<D> a[4], b[4];
  gather4(
      d, [&](std::size_t i) { return rod_of_lane(i).a; }, a);
  gather4(
      d, [&](std::size_t i) { return rod_of_lane(i).b; }, b);
  return {{a[0], a[1], a[2]}, {b[0], b[1], b[2]}, a[3]};
}

/// Loads a rod per lane.
template <class D, class IndexOfLane>
HWY_INLINE Rods<D> gather_rods(D d, const RodArray& rods, IndexOfLane index_of_lane) {
  if (rods.bond_count == 0)
    return gather_plain_rods(d, [&](std::size_t i) -> const Rod& { return rods.plain[index_of_lane(i)]; });
  constexpr std::size_t kLanes = hn::MaxLanes(D());
  std::size_t index[kLanes];
  bool are_bonds = true;
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) {
    index[i] = index_of_lane(i);
    are_bonds = are_bonds & (index[i] >= rods.plain_count());
  }
  if (!are_bonds) {
    Rod rows[kLanes];
    for (std::size_t i = 0; i < hn::Lanes(d); ++i) rows[i] = rods[index[i]];
    return gather_plain_rods(d, [&](std::size_t i) -> const Rod& { return rows[i]; });
  }
  hn::Vec<D> a[4], b[4];
  gather_spheres(
      d, rods.spheres, [&](std::size_t i) { return rods.bond(index[i]).a; }, a);
  gather_spheres(
      d, rods.spheres, [&](std::size_t i) { return rods.bond(index[i]).b; }, b);
  HWY_ALIGN hn::TFromD<D> radii[kLanes];
  for (std::size_t i = 0; i < hn::Lanes(d); ++i)
    radii[i] = static_cast<hn::TFromD<D>>(rods.bond_radii[rods.bond(index[i]).radius]);
  return {{a[0], a[1], a[2]}, {b[0], b[1], b[2]}, hn::Load(d, radii)};
}

/// Rods that have changed by `time` times `change`.
template <class D>
HWY_INLINE Rods<D> moved(const Rods<D>& at_opening, const Rods<D>& change, hn::Vec<D> time) {
  return {mul_add(change.a, time, at_opening.a), mul_add(change.b, time, at_opening.b),
          mul_add(change.radius, time, at_opening.radius)};
}

/// A rod at the times of a packet's rays from `first` on.
template <class D, class Packet>
HWY_INLINE Rods<D> rod_at(D d, const RodArray& rods, std::size_t index, const Packet& packet, int first) {
  const auto at_opening = broadcast(d, rods[index]);
  if (!rods.moves(index)) return at_opening;
  return moved<D>(at_opening, broadcast(d, rods.change(index)), hn::Load(d, packet.time + first));
}

template <class V>
HWY_INLINE Vec3<V> cross(const Vec3<V>& a, const Vec3<V>& b) {
  return {hn::MulSub(a.y, b.z, a.z * b.y), hn::MulSub(a.z, b.x, a.x * b.z), hn::MulSub(a.x, b.y, a.y * b.x)};
}

/// The cross product with errors of about one rounding of each component, however much cancels.
///
/// Reference  kahan2004
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> accurate_cross(D d, const Vec3<V>& a, const Vec3<V>& b) {
  const auto minor = [&](V p, V q, V r, V s) {  // p q - r s
    const V subtracted = r * s;
#if HWY_NATIVE_FMA
    (void)d;
    return hn::MulSub(p, q, subtracted) + hn::NegMulAdd(r, s, subtracted);
#else
    const V kept = p * q, difference = kept - subtracted;
    const V errors =
        math::HWY_NAMESPACE::product_error(d, p, q, kept) - math::HWY_NAMESPACE::product_error(d, r, s, subtracted);
    return difference + (difference_error(kept, subtracted, difference) + errors);
#endif
  };
  return {minor(a.y, b.z, a.z, b.y), minor(a.z, b.x, a.x, b.z), minor(a.x, b.y, a.y, b.x)};
}

/// Clamps; `low` for NaN.
template <class V>
HWY_INLINE V clamped(V x, V low, V high) {
  return select(x > low, select(x < high, x, high), low);
}

/// The axes of rods, from a to b.
template <class D>
struct Axes {
  using V = hn::Vec<D>;
  Vec3<V> vector;  ///< exact: b - a. fast: unit, since squares of b - a could underflow in single precision; or 0
  Vec3<V> lost;    ///< exact: the rounding error of `vector`; fast: 0
  V length;        ///< exact: 1; fast: |b - a|. From a to b, in lengths of `vector`
};

template <class D, Precision kPrecision>
HWY_INLINE Axes<D> axes_of(D d, const Rods<D>& rod) {
  using V = hn::Vec<D>;
  const V zero = hn::Zero(d), one = set(d, 1);
  const auto along = rod.b - rod.a;
  if constexpr (kPrecision == Precision::kFast) {
    const V length = hn::Sqrt(dot(along, along));
    return {along * hn::IfThenElseZero(length > zero, one / length), {zero, zero, zero}, length};
  }
  return {along, difference_error(rod.b, rod.a, along), one};
}

/// Where the lines of rays enter rods.
template <class D>
struct RodEntry {
  using V = hn::Vec<D>;
  hn::Mask<D> hits;         ///< the line intersects the rod; the other members are valid in these lanes
  V distance;               ///< multiple of the direction's length, of either sign
  Vec3<V> from_axis;        ///< from the axis to the entry; its length is the radius, to rounding
  hn::Mask<D> from_b;       ///< `along` is measured from b, else from a
  V along, along_lost;      ///< position on the axis, in lengths of Axes::vector, with its rounding error; 0 at an end
  hn::Mask<D> second_half;  ///< nearer to b than to a
};

template <class D, Precision kPrecision>
HWY_INLINE RodEntry<D> rod_entry(D d, const Rays<D>& ray, const Rods<D>& rod) {
  using V = hn::Vec<D>;
  constexpr bool kCompensated = kPrecision != Precision::kFast;
  const V zero = hn::Zero(d), one = set(d, 1);
  const Vec3<V>& direction = ray.direction;
  const auto axis = axes_of<D, kPrecision>(d, rod);
  const Vec3<V>& u = axis.vector;
  const V middle_of_axis = axis.length * 0.5;

  // Normal to both lines. It is zero if they are parallel; what is divided by it then is NaN, which no comparison
  // accepts.
  const auto normal =
      kCompensated ? accurate_cross(d, direction, u) + cross(direction, axis.lost) : cross(direction, u);
  const V inverse_normal2 = one / dot(normal, normal);
  const auto across_ray = cross(normal, direction) * ray.inverse_square;  // the part of u that is perpendicular to it
  const V inverse_across2 = inverse_normal2 * dot(direction, direction);

  // The point of the axis that is closest to the ray, measured from the end that is nearer to it.
  const V from_a = clamped<V>(-dot(rod.a - ray.origin, across_ray) * inverse_across2, zero, axis.length);
  const auto from_b = from_a > middle_of_axis;
  const V low = hn::IfThenElseZero(from_b, -axis.length), high = low + axis.length;
  const auto end = select(from_b, rod.b, rod.a);
  V closest = from_a + low;  // exact
  const auto to_end = end - ray.origin, step = u * closest, to_axis = to_end + step;
  const V projected = dot(to_axis, direction) * ray.inverse_square;
  Passage<D> at{projected, neg_mul_add(direction, projected, to_axis)};
  if constexpr (kCompensated) {
    const auto product_lost = [&](V x, V product) {
      return math::HWY_NAMESPACE::product_error(d, x, closest, product);
    };
    const Vec3<V> step_lost = {product_lost(u.x, step.x), product_lost(u.y, step.y), product_lost(u.z, step.z)};
    const auto lost = difference_error(end, ray.origin, to_end) - ray.origin_low;
    const auto of_axis = sum_error(to_end, step, to_axis) + mul_add(axis.lost, closest, step_lost);
    at = refined<D>(ray, at, lost + of_axis);
    // The same point again, from the refined vector.
    const V better = clamped<V>(neg_mul_add(dot(at.to_point, across_ray), inverse_across2, closest), low, high);
    const V moved = better - closest;
    closest = better;
    at.to_point = mul_add(across_ray, moved, at.to_point);
    at.distance = mul_add(moved, dot(direction, u) * ray.inverse_square, at.distance);
  }

  // Whether the line is closer to that point than the radius: to the cylinder, or beyond an end to the sphere there.
  const V height = dot(at.to_point, normal), height_by_normal = height * inverse_normal2;
  const V body_discriminant = neg_mul_add(height_by_normal, height, rod.radius * rod.radius);
  const auto is_between = hn::And(closest > low, closest < high);
  RodEntry<D> out;
  out.hits = select(is_between, body_discriminant, discriminant<D>(rod.radius, at.to_point)) >= zero;

  // The infinite cylinder. `across_axis` is the part of the direction that is perpendicular to u, times u.u.
  const auto across_axis = cross(u, normal);
  const V u2 = dot(u, u), inverse_u2 = one / u2;
  const V half = hn::Sqrt(max(body_discriminant, 0) * (u2 * inverse_normal2));
  const V ahead = hn::MulSub(dot(at.to_point, across_axis), inverse_normal2, half);
  const V change = hn::MulSub(ahead, dot(direction, u), dot(at.to_point, u)) * inverse_u2;
  const V along = closest + change;
  const auto is_body = hn::And(along > low, along < high);
  const V position = along - low;  // from a
  out.distance = at.distance + ahead;
  out.from_axis = neg_mul_add(across_axis, half * inverse_u2, normal * -height_by_normal);
  out.from_b = from_b;
  out.along = along;
  out.along_lost = kCompensated ? difference_error(closest, -change, along) : zero;
  out.second_half = position > middle_of_axis;
  if (hn::AllTrue(d, hn::Or(is_body, hn::Not(out.hits)))) return out;

  // Entries through an end. If the lines are parallel, the ray enters at the end that it meets first.
  const auto is_parallel = hn::Not(position == position);
  const auto at_b = hn::Or(out.second_half, hn::And(is_parallel, dot(direction, u) < zero));
  const auto c = chord<D, kCompensated>(ray, Spheres<D>{select(at_b, rod.b, rod.a), rod.radius});
  const V half_chord = hn::Sqrt(max(c.discriminant, 0) * ray.inverse_square);
  out.distance = select(is_body, out.distance, c.middle - half_chord);
  out.from_axis = select(is_body, out.from_axis, neg_mul_add(direction, half_chord, negated(c.to_center)));
  out.along = hn::IfThenElseZero(is_body, out.along);
  out.along_lost = hn::IfThenElseZero(is_body, out.along_lost);
  out.from_b = hn::Or(hn::And(is_body, from_b), hn::AndNot(is_body, at_b));
  out.second_half = hn::Or(hn::And(is_body, out.second_half), hn::AndNot(is_body, at_b));
  return out;
}

/// Conservative test: lanes that fail it miss the infinite cylinder around the rod, whatever the rounding.
///
/// Two lines with the common normal w = d x u are |f.w| / |w| apart, f = a - o. With unit roundoff e, the rounding of
/// u, w, f, and of the origin, changes f.w by less than 16 e (|f| + |o| + |a| + |b|) |d| |u|, and |o| <= |f| + |a|; the
/// margin is at least twice that. Lanes in which |w|^2 underflows or the triple product overflows pass.
template <class D>
HWY_INLINE hn::Mask<D> may_hit(const Rays<D>& ray, const Rods<D>& rod) {
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  constexpr double kMargin = sizeof(T) == 8 ? 0x1p-47 : 0x1p-18;
  const auto norm1 = [](const Vec3<V>& v) { return hn::Abs(v.x) + hn::Abs(v.y) + hn::Abs(v.z); };
  const auto u = rod.b - rod.a, to_a = rod.a - ray.origin;
  const auto normal = cross(ray.direction, u);
  const V normal2 = dot(normal, normal);
  const V reach = norm1(to_a) + norm1(rod.a) + norm1(rod.b) + rod.radius;
  const V slack = reach * (norm1(u) * norm1(ray.direction)) * kMargin;
  const auto misses = hn::Abs(dot(to_a, normal)) - slack > rod.radius * hn::Sqrt(normal2);  // false for NaN
  return hn::Not(hn::And(misses, normal2 >= std::numeric_limits<T>::min()));
}

/// The entries of rays into rods beyond the rays' origins.
template <class D, Precision kPrecision>
HWY_INLINE RodEntry<D> closest_entry(D d, const Rays<D>& ray, const Rods<D>& rod) {
  auto entry = rod_entry<D, kPrecision>(d, ray, rod);
  entry.hits = hn::And(entry.hits, entry.distance > hn::Zero(d));
  return entry;
}

/// The sphere that has the rod's place at a hit, and the hit point relative to its centre.
template <class D>
struct RodPoint {
  Spheres<D> sphere;  ///< around the point of the axis; a or b, exactly, at the ends
  /// The offset contains the rounding error of the sphere's centre, so that the point is as accurate as on a sphere,
  /// wherever the rod is and however long.
  HitPoint<hn::Vec<D>> point;
};

/// The point where a ray enters a rod.
///
/// Domain     lanes whose rays hit the rod
/// Precision  test Rods.HitOrMissAndHitPointError, against 113 bits
template <class D, Precision kPrecision>
HWY_INLINE RodPoint<D> rod_point(D d, const Rays<D>& ray, const Rods<D>& rod) {
  using V = hn::Vec<D>;
  const auto entry = rod_entry<D, kPrecision>(d, ray, rod);
  const auto axis = axes_of<D, kPrecision>(d, rod);
  const auto end = select(entry.from_b, rod.b, rod.a);
  const Vec3<V>& u = axis.vector;
  const auto step = u * entry.along;
  const auto center = end + step;
  const V length = hn::Sqrt(dot(entry.from_axis, entry.from_axis));
  auto offset = entry.from_axis * (rod.radius / length);
  if constexpr (kPrecision != Precision::kFast) {
    const auto product_lost = [&](V x, V product) {
      return math::HWY_NAMESPACE::product_error(d, x, entry.along, product);
    };
    const Vec3<V> step_lost = {product_lost(u.x, step.x), product_lost(u.y, step.y), product_lost(u.z, step.z)};
    const auto lost = mul_add(axis.lost, entry.along, mul_add(u, entry.along_lost, step_lost));
    offset = offset + (sum_error(end, step, center) + lost);
  }
  return {{center, rod.radius}, {offset, entry.from_axis * (1 / length)}};
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
