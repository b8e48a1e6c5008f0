// SPDX-License-Identifier: Apache-2.0
#include "film/display_error.h"

namespace orrery::film {

double display_error_squared(const kernel::PixelSum& a, const kernel::PixelSum& b) noexcept {
  if (a.weight <= 0 || b.weight <= 0) return 0;
  double squares = 0, light = 0;
  for (int c = 0; c < 3; ++c) {
    const double x = kernel::from_fixed_point(a.rgb[c]) / static_cast<double>(a.weight);
    const double y = kernel::from_fixed_point(b.rgb[c]) / static_cast<double>(b.weight);
    squares += (x - y) * (x - y) / 4;  // their mean is off by half as much as they differ
    light += (x + y) / 2;
  }
  return display_error_squared(squares, light);
}

}  // namespace orrery::film
