// SPDX-License-Identifier: Apache-2.0
// What a surface does with a ray. Compiled once per instruction set.
#if defined(ORRERY_KERNEL_SCATTER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_KERNEL_SCATTER_INL_H_
#undef ORRERY_KERNEL_SCATTER_INL_H_
#else
#define ORRERY_KERNEL_SCATTER_INL_H_
#endif

#include <hwy/highway.h>

#include "kernel/intersect-inl.h"
#include "kernel/material.h"
#include "kernel/sample-inl.h"
#include "kernel/sampler-inl.h"
#include "kernel/scene_view.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// The surface points that a vector of rays has reached, and their materials.
template <class D>
struct Surface {
  using V = hn::Vec<D>;
  Vec3<V> direction;  ///< of the arriving rays, unit
  Vec3<V> offset;     ///< from the sphere's centre to the point
  Vec3<V> normal;     ///< unit, against the arriving ray
  hn::Mask<D> from_outside;
  V fuzz;
  V eta;  ///< dielectric: index on the ray's side / index beyond
  V r0;   ///< dielectric: Schlick's constant for this side
  hn::Vec<IdTag<D>> kind, fresnel;

  /// Whether a direction points to the side that the ray came from. It asks the very question that the next
  /// intersection will ask (the sign of direction . offset), so that no ray starts on the wrong side of its sphere.
  HWY_INLINE hn::Mask<D> same_side(D d, const Vec3<V>& w) const {
    const auto outward = dot(w, offset);
    return hn::Or(hn::And(from_outside, outward > hn::Zero(d)), hn::AndNot(from_outside, outward < hn::Zero(d)));
  }
  HWY_INLINE hn::Mask<D> other_side(D d, const Vec3<V>& w) const {
    const auto outward = dot(w, offset);
    return hn::Or(hn::And(from_outside, outward < hn::Zero(d)), hn::AndNot(from_outside, outward > hn::Zero(d)));
  }
};

/// Where the rays go on.
template <class D>
struct Scattered {
  Vec3<hn::Vec<D>> direction;  ///< unit
  hn::Mask<D> alive;           ///< false: absorbed
};

/// Lanes whose id-wide value equals an enumerator.
template <class D, class E>
HWY_INLINE hn::Mask<D> is_kind(D d, hn::Vec<IdTag<D>> kinds, E kind) {
  const IdTag<D> du;
  return hn::RebindMask(d, kinds == hn::Set(du, static_cast<hn::TFromD<decltype(du)>>(kind)));
}

/// Cosine-weighted: the tip of a unit vector around the tip of the normal.
template <class D>
HWY_INLINE Vec3<hn::Vec<D>> scatter_lambertian(D d, const Surface<D>& at, const Vec3<hn::Vec<D>>& on_sphere) {
  const auto w = normalized(d, at.normal + on_sphere);
  // Where the two cancel there is no direction left; the normal is as good as any.
  return select(at.same_side(d, w), w, at.normal);
}

/// Uniform over the hemisphere.
template <class D>
HWY_INLINE Vec3<hn::Vec<D>> scatter_hemisphere(D d, const Surface<D>& at, const Vec3<hn::Vec<D>>& on_sphere) {
  const auto w = select(at.same_side(d, on_sphere), on_sphere, negated(on_sphere));
  return select(at.same_side(d, w), w, at.normal);
}

template <class D>
HWY_INLINE Vec3<hn::Vec<D>> mirrored(D d, const Surface<D>& at) {
  using T = hn::TFromD<D>;
  const auto w = normalized(d, neg_mul_add(at.normal, dot(at.direction, at.normal) * hn::Set(d, T(2)), at.direction));
  return select(at.same_side(d, w), w, at.normal);
}

