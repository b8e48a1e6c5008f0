// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace orrery::math {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Rounds to single precision.
///
/// GCC 12 removes the conversions to float and back where it vectorizes them in pairs, as in `for (Vec3d& p : points) p
/// = {rounded(p.x), rounded(p.y), rounded(p.z)}`. Values that pass through inline assembly are not vectorized.
inline double in_single_precision(double x) noexcept {
  auto single = static_cast<float>(x);
  __asm__("" : "+x"(single));
  return static_cast<double>(single);
}

/// The largest single-precision number that is not above x.
inline float rounded_down(double x) noexcept {
  const auto f = static_cast<float>(x);
  return static_cast<double>(f) > x ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}
/// The smallest single-precision number that is not below x.
inline float rounded_up(double x) noexcept { return -rounded_down(-x); }

// Sine and cosine of an angle in radians, rounded from long double, so that they do not depend on the math library.
inline double sine(double angle) { return static_cast<double>(std::sin(static_cast<long double>(angle))); }
inline double cosine(double angle) { return static_cast<double>(std::cos(static_cast<long double>(angle))); }

/// Returns e^x, computed with IEEE arithmetic only, for results that must not depend on the math library. Compilers can
/// vectorise loops over it.
///
/// Domain     x <= 0; below -700, e^-700
/// Precision  1e-15 relative; test MathScalar.ExponentialMatchesTheLongDoubleFunction
constexpr double exp_nonpositive(double x) {
  constexpr double kLog2E = 1.44269504088896340736;
  constexpr double kLn2High = 0x1.62e42fefp-1, kLn2Low = 0x1.473de6af278edp-34;  // the product with k is exact
  constexpr double kRound = 0x1.8p52;  // in the sum with it, the last bit is one, and low bits are an integer
  x = x < -700 ? -700 : x;
  const double shifted = x * kLog2E + kRound;
  const double k = shifted - kRound;
  const double r = (x - k * kLn2High) - k * kLn2Low;
  double p = 1.0 / 479001600;
  p = p * r + 1.0 / 39916800;
  p = p * r + 1.0 / 3628800;
  p = p * r + 1.0 / 362880;
  p = p * r + 1.0 / 40320;
  p = p * r + 1.0 / 5040;
  p = p * r + 1.0 / 720;
  p = p * r + 1.0 / 120;
  p = p * r + 1.0 / 24;
  p = p * r + 1.0 / 6;
  p = p * r + 0.5;
  p = p * r + 1;
  p = p * r + 1;
  return p * std::bit_cast<double>((std::bit_cast<std::uint64_t>(shifted) + 1023) << 52);
}

/// Returns the natural logarithm, rounded from long double, so that it does not depend on the math library.
inline double logarithm(double x) { return static_cast<double>(std::log(static_cast<long double>(x))); }

}  // namespace orrery::math
