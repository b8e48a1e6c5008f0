// SPDX-License-Identifier: Apache-2.0
// Latitude-longitude maps of backgrounds and textures: positions, and interpolation between texels.
#pragma once

#include <hwy/highway.h>

#include <cstddef>

#include "kernel/gather-inl.h"
#include "math/functions-inl.h"
#include "math/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// Returns a + (b - a) s, which is not negative if a and b are not.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V interpolated(D, V a, V b, V s) {
  return mul_add(b - a, s, a);
}

/// Returns the fractional part x - floor(x), within 0..1: an angle in turns.
template <class V>
HWY_INLINE V whole_turns_removed(V x) {
  return x - hn::Floor(x);
}

/// Positions on a map: 0..1 from the left edge to the right and from the top to the bottom.
template <class V>
struct MapPosition {
  V across, down;
  V radius2;  ///< squared distance of the direction from the y axis
};

/// The position of directions on a map that is rotated by `turn` turns about +y.
///
/// Space      world, unit
template <class D, class V = hn::Vec<D>>
HWY_INLINE MapPosition<V> map_position(D d, double turn, const Vec3<V>& direction) {
  const V half = set(d, 0.5);
  const V radius2 = mul_add(direction.x, direction.x, direction.z * direction.z);
  const V longitude = atan2_turn(d, direction.x, direction.z);
  const V colatitude = atan2_turn(d, hn::Sqrt(radius2), direction.y);  // 0..1/2
  return {whole_turns_removed((half - longitude) + turn), colatitude + colatitude, radius2};
}

/// The four texels around a position on each lane's map, and the position between their centres.
template <class D>
struct TexelQuad {
  using V = hn::Vec<D>;
  V texel[4][4];  ///< upper left, upper right, lower left, lower right; red, green, blue, unused
  V right, down;  ///< interpolation weights of the right and the lower texels, 0..1
  V lower_row;    ///< row of the lower texels, not clamped to the map
};

/// Loads the texels around positions. Columns wrap around, rows end at the poles.
///
/// `width`, `height`   of each lane's map, texels
/// `texel_at`          returns the address of a texel, given its lane, row and column
/// Result     arbitrary texels of the map for a NaN position
template <class D, class TexelAt, class V = hn::Vec<D>>
HWY_INLINE TexelQuad<D> load_texels(D d, const MapPosition<V>& at, V width, V height, TexelAt texel_at) {
  using T = hn::TFromD<D>;
  constexpr std::size_t kMax = hn::MaxLanes(D());
  const V zero = hn::Zero(d), one = set(d, 1), half = set(d, 0.5);
  const V across = mul_add(at.across, width, -half);
  const V down = mul_add(at.down, height, -half);
  const V column = hn::Floor(across), above = hn::Floor(down);
  TexelQuad<D> out;
  out.right = across - column;
  out.down = down - above;

  HWY_ALIGN T left[kMax], right[kMax], upper[kMax], lower[kMax];
  // False for NaN, which must not become an index.
  const auto usable = hn::And(hn::And(across >= -one, across <= width), hn::And(down >= -one, down <= height));
  const V next = column + one;
  out.lower_row = hn::IfThenElseZero(usable, above + one);
  hn::Store(hn::IfThenElseZero(usable, select(column < zero, width - one, min(column, width - one))), d, left);
  hn::Store(hn::IfThenElseZero(hn::And(usable, next < width), next), d, right);
  hn::Store(hn::IfThenElseZero(usable, min(max(above, zero), height - one)), d, upper);
  hn::Store(min(out.lower_row, height - one), d, lower);
  const auto texel = [&](const T(&row)[kMax], const T(&column_of)[kMax], std::size_t i) {
    return texel_at(i, static_cast<std::size_t>(row[i]), static_cast<std::size_t>(column_of[i]));
  };
  gather4(
      d, [&](std::size_t i) { return texel(upper, left, i); }, out.texel[0]);
  gather4(
      d, [&](std::size_t i) { return texel(upper, right, i); }, out.texel[1]);
  gather4(
      d, [&](std::size_t i) { return texel(lower, left, i); }, out.texel[2]);
  gather4(
      d, [&](std::size_t i) { return texel(lower, right, i); }, out.texel[3]);
  return out;
}

/// Red, green and blue of quads: bilinear between the centres of the texels.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> interpolated(D d, const TexelQuad<D>& at) {
  const auto channel = [&](std::size_t c) {
    const V upper = interpolated(d, at.texel[0][c], at.texel[1][c], at.right);
    const V lower = interpolated(d, at.texel[2][c], at.texel[3][c], at.right);
    return interpolated(d, upper, lower, at.down);
  };
  return {channel(0), channel(1), channel(2)};
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
