// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>

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

/// Gradient noise for generated images, with the book's tables: a permutation of 256 gradients for each axis. One seed
/// gives the same noise on every machine.
///
/// Reference  shirley2024b, "Perlin Noise"
class GenerateNoise {
 public:
  explicit GenerateNoise(std::uint64_t seed) {
    GenerateRandom random(seed);
    for (math::Vec3d& g : gradients_) g = math::normalized(random.in_ball());
    for (auto& axis : order_) {
      for (std::size_t i = 0; i < axis.size(); ++i) axis[i] = static_cast<unsigned>(i);
      for (std::size_t i = axis.size() - 1; i > 0; --i)
        std::swap(axis[i], axis[static_cast<std::size_t>(random.unit() * static_cast<double>(i + 1))]);
    }
  }

  /// Returns the noise at a point, between -0.87 and 0.87.
  double at(math::Vec3d p) const {
    const double whole[3] = {std::floor(p.x), std::floor(p.y), std::floor(p.z)};
    const math::Vec3d part{p.x - whole[0], p.y - whole[1], p.z - whole[2]};
    const auto smooth = [](double t) { return t * t * (3 - 2 * t); };
    const math::Vec3d weight{smooth(part.x), smooth(part.y), smooth(part.z)};
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const int side[3] = {corner & 1, corner >> 1 & 1, corner >> 2};
      unsigned index = 0;
      for (std::size_t k = 0; k < 3; ++k)
        index ^= order_[k][static_cast<std::size_t>(static_cast<long long>(whole[k]) + side[k]) & 255U];
      const math::Vec3d from_corner{part.x - side[0], part.y - side[1], part.z - side[2]};
      const double share = (side[0] != 0 ? weight.x : 1 - weight.x) * (side[1] != 0 ? weight.y : 1 - weight.y) *
                           (side[2] != 0 ? weight.z : 1 - weight.z);
      sum += share * math::dot(gradients_[index], from_corner);
    }
    return sum;
  }

  /// Returns a sum of octaves, each with twice the frequency and half the weight of the one before.
  double octaves(math::Vec3d p, int count) const {
    double sum = 0, weight = 1;
    for (int i = 0; i < count; ++i, weight /= 2, p = 2 * p) sum += weight * at(p);
    return sum;
  }

 private:
  std::array<math::Vec3d, 256> gradients_;
  std::array<std::array<unsigned, 256>, 3> order_;
};

}  // namespace orrery::generate
