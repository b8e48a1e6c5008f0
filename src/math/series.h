// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace orrery::math {

/// pi / 2.
inline constexpr double kHalfPi = 1.57079632679489661923;

namespace detail {
/// Returns the Taylor coefficients of sin (first = 1) or cos (first = 0) of (pi / 2) r in powers of r^2; the caller
/// multiplies the sine by r.
constexpr std::array<double, 9> quarter_series(int first) {
  std::array<double, 9> c{};
  double term = first == 1 ? kHalfPi : 1.0;
  for (int i = 0; i < 9; ++i) {
    c[static_cast<unsigned>(i)] = term;
    const int n = 2 * i + first;
    term = -term * kHalfPi * kHalfPi / ((n + 1) * (n + 2));
  }
  return c;
}

/// Returns the Taylor coefficients of atan(r) / (2 pi) in powers of r^2; the caller multiplies by r.
constexpr std::array<double, 11> atan_turn_series() {
  std::array<double, 11> c{};
  for (int i = 0; i < 11; ++i) c[static_cast<unsigned>(i)] = (i % 2 == 0 ? 1 : -1) / ((2 * i + 1) * 4 * kHalfPi);
  return c;
}
}  // namespace detail

inline constexpr std::array<double, 9> kSinQuarter = detail::quarter_series(1);
inline constexpr std::array<double, 9> kCosQuarter = detail::quarter_series(0);
inline constexpr std::array<double, 11> kAtanTurn = detail::atan_turn_series();

}  // namespace orrery::math
