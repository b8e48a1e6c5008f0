// SPDX-License-Identifier: Apache-2.0
// BSDFs: sampling, density and value.
#pragma once

#include <hwy/highway.h>

#include <cstddef>
#include <iterator>
#include <type_traits>
#include <utility>

#include "kernel/intersect-inl.h"
#include "kernel/material.h"
#include "kernel/sampler-inl.h"
#include "kernel/scene_view.h"
#include "math/functions-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// Hit points, one per lane, and their materials.
template <class D>
struct Surface {
  using V = hn::Vec<D>;
  Vec3<V> direction;  ///< direction of the arriving ray, unit
  Vec3<V> offset;     ///< from the sphere's centre to the point
  Vec3<V> normal;     ///< unit, facing the arriving ray
  hn::Mask<D> from_outside;
  V fuzz;
  V eta;  ///< dielectric: index on the ray's side / index beyond
  V r0;   ///< dielectric, plastic: Schlick's constant for this side
  hn::Vec<IdTag<D>> kind, fresnel;

  /// Whether a direction points to the side that the ray came from. This is the test of the next intersection (the sign
  /// of direction . offset), so no ray starts on the wrong side of its sphere.
  HWY_INLINE hn::Mask<D> same_side(const Vec3<V>& w) const {
    const auto outward = dot(w, offset);
    return hn::Or(hn::And(from_outside, outward > 0), hn::AndNot(from_outside, outward < 0));
  }
  HWY_INLINE hn::Mask<D> other_side(const Vec3<V>& w) const {
    const auto outward = dot(w, offset);
    return hn::Or(hn::And(from_outside, outward < 0), hn::AndNot(from_outside, outward > 0));
  }
};

/// Sampled directions, one per lane.
template <class D>
struct BsdfSample {
  Vec3<hn::Vec<D>> direction;                ///< unit
  hn::Mask<D> alive;                         ///< false: absorbed
  hn::Mask<D> in_coat = hn::FirstN(D(), 0);  ///< scattered by the coat of plastic
};

inline constexpr double kTwoPi = 6.283185307179586476925;

/// Mask of the lanes whose kind is `kind`. Kinds are stored at the width of sphere ids.
template <class D, class E>
HWY_INLINE hn::Mask<D> is_kind(D d, hn::Vec<IdTag<D>> kinds, E kind) {
  return hn::RebindMask(d, kinds == kind);
}

/// Lanes whose material has a trait.
template <bool MaterialTraits::*kTrait, class D>
HWY_INLINE hn::Mask<D> has_trait(D d, const Surface<D>& at) {
  const auto any_of = [&]<std::size_t... kKinds>(std::index_sequence<kKinds...>) {
    hn::Mask<D> out = hn::FirstN(d, 0);
    const auto add = [&]<std::size_t kKind>(std::integral_constant<std::size_t, kKind>) {
      if constexpr (kMaterialTraits[kKind].*kTrait)
        out = hn::Or(out, is_kind(d, at.kind, static_cast<MaterialKind>(kKind)));
    };
    (add(std::integral_constant<std::size_t, kKinds>()), ...);
    return out;
  };
  return any_of(std::make_index_sequence<std::size(kMaterialTraits)>());
}

/// Lanes whose material is delta; see pdf_bsdf.
template <class D>
HWY_INLINE hn::Mask<D> is_delta(D d, const Surface<D>& at) {
  const auto sharp = hn::And(has_trait<&MaterialTraits::is_sharp_delta>(d, at), at.fuzz == 0);
  return hn::Or(sharp, has_trait<&MaterialTraits::is_delta>(d, at));
}

/// Lanes whose scattered direction passes through the surface.
///
/// Space      w unit
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> is_transmitted(D d, const Surface<D>& at, const Vec3<V>& w) {
  return hn::AndNot(at.same_side(w), has_trait<&MaterialTraits::transmits>(d, at));
}

/// A point on the unit sphere, uniform by area.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> sample_unit_sphere(D d, V u, V v) {
  const V radius = hn::Sqrt(u * (1 - u)) * 2;  // radius of the circle at height 1 - 2u
  const auto turn = sin_cos_turn(d, v);
  return {radius * turn.cos, radius * turn.sin, 1 - (u + u)};
}

/// Samples the cosine-weighted hemisphere: the normal plus a point of the unit sphere, normalized.
template <class D>
HWY_INLINE Vec3<hn::Vec<D>> sample_lambertian(const Surface<D>& at, const Vec3<hn::Vec<D>>& on_sphere) {
  const auto w = normalized(at.normal + on_sphere);
  // If the two cancel, any direction will do.
  return select(at.same_side(w), w, at.normal);
}

