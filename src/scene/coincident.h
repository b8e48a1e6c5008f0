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

/// Spheres that coincide with an earlier one; the first `most_told` of them by name. With `precision = "fast"` spheres
/// coincide that differ by less than single precision can tell.
///
/// `closing`  the scene when the shutter closes: spheres that coincide only when it opens are left out. Null: no motion
/// Cost       see base::find_repeated
Coincidents coincident_spheres(const Scene& scene, std::size_t most_told, const Scene* closing = nullptr);

}  // namespace orrery::scene
