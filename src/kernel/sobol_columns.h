// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace orrery::kernel {

/// Points of one scrambled sequence; what comes after them is a sequence of another name.
inline constexpr int kSobolBits = 16;

/// What each bit of a point's index adds (without carry) to its coordinates, whose bits stand in opposite order: bit 0
/// is worth a half. The first two dimensions need no table.
struct SobolColumns {
  std::array<std::uint32_t, kSobolBits> third{}, fourth{};
};

/// Sobol's recurrence for a primitive polynomial t^degree + a1 t^(degree - 1) + ... + 1.
///
/// `inner` holds a1 ... as bits, `m` the first `degree` direction numbers.
constexpr std::array<std::uint32_t, kSobolBits> sobol_columns(int degree, std::uint32_t inner,
                                                              std::array<std::uint32_t, 3> m) {
  std::array<std::uint32_t, kSobolBits> out{};
  std::array<std::uint32_t, kSobolBits> direction{};  // k + 1 bits, the highest worth a half
  for (int k = 0; k < kSobolBits; ++k) {
    auto& d = direction[static_cast<std::size_t>(k)];
    if (k < degree) {
      d = m[static_cast<std::size_t>(k)];
    } else {
      d = direction[static_cast<std::size_t>(k - degree)];
      d ^= d << degree;
      for (int i = 1; i < degree; ++i)
        if ((inner >> (degree - 1 - i) & 1) != 0) d ^= direction[static_cast<std::size_t>(k - i)] << i;
    }
    for (int bit = 0; bit <= k; ++bit)
      if ((d >> (k - bit) & 1) != 0) out[static_cast<std::size_t>(k)] |= 1u << bit;
  }
  return out;
}

inline constexpr SobolColumns kSobolColumns{sobol_columns(2, 1, {1, 3, 0}), sobol_columns(3, 1, {1, 3, 1})};

}  // namespace orrery::kernel
