// SPDX-License-Identifier: Apache-2.0
// Textures at points of spheres.
#pragma once

#include <hwy/highway.h>

#include <cstddef>

#include "kernel/intersect-inl.h"
#include "kernel/lat_long-inl.h"
#include "kernel/material.h"
#include "kernel/noise-inl.h"
#include "kernel/precision.h"
#include "math/functions-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// Points on spheres, one per lane.
template <class D>
struct TexturePoint {
  Vec3<hn::Vec<D>> base, rest;  ///< their sum is the point in world space
  Vec3<hn::Vec<D>> outward;     ///< unit, from the sphere's centre
  hn::Vec<D> footprint2;        ///< squared width of the ray cone, seen from the sphere's centre, radians^2
};

/// The distance to the nearer intersection of a ray's line with a sphere whose surface is close to the ray's origin
/// compared with its radius.
///
/// |o - c|^2 - r^2 is summed with its rounding errors, and the quadratic's root is divided into it, so that the error
/// is relative to the distance, not to the radius.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V refined_distance(D d, const Rays<D>& ray, const Spheres<D>& sphere, V distance) {
  const V zero = hn::Zero(d);
  const auto from_center = ray.origin - sphere.center;
  const auto lost = difference_error(ray.origin, sphere.center, from_center) + ray.origin_low;
  V sum = zero, error = zero;
  const auto add = [&](V square, V square_lost) {
    const V total = sum + square;
    error = error + (difference_error(sum, -square, total) + square_lost);
    sum = total;
  };
  const auto add_square = [&](V a) {
    const V square = a * a;
    add(square, math::HWY_NAMESPACE::product_error(d, a, a, square));
  };
  const V radius2 = sphere.radius * sphere.radius;
  add(-radius2, -(math::HWY_NAMESPACE::product_error(d, sphere.radius, sphere.radius, radius2)));
  add_square(from_center.x);
  add_square(from_center.y);
  add_square(from_center.z);
  const V mixed = dot(from_center, lost);
  const V excess = sum + (error + (mixed + mixed));  // |o - c|^2 - r^2
  const V middle = dot(from_center, ray.direction) + dot(lost, ray.direction);
  const V half = hn::Sqrt(max(hn::MulSub(middle, middle, excess), 0));
  const V far = -(middle + hn::CopySign(half, middle));
  const V near = excess / far;
  // False for NaN.
  return select(hn::Abs(near - distance) < hn::Abs(far - distance), near, distance);
}

/// The points at which textures are evaluated for hits.
///
/// On a sphere that is small or far from the ray's origin, the point is the centre plus an offset. On a sphere that is
/// large compared with its distance, it is the ray's origin plus a vector: rounding errors of the offset would be
/// visible where a ground coincides with faces of checker cells.
///
/// `offset`, `outward`  see HitPoint
/// `footprint2`         see TexturePoint
/// Precision  docs/numerics.md, test KernelTexture.CellsOfCheckersAtAllRadii
template <class D, Precision kPrecision, class V = hn::Vec<D>>
HWY_INLINE TexturePoint<D> texture_point(D d, const Rays<D>& ray, const Spheres<D>& sphere, const Vec3<V>& offset,
                                         const Vec3<V>& outward, V distance, V footprint2) {
  if constexpr (kPrecision == Precision::kBook) return {ray.origin, ray.direction * distance, outward, footprint2};
  const auto reach = [&](const Vec3<V>& a) { return max<V>({hn::Abs(a.x), hn::Abs(a.y), hn::Abs(a.z)}); };
  const auto by_ray = distance + reach(ray.origin) < sphere.radius + reach(sphere.center);
  if (hn::AllFalse(d, by_ray)) return {sphere.center, offset, outward, footprint2};
  const V refined = refined_distance(d, ray, sphere, distance);
  return {select(by_ray, ray.origin, sphere.center),
          select(by_ray, mul_add(ray.direction, refined, ray.origin_low), offset), outward, footprint2};
}

/// Returns whether points are in odd cells of a checker whose cells are cubes with a corner at the world origin.
///
/// Precision  exact up to the rounding of base + rest within a cell. If cells are smaller than the spacing of
///            floating-point numbers at the point, rounding determines the cell; quotients of 2^53 and more (double)
///            count as even
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> is_odd_cell(D d, const TexturePoint<D>& at, V size) {
  const V two = set(d, 2), half = set(d, 0.5);
  const auto parity = [&](V whole) { return neg_mul_add(hn::Floor(whole * half), two, whole); };
  const auto along = [&](V base, V rest) {
    const V whole = hn::Floor(base / size);
    const V remainder = neg_mul_add(whole, size, base);
    return parity(whole) + parity(hn::Floor((remainder + rest) / size));
  };
  const V cells = along(at.base.x, at.rest.x) + (along(at.base.y, at.rest.y) + along(at.base.z, at.rest.z));
  return parity(cells) != 0;
}

/// The marble pattern, 0..1: a sine wave along z, perturbed by turbulence.
///
/// Reference  shirley2024b, "Adjusting the Phase"
template <class D, class V = hn::Vec<D>>
HWY_INLINE V marble(D d, const Texture& texture, const TexturePoint<D>& at) {
  constexpr double kInverseTurn = 0.15915494309189533577;
  const V half = set(d, 0.5);
  const V turns_per_unit = set(d, texture.scale * kInverseTurn);
  const V product = at.base.z * turns_per_unit;
  const V lost = math::HWY_NAMESPACE::product_error(d, at.base.z, turns_per_unit, product);
  const V phase = mul_add(at.rest.z, turns_per_unit, (product - hn::Floor(product)) + lost);
  const V turmoil = turbulence(d, texture, lattice_point(d, at.base, at.rest, set(d, 1)));
  const V turns = mul_add(turmoil, 10 * kInverseTurn, phase);
  return mul_add(sin_cos_turn(d, turns - hn::Floor(turns)).sin, half, half);
}

