// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "points/color_map.h"

namespace orrery::points {

/// How the colours of a file's spheres are determined: one of the alternatives of scene::PointsColor.
struct ColorSource {
  enum class Kind { kNone, kMap, kElement, kType, kRgb };
  Kind kind = Kind::kNone;
  std::vector<std::string> columns;  ///< columns to read
  double rgb_maximum = 255;
  std::optional<ColorMap> map;
};

}  // namespace orrery::points
