// SPDX-License-Identifier: Apache-2.0
// Image backgrounds: radiance, sampling and density.
#pragma once

#include <hwy/highway.h>

#include <cstddef>
#include <utility>

#include "kernel/gather-inl.h"
#include "kernel/lat_long-inl.h"
#include "kernel/lights.h"
#include "math/functions-inl.h"
#include "math/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// The sampling weight of texels.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V texel_weight(D d, const Environment& env, const V (&rgb)[4]) {
  const V scale = set(d, env.weight_scale);
  const V below = mul_add(rgb[2], scale, -env.weight_offset);
  return max(mul_add(rgb[0], scale, mul_add(rgb[1], scale, below)), 0);
}

/// The texels around each lane's direction, and the direction's position between their centres.
template <class D>
struct EnvironmentFootprint : TexelQuad<D> {
  hn::Vec<D> cosine_down;  ///< 0..1, linear in the cosine to the pole; only if the map is sampled
  hn::Mask<D> is_in_sun;
};

/// Returns whether directions are inside the sun's cone. Compares the distance of the two unit vectors, because their
/// cosine would round to 1.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> is_in_sun(D d, const Environment& env, const Vec3<V>& direction) {
  const auto between = direction - set3(d, env.sun);
  return dot(between, between) <= (2 * env.sun_one_minus_cos);
}

/// Loads the texels around directions.
///
/// Space      world; unit
/// Result     arbitrary texels of the map for a NaN direction
template <class D, class V = hn::Vec<D>>
HWY_INLINE EnvironmentFootprint<D> environment_footprint(D d, const Environment& env, const Vec3<V>& direction) {
  using T = hn::TFromD<D>;
  constexpr std::size_t kMax = hn::MaxLanes(D());
  const V zero = hn::Zero(d);
  const V width = set(d, env.width), height = set(d, env.height);
  const auto position = map_position(d, env.turn, direction);
  EnvironmentFootprint<D> out{load_texels(d, position, width, height,
                                          [&](std::size_t, std::size_t row, std::size_t column) {
                                            return env.texels + 3 * (row * env.width + column);
                                          }),
                              zero,
                              {}};
  if (env.has_sun) out.is_in_sun = is_in_sun(d, env, direction);

  if (env.map_density > 0) {
    HWY_ALIGN T cell_row[kMax], versine[kMax], row_width[kMax];
    hn::Store(min(out.lower_row, height), d, cell_row);
    for (std::size_t i = 0; i < hn::Lanes(d); ++i) {
      const EnvironmentRow& row = env.rows[static_cast<std::size_t>(cell_row[i])];
      versine[i] = static_cast<T>(row.versine);
      row_width[i] = static_cast<T>(row.width);
    }
    const V extent = hn::Load(d, row_width);
    const V tall = 1 + hn::Abs(direction.y);
    // Relative to the pole of the row's half of the map.
    const V from_pole = select(extent * direction.y > 0, position.radius2 / tall, tall);
    const V t = (from_pole - hn::Load(d, versine)) / extent;
    out.cosine_down = min(max(t, 0), 1);
  }
  return out;
}

/// The radiance of footprints: bilinear between the centres of the texels, plus the sun.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> radiance_of(D d, const Environment& env, const EnvironmentFootprint<D>& at) {
  const V scale = set(d, env.scale);
  const Vec3<V> map = interpolated(d, static_cast<const TexelQuad<D>&>(at)) * scale;
  if (!env.has_sun) return map;
  return select(at.is_in_sun, map + set3(d, env.sun_radiance), map);
}

/// The density per steradian with which sample_environment chooses directions; 0 if the environment is not sampled.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V pdf_of(D d, const Environment& env, const EnvironmentFootprint<D>& at) {
  V pdf = hn::Zero(d);
  if (env.map_density > 0) {
    const V upper = interpolated(d, texel_weight(d, env, at.texel[0]), texel_weight(d, env, at.texel[1]), at.right);
    const V lower = interpolated(d, texel_weight(d, env, at.texel[2]), texel_weight(d, env, at.texel[3]), at.right);
    pdf = interpolated(d, upper, lower, at.cosine_down) * env.map_density;
  }
  if (env.has_sun) pdf = pdf + hn::IfThenElseZero(at.is_in_sun, set(d, env.sun_density));
  return pdf;
}

