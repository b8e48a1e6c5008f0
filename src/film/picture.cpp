// SPDX-License-Identifier: Apache-2.0
#include "film/picture.h"

#include <cmath>

namespace orrery::film {

BadValues count_bad_values(const Picture& picture) {
  BadValues bad;
  for (const Plane& plane : picture.planes) {
    for (const float v : plane.values) {
      if (std::isnan(v)) {
        ++bad.nan;
      } else if (std::isinf(v)) {
        ++bad.infinite;
      } else {
        if (v < 0) ++bad.negative;
        if (std::abs(v) > kLargestHalf) ++bad.above_half;
      }
    }
  }
  return bad;
}

}  // namespace orrery::film
