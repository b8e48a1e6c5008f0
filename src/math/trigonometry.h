// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace orrery::math {

// Sine and cosine of an angle in radians, rounded from long double, so that they do not depend on the math library.
inline double sine(double angle) { return static_cast<double>(std::sin(static_cast<long double>(angle))); }
inline double cosine(double angle) { return static_cast<double>(std::cos(static_cast<long double>(angle))); }

}  // namespace orrery::math