/// Fuzzy reflection: the tip of the unit mirror direction is moved to the surface of a sphere around it, of radius
/// `fuzz`. Directions below the surface are absorbed.
///
/// Where fuzz is 1 the sum may vanish; the result is then no number, which is on no side, so the path is absorbed.
///
/// Reference  shirley2024, "Fuzzy Reflection"
template <class D, class V = hn::Vec<D>>
HWY_INLINE Scattered<D> scatter_metal(D d, const Surface<D>& at, const Vec3<V>& on_sphere) {
  const auto mirror = mirrored(d, at);
  const auto w = normalized(d, mul_add(on_sphere, at.fuzz, mirror));
  const auto sharp = at.fuzz == hn::Zero(d);
  return {select(sharp, mirror, w), hn::Or(sharp, at.same_side(d, w))};
}

/// The reflectance of the chosen model; the share of light that does not enter.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V reflectance(D d, const Surface<D>& at, V cos_arriving, V cos_leaving) {
  using T = hn::TFromD<D>;
  const V one = hn::Set(d, T(1));
  // Schlick as the book has it: with the arriving ray's cosine, on both sides.
  const V x = one - cos_arriving;
  const V x2 = x * x;
  const V schlick = hn::MulAdd(one - at.r0, x2 * x2 * x, at.r0);
  const V s = (at.eta * cos_arriving - cos_leaving) / (at.eta * cos_arriving + cos_leaving);
  const V p = (cos_arriving - at.eta * cos_leaving) / (cos_arriving + at.eta * cos_leaving);
  const V exact = hn::MulAdd(s, s, p * p) * hn::Set(d, static_cast<T>(0.5));
  return hn::IfThenElse(is_kind(d, at.fresnel, FresnelKind::kExact), exact,
                        hn::IfThenElseZero(is_kind(d, at.fresnel, FresnelKind::kSchlick), schlick));
}

/// Reflects where u is below the reflectance, refracts elsewhere.
///
/// Reference  Snell's law in the form with cos^2 that loses nothing near an index ratio of one
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> scatter_dielectric(D d, const Surface<D>& at, V u) {
  using T = hn::TFromD<D>;
  const V zero = hn::Zero(d), one = hn::Set(d, T(1));
  const V cos_arriving = hn::Min(hn::Neg(dot(at.direction, at.normal)), one);
  const V cos2 = cos_arriving * cos_arriving;
  const V leaving2 = hn::MulAdd((one - at.eta) * (one + at.eta), one - cos2, cos2);
  const V cos_leaving = hn::Sqrt(hn::Max(leaving2, zero));
  const auto w = normalized(d, at.direction * at.eta + at.normal * (at.eta * cos_arriving - cos_leaving));
  const auto refracted = select(at.other_side(d, w), w, negated(at.normal));
  const auto reflects = hn::Or(leaving2 < zero, u < reflectance(d, at, cos_arriving, cos_leaving));
  return select(reflects, mirrored(d, at), refracted);
}

/// Scatters every ray by its material, with the first two of the vertex's random numbers.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Scattered<D> scatter(D d, const Features& features, const Surface<D>& at, const Four<V>& random) {
  Scattered<D> out{at.normal, hn::FirstN(d, hn::Lanes(d))};
  const Vec3<V> on_sphere = sample_unit_sphere(d, random.v[0], random.v[1]);
  const auto among = [&](MaterialKind kind) { return is_kind(d, at.kind, kind); };
  out.direction = select(among(MaterialKind::kLambertian), scatter_lambertian(d, at, on_sphere), out.direction);
  if (features.hemisphere)
    out.direction = select(among(MaterialKind::kHemisphere), scatter_hemisphere(d, at, on_sphere), out.direction);
  const auto metal = among(MaterialKind::kMetal);
  if (!hn::AllFalse(d, metal)) {
    const auto scattered = scatter_metal(d, at, on_sphere);
    out.direction = select(metal, scattered.direction, out.direction);
    out.alive = hn::Or(hn::AndNot(metal, out.alive), hn::And(metal, scattered.alive));
  }
  const auto glass = among(MaterialKind::kDielectric);
  if (!hn::AllFalse(d, glass)) out.direction = select(glass, scatter_dielectric(d, at, random.v[0]), out.direction);
  return out;
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
