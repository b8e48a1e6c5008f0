// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace orrery::scene {

/// A sphere with exactly the centre and the absolute radius of one before it, both by their keys: "sphere[3]",
/// "points[0][17]".
struct Coincident {
  std::string key, first;
};

struct Coincidents {
  std::vector<Coincident> told;  ///< in the scene's order
  std::size_t count = 0;         ///< of all, told or not
};

/// Spheres that are in exactly the same place as an earlier one; the first `most_told` of them by name.
///
/// Cost       O(n log n), 16 bytes a sphere, and a table entry for each place that has several
Coincidents coincident_spheres(const Scene& scene, std::size_t most_told);

}  // namespace orrery::scene