/// Samples the hemisphere uniformly.
template <class D>
HWY_INLINE Vec3<hn::Vec<D>> sample_hemisphere(const Surface<D>& at, const Vec3<hn::Vec<D>>& on_sphere) {
  const auto w = select(at.same_side(on_sphere), on_sphere, negated(on_sphere));
  return select(at.same_side(w), w, at.normal);
}

/// The unit mirror direction of the arriving ray.
template <class D>
HWY_INLINE Vec3<hn::Vec<D>> reflected(const Surface<D>& at) {
  const auto w = normalized(neg_mul_add(at.normal, dot(at.direction, at.normal) * 2, at.direction));
  return select(at.same_side(w), w, at.normal);
}

/// Samples fuzzy reflection: the direction to a point on the sphere of radius `fuzz` around the tip of the unit mirror
/// direction. Directions below the surface are absorbed.
///
/// If fuzz is 1, the sum may vanish. The direction is then NaN, which is on neither side, so the path is absorbed.
///
/// Reference  shirley2024, "Fuzzy Reflection"
template <class D, class V = hn::Vec<D>>
HWY_INLINE BsdfSample<D> sample_metal(const Surface<D>& at, const Vec3<V>& on_sphere) {
  const auto mirror = reflected(at);
  const auto w = normalized(mul_add(on_sphere, at.fuzz, mirror));
  const auto sharp = at.fuzz == 0;
  return {select(sharp, mirror, w), hn::Or(sharp, at.same_side(w))};
}

/// Schlick's approximation of the Fresnel reflectance.
///
/// Reference  schlick1994
template <class V>
HWY_INLINE V schlick(V r0, V cosine) {
  const V x = 1 - cosine;
  const V x2 = x * x;
  return mul_add(1 - r0, x2 * x2 * x, r0);
}

/// The Fresnel reflectance according to the material's model.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V reflectance(D d, const Surface<D>& at, V cos_arriving, V cos_leaving) {
  const V s = (at.eta * cos_arriving - cos_leaving) / (at.eta * cos_arriving + cos_leaving);
  const V p = (cos_arriving - at.eta * cos_leaving) / (cos_arriving + at.eta * cos_leaving);
  const V exact = mul_add(s, s, p * p) * 0.5;
  // As in the book, Schlick's approximation uses the cosine of the arriving ray on both sides.
  return select(is_kind(d, at.fresnel, FresnelKind::kExact), exact,
                hn::IfThenElseZero(is_kind(d, at.fresnel, FresnelKind::kSchlick), schlick(at.r0, cos_arriving)));
}

/// The direction that a smooth dielectric refracts to, and whether and how much it reflects.
template <class D>
struct Refraction {
  Vec3<hn::Vec<D>> direction;  ///< unit
  hn::Vec<D> reflectance;      ///< undefined under total internal reflection
  hn::Mask<D> is_total;
};

/// Uses the form of Snell's law with cos^2, which does not cancel near an index ratio of one.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Refraction<D> refraction(D d, const Surface<D>& at) {
  const V cos_arriving = min(-dot(at.direction, at.normal), 1);
  const V cos2 = cos_arriving * cos_arriving;
  const V leaving2 = mul_add((1 - at.eta) * (1 + at.eta), 1 - cos2, cos2);
  const V cos_leaving = hn::Sqrt(max(leaving2, 0));
  const auto w = normalized(at.direction * at.eta + at.normal * (at.eta * cos_arriving - cos_leaving));
  return {select(at.other_side(w), w, negated(at.normal)), reflectance(d, at, cos_arriving, cos_leaving), leaving2 < 0};
}

/// Samples a smooth dielectric: reflects if u is below the reflectance, else refracts.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> sample_dielectric(D d, const Surface<D>& at, V u) {
  const auto glass = refraction(d, at);
  const auto reflects = hn::Or(glass.is_total, u < glass.reflectance);
  return select(reflects, reflected(at), glass.direction);
}

/// A choice between two events by a uniform number.
template <class D>
struct Choice {
  hn::Mask<D> is_first;
  hn::Vec<D> rest;  ///< the number rescaled to be uniform in 0..1 again
};

/// Chooses the first event if u is below its probability.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Choice<D> choose(D, V u, V probability) {
  const auto is_first = u < probability;
  const V rest = select(is_first, u, u - probability) / select(is_first, probability, 1 - probability);
  return {is_first, min(rest, 1)};
}

