// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace orrery::film {

/// One channel of a picture.
struct Plane {
  std::string name;           ///< as in the EXR header: "R", "G", "B", "A", "variance.R"
  std::vector<float> values;  ///< width * height, rows from the top, left to right
};

/// A finished picture: scene-linear planes of one size.
struct Picture {
  int width = 0;   ///< px
  int height = 0;  ///< px
  std::vector<Plane> planes;

  const Plane* find(const std::string& name) const {
    for (const Plane& plane : planes)
      if (plane.name == name) return &plane;
    return nullptr;
  }
};

/// The largest finite half.
inline constexpr float kLargestHalf = 65504.0f;

/// Values that a display or a file cannot show as they are; counted before any display transform.
struct BadValues {
  std::uint64_t nan = 0;
  std::uint64_t infinite = 0;
  std::uint64_t negative = 0;
  std::uint64_t above_half = 0;  ///< finite but beyond the largest half
};

/// Counts what is not fit to be shown in all planes of a picture.
BadValues count_bad_values(const Picture& picture);

}  // namespace orrery::film
