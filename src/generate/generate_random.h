// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>

#include "math/vec3.h"

namespace orrery::generate {

/// Random numbers for the scene generators: one seed gives the same scene on every machine.
///
/// The C++ standard specifies the bits of the engine, but not those of its distributions. The conversion from bits to
/// numbers is therefore implemented here, and uses only IEEE arithmetic.
///
/// Reference  matsumoto1998
class GenerateRandom {
 public:
  explicit GenerateRandom(std::uint64_t seed) : engine_(seed) {}

  /// Returns a multiple of 2^-53, uniform in [0, 1).
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

  /// Returns a number uniform in [from, to).
  double between(double from, double to) { return from + (to - from) * unit(); }

  /// Returns three independent numbers uniform in [0, 1), drawn in the order x, y, z.
  math::Vec3d unit3() {
    const double x = unit(), y = unit(), z = unit();
    return {x, y, z};
  }

  /// Returns a point in the unit ball, uniform by volume.
  ///
  /// Cost       1.9 iterations on average: a mapping without rejection needs functions whose last bit depends on the
  ///            machine
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
