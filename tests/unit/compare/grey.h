// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "compare/compare_files.h"

namespace orrery::compare {

inline film::Picture grey(int width, int height, float value) {
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  film::Picture picture{width, height, {}};
  for (const char* name : {"R", "G", "B"}) picture.planes.push_back({name, std::vector<float>(pixels, value)});
  return picture;
}

inline Comparison of_light(const film::Picture& a, const film::Picture& b) { return compare(a, b, Encoding::kLight); }

}  // namespace orrery::compare