/// The mip level at which the texels of an image are as wide as the footprints: 0 is the image, and fractional levels
/// are interpolated. The longer axis of a texel determines the level, so that texels are not larger than the footprint
/// along either axis; near the poles, texels are narrow.
///
/// Precision  the logarithm is linear between powers of two, which is at most 0.05 levels too low
template <class D, class V = hn::Vec<D>>
HWY_INLINE V image_level(D d, const TextureImage& image, V footprint2, V radius2) {
  using T = hn::TFromD<D>;
  using U = hwy::MakeUnsigned<T>;
  const IdTag<D> du;
  constexpr int kMantissaBits = sizeof(T) == 8 ? 52 : 23;
  constexpr U kOne = sizeof(T) == 8 ? static_cast<U>(0x3ff0000000000000u) : static_cast<U>(0x3f800000u);
  constexpr double kPi = 3.14159265358979323846;
  const auto square = [&](double x) { return set(d, x * x); };
  const V rows2 = square(image.levels[0].height / kPi), columns2 = square(image.levels[0].width / (2 * kPi));
  const V texels2 = footprint2 * min(rows2, columns2 / radius2);
  const auto bits = hn::BitCast(du, texels2);
  const V exponent = to_real(d, hn::ShiftRight<kMantissaBits>(bits)) - to_real(d, hn::Set(du, kOne >> kMantissaBits));
  const V mantissa = hn::BitCast(d, hn::Or(hn::And(bits, hn::Set(du, (U{1} << kMantissaBits) - 1)), hn::Set(du, kOne)));
  const V level = (exponent + (mantissa - 1)) * 0.5;
  // False for NaN: an unknown footprint selects the full image.
  return hn::IfThenElseZero(texels2 > 1, min(level, image.level_count - 1));
}

/// The interpolated texels of an image at levels that are integers.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> color_at_level(D d, const TextureImage& image, V level, const MapPosition<V>& at) {
  using T = hn::TFromD<D>;
  constexpr std::size_t kMax = hn::MaxLanes(D());
  HWY_ALIGN T index[kMax], width[kMax], height[kMax];
  const TextureLevel* levels[kMax];
  hn::Store(level, d, index);
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) {
    levels[i] = &image.levels[static_cast<std::size_t>(index[i])];
    width[i] = static_cast<T>(levels[i]->width);
    height[i] = static_cast<T>(levels[i]->height);
  }
  return interpolated(d, load_texels(d, at, hn::Load(d, width), hn::Load(d, height),
                                     [&](std::size_t i, std::size_t row, std::size_t column) {
                                       return levels[i]->texels + 3 * (row * levels[i]->width + column);
                                     }));
}

/// The colour of an image at points: trilinear interpolation; bit-identical to bilinear where the image is magnified.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> image_color(D d, const TextureImage& image, const TexturePoint<D>& point) {
  // A sphere shows its map to the outside, an environment to the inside.
  const auto at = map_position(d, image.turn, {-point.outward.x, point.outward.y, point.outward.z});
  const V zero = hn::Zero(d), level = image_level(d, image, point.footprint2, at.radius2);
  const V finer = hn::Floor(level);
  const Vec3<V> color = color_at_level(d, image, finer, at);
  if (hn::AllTrue(d, level == zero)) return color;
  const V coarser = min(finer + 1, image.level_count - 1);
  return mul_add(color_at_level(d, image, coarser, at) - color, level - finer, color);
}

/// The colour of one texture at points.
template <class D, class V = hn::Vec<D>>
HWY_NOINLINE Vec3<V> texture_color(D d, const Texture& texture, const TexturePoint<D>& at) {
  const auto low = set3(d, texture.low), high = set3(d, texture.high);
  const V scale = set(d, texture.scale), half = set(d, 0.5);
  V t = hn::Zero(d);
  switch (texture.kind) {
    case TextureKind::kChecker: return select(is_odd_cell(d, at, scale), high, low);
    case TextureKind::kImage: return image_color(d, *texture.image, at) * high;
    case TextureKind::kNoise:
      t = mul_add(gradient_noise(d, texture, lattice_point(d, at.base, at.rest, scale)), half, half);
      break;
    case TextureKind::kTurbulence: t = turbulence(d, texture, lattice_point(d, at.base, at.rest, scale)); break;
    case TextureKind::kMarble: t = marble(d, texture, at); break;
  }
  t = min(max(t, 0), 1);
  return mul_add(high - low, t, low);
}

/// Replaces colours with the values of textures.
///
/// `index`    of each lane's texture; kNone: the lane keeps its colour
/// Cost       one evaluation for each texture in the vector
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> replaced_by_textures(D d, const Texture* textures, const std::uint32_t (&index)[hn::MaxLanes(D())],
                                        const TexturePoint<D>& at, Vec3<V> color) {
  using T = hn::TFromD<D>;
  constexpr std::size_t kMax = hn::MaxLanes(D());
  HWY_ALIGN T same[kMax];
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) {
    if (index[i] == kNone) continue;
    bool is_first = true;
    for (std::size_t k = 0; k < hn::Lanes(d); ++k) {
      same[k] = index[k] == index[i] ? T(1) : T(0);
      is_first = is_first && !(k < i && index[k] == index[i]);
    }
    if (!is_first) continue;
    color = select(hn::Load(d, same) != 0, texture_color(d, textures[index[i]], at), color);
  }
  return color;
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