/// The radiance from directions, of map and sun.
///
/// Space      direction world, unit
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> environment_radiance(D d, const Environment& env, const Vec3<V>& direction) {
  return radiance_of(d, env, environment_footprint(d, env, direction));
}

/// One of two parts, chosen with probabilities proportional to their weights. `rest` is the rescaled random number,
/// again uniform in 0..1.
template <class D>
struct Split {
  hn::Mask<D> second;
  hn::Vec<D> rest;
};
template <class D, class V = hn::Vec<D>>
HWY_INLINE Split<D> split(D, V first, V second, V u) {
  const V at = u * (first + second);
  // A part with zero weight is never chosen, even with rounding errors.
  const auto beyond = hn::And(at >= first, second > 0);
  const V chosen = select(beyond, second, first);
  const V rest = select(beyond, at - first, at) / select(chosen > 0, chosen, 1);
  return {beyond, min(rest, 1)};
}

/// Samples 0..1 with a density that is linear from `a` at 0 to `b` at 1.
///
/// Precision  uses the numerically stable form of the inverse
template <class D, class V = hn::Vec<D>>
HWY_INLINE V sample_linear(D d, V a, V b, V u) {
  const V divisor = a + hn::Sqrt(interpolated(d, a * a, b * b, u));
  return select(divisor > 0, min(u * (a + b) / divisor, 1), u);
}

/// Samples the map: selects a cell by descending the sums, where each step splits the rows and then the columns, and
/// samples a point in the cell.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> sample_map(D d, const Environment& env, V u, V v) {
  using T = hn::TFromD<D>;
  constexpr std::size_t kMax = hn::MaxLanes(D());
  const V zero = hn::Zero(d), one = set(d, 1), two = set(d, 2), half = set(d, 0.5);
  V column = zero, row = zero;
  HWY_ALIGN T columns[kMax], rows[kMax];

  // A step from a node to one of its four children: first the row, then the column.
  const auto descend = [&](V upper_left, V upper_right, V lower_left, V lower_right) {
    const auto vertical = split(d, upper_left + upper_right, lower_left + lower_right, v);
    const auto horizontal =
        split(d, select(vertical.second, lower_left, upper_left), select(vertical.second, lower_right, upper_right), u);
    v = vertical.rest;
    u = horizontal.rest;
    column = mul_add(column, two, hn::IfThenElseZero(horizontal.second, one));
    row = mul_add(row, two, hn::IfThenElseZero(vertical.second, one));
    hn::Store(column, d, columns);
    hn::Store(row, d, rows);
    return std::pair{vertical.second, horizontal.second};
  };

  // From the root to a node of two by two cells.
  hn::Store(zero, d, columns);
  hn::Store(zero, d, rows);
  for (std::uint32_t k = 0; k < env.level_count; ++k) {
    const EnvironmentLevel& level = env.levels[k];
    V child[4];
    gather4(
        d,
        [&](std::size_t i) {
          return level.blocks +
                 4 * (static_cast<std::size_t>(rows[i]) * level.blocks_per_row + static_cast<std::size_t>(columns[i]));
        },
        child);
    descend(child[0], child[1], child[2], child[3]);
  }

  // The weights of its three by three texels, between which the cells are.
  V weight[3][3];
  for (std::size_t y = 0; y < 3; ++y) {
    for (std::size_t x = 0; x < 3; ++x) {
      V rgb[4];
      gather4(
          d,
          [&](std::size_t i) {
            // The upper row of texels of cell row 0 is above the map.
            const std::size_t below = 2 * static_cast<std::size_t>(rows[i]) + y;
            const std::size_t at = below == 0 ? 0 : below - 1 < env.height ? below - 1 : env.height - 1;
            return env.texels + 3 * (at * env.width + (2 * static_cast<std::size_t>(columns[i]) + x) % env.width);
          },
          rgb);
      weight[y][x] = texel_weight(d, env, rgb);
    }
  }

  // The heights of its two rows of cells.
  HWY_ALIGN T versine[2][kMax], extent[2][kMax];
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) {
    for (std::size_t k = 0; k < 2; ++k) {
      const EnvironmentRow& cells = env.rows[2 * static_cast<std::size_t>(rows[i]) + k];
      versine[k][i] = static_cast<T>(cells.versine);
      extent[k][i] = static_cast<T>(cells.width);
    }
  }
  const V extents[2] = {hn::Load(d, extent[0]), hn::Load(d, extent[1])};

  // The last step, to a cell, by its sum of weights times height.
  const auto has_right = mul_add(column, two, one) < env.width;
  const auto cell = [&](std::size_t y, std::size_t x) {
    return ((weight[y][x] + weight[y][x + 1]) + (weight[y + 1][x] + weight[y + 1][x + 1])) * hn::Abs(extents[y]);
  };
  const auto [is_lower, is_right] = descend(cell(0, 0), hn::IfThenElseZero(has_right, cell(0, 1)), cell(1, 0),
                                            hn::IfThenElseZero(has_right, cell(1, 1)));

  // A point in the cell, in which the weight is bilinear.
  V corner[2][2];
  for (std::size_t y = 0; y < 2; ++y)
    for (std::size_t x = 0; x < 2; ++x)
      corner[y][x] = select(is_lower, select(is_right, weight[y + 1][x + 1], weight[y + 1][x]),
                            select(is_right, weight[y][x + 1], weight[y][x]));
  const V down = sample_linear(d, corner[0][0] + corner[0][1], corner[1][0] + corner[1][1], v);
  const V right = sample_linear(d, interpolated(d, corner[0][0], corner[1][0], down),
                                interpolated(d, corner[0][1], corner[1][1], down), u);

  // Its direction.
  const V row_width = select(is_lower, extents[1], extents[0]);
  const V begin = select(is_lower, hn::Load(d, versine[1]), hn::Load(d, versine[0]));
  const V from_pole = max(mul_add(row_width, down, begin), zero);
  const V sine = hn::Sqrt(from_pole * (two - from_pole));
  const V across = (column + half + right) / env.width;
  const auto turn = sin_cos_turn(d, whole_turns_removed((half + env.turn) - across));
  return {turn.sin * sine, select(row_width < zero, from_pole - one, one - from_pole), turn.cos * sine};
}

