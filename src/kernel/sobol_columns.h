// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
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

/// A matrix over two elements: what each bit of a sample's index adds (without carry) to the index of its point.
using SobolOrder = std::array<std::uint32_t, kSobolBits>;

/// Vertices of a path, the camera the first, that share one sequence; numbers of later ones are independent.
inline constexpr std::uint32_t kSobolVertices = 8;

/// Bits at the low end of an index that an order mixes at will; above them a bit changes lower bits only. So points
/// 2^k n .. 2^k (n + 1) are the same at every vertex, in another order, for all k from here on.
inline constexpr std::size_t kSobolFreeBits = 4;

/// The place of the time's order in kSobolOrders, behind those of the vertices.
inline constexpr std::uint32_t kSobolTimeOrder = kSobolVertices;

/// The order in which each vertex, and then the time, takes the points. tools/sobol_orders.cpp has chosen them: numbers
/// of different vertices fill space evenly together.
inline constexpr std::array<SobolOrder, kSobolVertices + 1> kSobolOrders{{
    {0x1, 0x2, 0x4, 0x8, 0x10, 0x20, 0x40, 0x80, 0x100, 0x200, 0x400, 0x800, 0x1000, 0x2000, 0x4000, 0x8000},
    {0x5, 0xe, 0xf, 0xd, 0x1c, 0x3a, 0x74, 0xbb, 0x1c6, 0x339, 0x659, 0xca5, 0x1e14, 0x206d, 0x6d42, 0xf225},
    {0xc, 0x6, 0x1, 0x2, 0x1f, 0x3f, 0x52, 0xb0, 0x146, 0x23e, 0x502, 0xf98, 0x19ff, 0x33da, 0x52b2, 0xb28d},
    {0x9, 0x1, 0xe, 0x4, 0x11, 0x3e, 0x68, 0x9c, 0x1e9, 0x3c7, 0x717, 0xb1e, 0x1618, 0x22c5, 0x4763, 0xbd44},
    {0x8, 0xa, 0x6, 0xb, 0x11, 0x38, 0x46, 0xff, 0x1ac, 0x3e5, 0x7e1, 0xc8d, 0x1c9e, 0x3d58, 0x5e7d, 0xeadf},
    {0x7, 0x8, 0xb, 0x6, 0x1b, 0x31, 0x63, 0xa7, 0x12f, 0x298, 0x61c, 0xed4, 0x1e5a, 0x3f56, 0x7d07, 0xed3e},
    {0x5, 0xd, 0xa, 0x9, 0x10, 0x38, 0x50, 0xa6, 0x169, 0x22c, 0x74b, 0xd6d, 0x184d, 0x254a, 0x5f05, 0x9c8c},
    {0xc, 0x9, 0x3, 0x8, 0x18, 0x36, 0x5e, 0xf9, 0x106, 0x2fe, 0x5a2, 0x98c, 0x19de, 0x3ded, 0x5bbc, 0xcc4c},
    {0x1, 0x2, 0x7, 0xe, 0x1c, 0x33, 0x49, 0xa5, 0x12e, 0x32f, 0x4ef, 0xc67, 0x1382, 0x2e16, 0x56de, 0xd311},
}};

}  // namespace orrery::kernel
