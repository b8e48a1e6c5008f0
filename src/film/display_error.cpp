// SPDX-License-Identifier: Apache-2.0
#include "film/display_error.h"

#include <algorithm>

namespace orrery::film {

HalvesEstimate compare_halves(const kernel::PixelSum& a, const kernel::PixelSum& b) noexcept {
  HalvesEstimate out;
  if (a.weight <= 0 || b.weight <= 0) return out;
  double squares = 0;
  for (int c = 0; c < 3; ++c) {
    const double x = kernel::from_fixed_point(a.rgb[c]) / static_cast<double>(a.weight);
    const double y = kernel::from_fixed_point(b.rgb[c]) / static_cast<double>(b.weight);
    out.variance += (x - y) * (x - y) / 4 / 3;  // the mean's expected error is half the difference of the halves
    out.light += (x + y) / 2 / 3;
    squares += (x + y) * (x + y) / 4 / 3;
  }
  if (out.light > 0) out.color = std::min(squares / (out.light * out.light), 3.0);
  return out;
}

}  // namespace orrery::film
