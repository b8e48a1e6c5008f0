// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace orrery::math {

/// Returns e^x, computed with IEEE arithmetic only, for results that must not depend on the math library. Compilers can
/// vectorise loops over it.
///
/// Domain     x <= 0; below -700, e^-700
/// Precision  1e-15 relative; test MathExponential.MatchesTheLongDoubleFunction
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