/// Samples the sun's cone uniformly.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vec3<V> sample_sun(D d, const Environment& env, V u, V v) {
  const V versine = u * env.sun_one_minus_cos;
  const V sine = hn::Sqrt(versine * (2 - versine));
  const auto turn = sin_cos_turn(d, v);
  const auto axis = set3(d, env.sun);
  return mul_add(set3(d, env.sun_tangent), sine * turn.cos,
                 mul_add(set3(d, env.sun_bitangent), sine * turn.sin, neg_mul_add(axis, versine, axis)));
}

/// Directions sampled for direct lighting, one per lane.
template <class V>
struct EnvironmentSample {
  Vec3<V> direction;  ///< world, unit
  Vec3<V> radiance;   ///< as returned by environment_radiance
  V inverse_pdf;      ///< steradians; 0: rounding errors prevented a sample
};

/// Samples a direction with the density pdf_of.
///
/// `u`, `v`   0..1. Nearby numbers give nearby directions, except across the boundary between sun and map, so
///            stratification is preserved.
/// Domain     env.is_sampled
template <class D, class V = hn::Vec<D>>
HWY_INLINE EnvironmentSample<V> sample_environment(D d, const Environment& env, V u, V v) {
  const V share = set(d, env.sun_probability);
  EnvironmentSample<V> out;
  if (env.map_density > 0) {
    const auto to_sun = split(d, 1 - share, share, u);
    out.direction = sample_map(d, env, to_sun.rest, v);
    if (env.sun_probability > 0)
      out.direction = select(to_sun.second, sample_sun(d, env, to_sun.rest, v), out.direction);
  } else {
    out.direction = sample_sun(d, env, u, v);
  }
  const auto at = environment_footprint(d, env, out.direction);
  const V pdf = pdf_of(d, env, at);
  const auto good = pdf > 0;
  out.radiance = radiance_of(d, env, at);
  out.inverse_pdf = hn::IfThenElseZero(good, 1 / select(good, pdf, 1));
  return out;
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
