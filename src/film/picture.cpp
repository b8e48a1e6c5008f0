// SPDX-License-Identifier: Apache-2.0
#include "film/picture.h"

#include <cmath>

#include "base/error.h"

namespace orrery::film {

const Plane& Picture::at(const std::string& name) const {
  const Plane* const found = find(name);
  if (found == nullptr) throw base::Error(base::ErrorKind::kBadData, "the image has no channel " + name);
  return *found;
}

BadValues& BadValues::operator+=(const BadValues& other) {
  nan += other.nan;
  infinite += other.infinite;
  negative += other.negative;
  above_half += other.above_half;
  return *this;
}

BadValues count_bad_values(const Plane& plane) {
  BadValues bad;
  for (const float v : plane.values) {
    if (std::isnan(v)) {
      ++bad.nan;
    } else if (std::isinf(v)) {
      ++bad.infinite;
    } else if (plane.kind != PlaneKind::kData) {
      if (v < 0 && plane.kind == PlaneKind::kLight) ++bad.negative;
      if (std::abs(v) > kLargestHalf) ++bad.above_half;
    }
  }
  return bad;
}

}  // namespace orrery::film