/// Samples a rough dielectric: the direction of a smooth one, perturbed like that of a fuzzy metal. Directions on the
/// wrong side of the surface are absorbed.
template <class D, class V = hn::Vec<D>>
HWY_INLINE BsdfSample<D> sample_rough_dielectric(D d, const Surface<D>& at, V u, V v) {
  const auto glass = refraction(d, at);
  const auto reflects = choose(d, u, select(glass.is_total, 1, glass.reflectance));
  const auto axis = select(reflects.is_first, reflected(at), glass.direction);
  const auto w = normalized(mul_add(sample_unit_sphere(d, reflects.rest, v), at.fuzz, axis));
  const auto sharp = at.fuzz == 0;
  const auto same_side = at.same_side(w), other_side = at.other_side(w);
  const auto stays = hn::Or(hn::And(reflects.is_first, same_side), hn::AndNot(reflects.is_first, other_side));
  return {select(sharp, axis, w), hn::Or(sharp, stays)};
}

/// Fuzz of a coat below which its lobe counts as delta: rounding of a float's direction would change the density by
/// more than a percent, and light sampling would not find so narrow a lobe.
inline constexpr double kSharpCoat = 1e-4;

/// The probability that plastic scatters in its coat: the Fresnel reflectance at the angle of the arriving ray. The
/// base scatters the rest, so that both together lose nothing.
template <class D>
HWY_INLINE hn::Vec<D> coat_share(const Surface<D>& at) {
  return schlick(at.r0, max(min(-dot(at.direction, at.normal), 1), 0));
}

/// 1 - cos of the angle between the mirror direction and the rim of the coat's lobe. Its mean square sine is that of a
/// fuzzy metal to first order in fuzz^2, 2/3 fuzz^2.
template <class D>
HWY_INLINE hn::Vec<D> rim_of_coat(const Surface<D>& at) {
  return at.fuzz * at.fuzz * (5.0 / 3);
}

/// Samples the coat of plastic. With versine t = (1 - cos) of the angle to the mirror direction and that of the rim T,
/// the density is 2 / (pi T) (1 - t / T)^3, which is smooth, unlike that of fuzzy metal: a highlight has no rim.
/// Directions below the surface are mirrored to the side above it, so none is absorbed.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> sample_coat(D d, const Surface<D>& at, V u, V v) {
  const auto axis = reflected(at);
  const V versine = (1 - hn::Sqrt(hn::Sqrt(u))) * rim_of_coat(at);
  const V sine = hn::Sqrt(versine * (2 - versine));
  const auto frame = frame_around(d, axis);
  const auto turn = sin_cos_turn(d, v);
  const auto w = mul_add(frame.x, sine * turn.cos, mul_add(frame.y, sine * turn.sin, axis * (1 - versine)));
  const auto above = select(at.same_side(w), w, neg_mul_add(at.normal, dot(w, at.normal) * 2, w));
  return select(at.same_side(above), above, at.normal);
}

/// Samples plastic: the coat with the probability coat_share, else the base, which scatters like a Lambertian surface.
template <class D, class V = hn::Vec<D>>
HWY_NOINLINE BsdfSample<D> sample_plastic(D d, Surface<D> at, V u, V v) {
  const auto lobe = choose(d, u, coat_share(at));
  const auto base = sample_lambertian(at, sample_unit_sphere(d, lobe.rest, v));
  return {select(lobe.is_first, sample_coat(d, at, lobe.rest, v), base), hn::FirstN(d, hn::Lanes(d)), lobe.is_first};
}

/// Samples every lane's BSDF with the first two random numbers of its vertex.
template <class D, class V = hn::Vec<D>>
HWY_INLINE BsdfSample<D> sample_bsdf(D d, const Features& features, const Surface<D>& at, const Four<V>& random) {
  BsdfSample<D> out{at.normal, hn::FirstN(d, hn::Lanes(d))};
  const Vec3<V> on_sphere = sample_unit_sphere(d, random.v[0], random.v[1]);
  const auto among = [&](MaterialKind kind) { return is_kind(d, at.kind, kind); };
  out.direction = select(among(MaterialKind::kLambertian), sample_lambertian(at, on_sphere), out.direction);
  if (features.hemisphere)
    out.direction = select(among(MaterialKind::kHemisphere), sample_hemisphere(at, on_sphere), out.direction);
  const auto metal = among(MaterialKind::kMetal);
  if (!hn::AllFalse(d, metal)) {
    const auto sampled = sample_metal(at, on_sphere);
    out.direction = select(metal, sampled.direction, out.direction);
    out.alive = hn::Or(hn::AndNot(metal, out.alive), hn::And(metal, sampled.alive));
  }
  const auto glass = among(MaterialKind::kDielectric);
  if (!hn::AllFalse(d, glass)) {
    if (features.rich_materials) {  // it may be rough
      const auto sampled = sample_rough_dielectric(d, at, random.v[0], random.v[1]);
      out.direction = select(glass, sampled.direction, out.direction);
      out.alive = hn::Or(hn::AndNot(glass, out.alive), hn::And(glass, sampled.alive));
    } else {
      out.direction = select(glass, sample_dielectric(d, at, random.v[0]), out.direction);
    }
  }
  const auto plastic = among(MaterialKind::kPlastic);
  if (features.rich_materials && !hn::AllFalse(d, plastic)) {
    const auto sampled = sample_plastic(d, at, random.v[0], random.v[1]);
    out.direction = select(plastic, sampled.direction, out.direction);
    out.in_coat = hn::And(plastic, sampled.in_coat);
  }
  return out;
}

