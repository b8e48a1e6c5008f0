// SPDX-License-Identifier: Apache-2.0
// Gradient noise.
#pragma once

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#include "kernel/gather-inl.h"
#include "kernel/material.h"
#include "kernel/random-inl.h"
#include "math/functions-inl.h"
#include "math/vec3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

/// Period of the lattice along each axis, cells.
inline constexpr std::uint32_t kLatticePeriod = 0x80000000u;

/// A position in the noise lattice, per axis. Doubling it is exact, so every octave is as accurate as the first.
template <class D>
struct LatticePoint {
  hn::Vec<hn::RebindToUnsigned<D>> cell[3];  ///< modulo kLatticePeriod
  hn::Vec<D> part[3];                        ///< 0..1 within the cell
};

/// Returns an integer modulo kLatticePeriod.
///
/// Result     an arbitrary cell for NaN and infinity
template <class D>
HWY_INLINE hn::Vec<hn::RebindToUnsigned<D>> lattice_cell(D d, hn::Vec<D> whole) {
  using T = hn::TFromD<D>;
  const hn::RebindToUnsigned<D> du;
  const auto periods = whole * (1.0 / kLatticePeriod);
  const auto period = set(d, kLatticePeriod);
  const auto mask = set(du, kLatticePeriod - 1);
  if constexpr (sizeof(T) == 8) {
    const auto rest = neg_mul_add(hn::Floor(periods), period, whole);
    return hn::And(hn::BitCast(du, rest + 0x1p52), mask);  // the low bits of 2^52 + n are n
  } else {
    // Towards zero: floats do not hold 2^31 - 1.
    const hn::RebindToSigned<D> di;
    const auto rest = neg_mul_add(hn::Trunc(periods), period, whole);
    return hn::And(hn::BitCast(du, hn::ConvertTo(di, rest)), mask);
  }
}

/// The lattice position of frequency (base + rest). The rounding error of the product is compensated, however large
/// `base` is.
template <class D, class V = hn::Vec<D>>
HWY_INLINE LatticePoint<D> lattice_point(D d, const Vec3<V>& base, const Vec3<V>& rest, V frequency) {
  LatticePoint<D> out;
  const hn::RebindToUnsigned<D> du;
  const auto mask = set(du, kLatticePeriod - 1);
  const auto along = [&](int axis, V from, V to) {
    const V product = from * frequency;
    const V lost = math::HWY_NAMESPACE::product_error(d, from, frequency, product);
    const V whole = hn::Floor(product);
    const V beyond = mul_add(to, frequency, (product - whole) + lost);
    const V more = hn::Floor(beyond);
    out.cell[axis] = hn::And(lattice_cell(d, whole) + lattice_cell(d, more), mask);
    out.part[axis] = beyond - more;
  };
  along(0, base.x, rest.x);
  along(1, base.y, rest.y);
  along(2, base.z, rest.z);
  return out;
}

template <class D>
HWY_INLINE void double_frequency(D d, LatticePoint<D>& at) {
  const hn::RebindToUnsigned<D> du;
  const auto mask = set(du, kLatticePeriod - 1);
  for (int k = 0; k < 3; ++k) {
    const auto twice = at.part[k] + at.part[k];
    const auto more = hn::Floor(twice);
    at.cell[k] = hn::And(at.cell[k] + at.cell[k] + lattice_cell(d, more), mask);
    at.part[k] = twice - more;
  }
}

/// Perlin's gradient noise with the book's cubic interpolation: zero at lattice points, and smooth.
///
/// Result     between -0.87 and 0.87 (sqrt(3)/2)
/// Reference  perlin1985; shirley2024b, "Perlin Noise"
template <class D, class V = hn::Vec<D>>
HWY_NOINLINE V gradient_noise(D d, const Texture& texture, const LatticePoint<D>& at) {
  using Id = hn::TFromD<hn::RebindToUnsigned<D>>;
  const hn::RebindToUnsigned<D> du;
  const V one = set(d, 1), two = set(d, 2), three = set(d, 3);
  const auto mask = set(du, kLatticePeriod - 1), step = hn::Set(du, Id{1});
  V weight[3][2];
  for (int k = 0; k < 3; ++k) {
    weight[k][1] = at.part[k] * at.part[k] * neg_mul_add(two, at.part[k], three);
    weight[k][0] = one - weight[k][1];
  }
  const auto corner = [&](int axis, unsigned side) {
    return side == 0 ? at.cell[axis] : hn::And(at.cell[axis] + step, mask);
  };
  // The high halves of 64-bit lanes stay 0.
  const auto scrambled = [&](auto bits) {
    const hn::Repartition<std::uint32_t, decltype(du)> d32;
    return hn::BitCast(du, hashed(d32, hn::BitCast(d32, bits)));
  };
  const auto from_corner = [&](int axis, unsigned side) { return side == 0 ? at.part[axis] : at.part[axis] - one; };
  V sum = hn::Zero(d);
  HWY_ALIGN Id row[hn::MaxLanes(D())];
  for (unsigned z = 0; z < 2; ++z) {
    const auto hash_z = scrambled(hn::Xor(corner(2, z), set(du, texture.seed)));
    for (unsigned y = 0; y < 2; ++y) {
      const auto hash_yz = scrambled(hn::Xor(hash_z, corner(1, y)));
      const V weight_yz = weight[2][z] * weight[1][y];
      for (unsigned x = 0; x < 2; ++x) {
        const auto hash = scrambled(hn::Xor(hash_yz, corner(0, x)));
        hn::Store(hn::And(hash, set(du, kGradients - 1)), du, row);
        V gradient[4];
        gather4(
            d, [&](std::size_t i) { return texture.gradients + 4 * static_cast<std::size_t>(row[i]); }, gradient);
        const V slope = mul_add(gradient[2], from_corner(2, z),
                                mul_add(gradient[1], from_corner(1, y), gradient[0] * from_corner(0, x)));
        sum = mul_add(weight_yz * weight[0][x], slope, sum);
      }
    }
  }
  return sum;
}

/// The magnitude of a sum of octaves of noise, each with twice the frequency and half the weight of the one before.
///
/// Result     below 1.72
/// Reference  shirley2024b, "Introducing Turbulence"
template <class D, class V = hn::Vec<D>>
HWY_INLINE V turbulence(D d, const Texture& texture, LatticePoint<D> at) {
  using T = hn::TFromD<D>;
  V sum = hn::Zero(d);
  T weight = 1;
  for (int octave = 0; octave < kOctaves; ++octave) {
    sum = mul_add(gradient_noise(d, texture, at), weight, sum);
    weight *= static_cast<T>(0.5);
    double_frequency(d, at);
  }
  return hn::Abs(sum);
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
