// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>

namespace orrery::math {

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

}  // namespace orrery::math
