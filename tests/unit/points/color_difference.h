// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "points/color_map.h"

namespace orrery::points {

/// Largest difference of two colours, in units of 1/255.
inline double difference(Vec3d a, Vec3d b) {
  return 255 * std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
}

}  // namespace orrery::points
