// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace orrery::math {

/// Rounds to single precision.
///
/// GCC 12 takes the conversions to float and back for a conversion that changes nothing where it vectorizes them in
/// pairs, as in `for (Vec3d& p : points) p = {rounded(p.x), rounded(p.y), rounded(p.z)}`. Values that pass through
/// inline assembly are not vectorized.
inline double in_single_precision(double x) noexcept {
  auto single = static_cast<float>(x);
  __asm__("" : "+x"(single));
  return static_cast<double>(single);
}

}  // namespace orrery::math
