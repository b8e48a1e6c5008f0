// SPDX-License-Identifier: Apache-2.0
// Textures at points of spheres. Compiled once per instruction set.
#if defined(ORRERY_KERNEL_TEXTURE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ORRERY_KERNEL_TEXTURE_INL_H_
#undef ORRERY_KERNEL_TEXTURE_INL_H_
#else
#define ORRERY_KERNEL_TEXTURE_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>

#include "kernel/environment-inl.h"
#include "kernel/intersect-inl.h"
#include "kernel/noise-inl.h"
#include "kernel/texture.h"
#include "kernel/texture_point-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// Whether points are in odd cells of a checker whose cells are cubes with a corner at the world's origin.
///
/// Precision  exact up to the rounding of base + rest within a cell. Where a cell is smaller than the spacing of
///            numbers at the point, rounding decides the cell; quotients of 2^53 and more (double) count as even
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> is_odd_cell(D d, const TexturePoint<D>& at, V size) {
  using T = hn::TFromD<D>;
  const V two = hn::Set(d, T(2)), half = hn::Set(d, static_cast<T>(0.5));
  const auto parity = [&](V whole) { return hn::NegMulAdd(hn::Floor(whole * half), two, whole); };
  const auto along = [&](V base, V rest) {
    const V whole = hn::Floor(base / size);
    const V remainder = hn::NegMulAdd(whole, size, base);
    return parity(whole) + parity(hn::Floor((remainder + rest) / size));
  };
  const V cells = along(at.base.x, at.rest.x) + (along(at.base.y, at.rest.y) + along(at.base.z, at.rest.z));
  return parity(cells) != hn::Zero(d);
}

/// The marble pattern, 0..1: a sine wave along z, perturbed by turbulence.
///
/// Reference  shirley2024b, "Adjusting the Phase"
template <class D, class V = hn::Vec<D>>
HWY_INLINE V marble(D d, const Texture& texture, const TexturePoint<D>& at) {
  using T = hn::TFromD<D>;
  constexpr double kInverseTurn = 0.15915494309189533577;
  const V half = hn::Set(d, static_cast<T>(0.5));
  const V turns_per_unit = hn::Set(d, static_cast<T>(texture.scale * kInverseTurn));
  const V product = at.base.z * turns_per_unit;
  const V lost = math::HWY_NAMESPACE::product_error(d, at.base.z, turns_per_unit, product);
  const V phase = hn::MulAdd(at.rest.z, turns_per_unit, (product - hn::Floor(product)) + lost);
  const V turmoil = turbulence(d, texture, lattice_point(d, at.base, at.rest, hn::Set(d, T(1))));
  const V turns = hn::MulAdd(turmoil, hn::Set(d, static_cast<T>(10 * kInverseTurn)), phase);
  return hn::MulAdd(sin_cos_turn(d, turns - hn::Floor(turns)).sin, half, half);
}

/// The colour of one texture at points.
template <class D, class V = hn::Vec<D>>
HWY_NOINLINE Vec3<V> texture_color(D d, const Texture& texture, const TexturePoint<D>& at) {
  using T = hn::TFromD<D>;
  const auto low = set3(d, texture.low), high = set3(d, texture.high);
  const V scale = hn::Set(d, static_cast<T>(texture.scale)), half = hn::Set(d, static_cast<T>(0.5));
  V t = hn::Zero(d);
  switch (texture.kind) {
    case TextureKind::kChecker: return select(is_odd_cell(d, at, scale), high, low);
    case TextureKind::kImage: {
      // A sphere shows its map to the outside, an environment to the inside.
      const Vec3<V> mirrored_direction = {hn::Neg(at.outward.x), at.outward.y, at.outward.z};
      return environment_radiance(d, *texture.image, mirrored_direction) * high;
    }
    case TextureKind::kNoise:
      t = hn::MulAdd(gradient_noise(d, texture, lattice_point(d, at.base, at.rest, scale)), half, half);
      break;
    case TextureKind::kTurbulence: t = turbulence(d, texture, lattice_point(d, at.base, at.rest, scale)); break;
    case TextureKind::kMarble: t = marble(d, texture, at); break;
  }
  t = hn::Min(hn::Max(t, hn::Zero(d)), hn::Set(d, T(1)));
  return mul_add(high - low, t, low);
}

/// Replaces colours by the values of textures.
///
/// `index`    of each lane's texture; MaterialTextures::kNone: the lane keeps its colour
/// Cost       one evaluation for each texture in the vector
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> replaced_by_textures(D d, const Texture* textures, const std::uint32_t (&index)[hn::MaxLanes(D())],
                                        const TexturePoint<D>& at, Vec3<V> color) {
  using T = hn::TFromD<D>;
  constexpr std::size_t kMax = hn::MaxLanes(D());
  HWY_ALIGN T same[kMax];
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) {
    if (index[i] == MaterialTextures::kNone) continue;
    bool is_first = true;
    for (std::size_t k = 0; k < hn::Lanes(d); ++k) {
      same[k] = index[k] == index[i] ? T(1) : T(0);
      is_first = is_first && !(k < i && index[k] == index[i]);
    }
    if (!is_first) continue;
    color = select(hn::Load(d, same) != hn::Zero(d), texture_color(d, textures[index[i]], at), color);
  }
  return color;
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
