// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "math/vec3.h"

namespace orrery::generate {

/// Random numbers of the scene generators: one seed gives the same scene on every machine.
///
/// The engine's bits are the C++ standard's; the distributions of the standard library are not, so the way from bits to
/// numbers is our own, and takes nothing but IEEE arithmetic.
class GenerateRandom {
 public:
  explicit GenerateRandom(std::uint64_t seed) : engine_(seed) {}

  /// Uniform in [0, 1), a multiple of 2^-53.
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

  /// Uniform in [from, to).
  double between(double from, double to) { return from + (to - from) * unit(); }

  /// Three independent numbers, x first.
  math::Vec3d unit3() {
    const double x = unit(), y = unit(), z = unit();
    return {x, y, z};
  }

  /// A point of the ball of radius 1 around the origin, uniform by volume.
  ///
  /// Cost       1.9 tries on average; mapping without tries would need functions whose last bit differs by machine
  math::Vec3d in_ball() {
    for (;;) {
      const math::Vec3d p = 2 * unit3() - math::Vec3d{1, 1, 1};
      if (math::dot(p, p) <= 1) return p;
    }
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace orrery::generate