/// The density of sample_metal's directions before absorption, per steradian; zero for fuzz 0.
///
/// With c and s the cosine and sine of the angle to the mirror direction and f the fuzz, it is
/// (c^2 + f^2 - s^2) / (2 pi f sqrt(f^2 - s^2)) inside the cone s < f, c > 0, and zero outside: the two points in
/// which the line along w intersects the sphere around the tip, each with t^2 / (4 pi f^2 |cosine at the sphere|). It
/// grows without bound towards the cone's rim and is integrable.
///
/// Precision  s^2 from the difference of the two unit vectors, since 1 - c^2 cancels for small fuzz
template <class D, class V = hn::Vec<D>>
HWY_INLINE V pdf_metal(D d, const Surface<D>& at, const Vec3<V>& w) {
  const auto between = w - reflected(at);
  const V versine_twice = dot(between, between);  // 2 - 2c
  const V s2 = versine_twice * neg_mul_add(versine_twice, set(d, 0.25), 1);
  const V rest = neg_mul_add(at.fuzz, at.fuzz, s2);  // s^2 - f^2, negative inside the cone
  const auto inside = hn::And(rest < 0, versine_twice < 2);
  const V density = (1 - s2 - rest) / (at.fuzz * hn::Sqrt(-rest) * kTwoPi);
  return hn::IfThenElseZero(inside, density);
}

/// The density with which sample_bsdf chooses a direction, per steradian. Zero for delta materials (metal without fuzz,
/// smooth dielectric). A rough dielectric counts as delta, so it is sampled by its BSDF alone. A fuzzy metal's density
/// integrates to the fraction that is not absorbed. For plastic this is the density of the base, see pdf_coat.
///
/// The BSDF times the cosine to the normal is albedo times this density, for every material that is not delta. Plastic
/// adds the density of its coat.
///
/// Space      w unit
template <class D, class V = hn::Vec<D>>
HWY_INLINE V pdf_bsdf(D d, const Features& features, const Surface<D>& at, const Vec3<V>& w) {
  const auto among = [&](MaterialKind kind) { return is_kind(d, at.kind, kind); };
  const V cosine = max(dot(w, at.normal), 0);
  V pdf = hn::IfThenElseZero(among(MaterialKind::kLambertian), cosine * (2 / kTwoPi));
  if (features.hemisphere) pdf = select(among(MaterialKind::kHemisphere), 1 / kTwoPi, pdf);
  const auto metal = among(MaterialKind::kMetal);
  if (!hn::AllFalse(d, metal)) pdf = select(metal, pdf_metal(d, at, w), pdf);
  const auto plastic = among(MaterialKind::kPlastic);
  if (features.rich_materials && !hn::AllFalse(d, plastic)) {
    const V base = (1 - coat_share(at)) * (cosine * (2 / kTwoPi));
    pdf = select(plastic, base, pdf);
  }
  return hn::IfThenElseZero(at.same_side(w), pdf);
}

/// The density with which sample_bsdf chooses the coat of plastic and a direction, per steradian. Zero for coats that
/// are delta.
///
/// A direction has been sampled by itself, or below the surface as its mirror image; the distance of that image to the
/// mirror direction is the one from the direction to the arriving ray's.
///
/// Space      w unit
/// Domain     all lanes may have any material, but the result is meaningful for plastic only
/// Precision  1 - cos from the difference of the two unit vectors
template <class D, class V = hn::Vec<D>>
HWY_NOINLINE V pdf_coat(Surface<D> at, Vec3<V> w) {
  const V rim = rim_of_coat(at);
  const auto lobe = [&](const Vec3<V>& between) {
    const V rest = max(1 - dot(between, between) * 0.5 / rim, 0);
    return rest * rest * rest;
  };
  const V sum = lobe(w - reflected(at)) + lobe(w - at.direction);
  const auto has_density = hn::And(at.same_side(w), at.fuzz >= kSharpCoat);
  return hn::IfThenElseZero(has_density, coat_share(at) * sum * (4 / kTwoPi) / rim);
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
