// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "math/vec3.h"

namespace orrery::bench::baseline {

/// A sequential random number generator, and rejection sampling of simple shapes, as in the book.
///
/// Takes a few operations per number where the standard library's generators take many, so that the generator does not
/// put the baseline at a disadvantage.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// Result     in [0, 1)
  double unit() {
    // SplitMix64: a counter whose bits are mixed.
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }
  double between(double low, double high) { return low + (high - low) * unit(); }

  math::Vec3d on_sphere() {
    for (;;) {
      const math::Vec3d p{between(-1, 1), between(-1, 1), between(-1, 1)};
      const double square = math::dot(p, p);
      if (1e-160 < square && square <= 1) return p / std::sqrt(square);
    }
  }
  math::Vec3d in_disc() {
    for (;;) {
      const math::Vec3d p{between(-1, 1), between(-1, 1), 0};
      if (math::dot(p, p) < 1) return p;
    }
  }

 private:
  std::uint64_t state_;
};

}  // namespace orrery::bench::baseline
