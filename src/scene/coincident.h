// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace orrery::scene {

/// A sphere, and the first earlier sphere with exactly the same centre and absolute radius.
struct Coincident {
  std::string key;    ///< "sphere[3]", "points[0].file"
  std::string name;   ///< for a points file, see sphere_name(); otherwise empty
  std::string first;  ///< the earlier one: "sphere[0]", "row 1 of a.csv"
};

struct Coincidents {
  std::vector<Coincident> reported;  ///< in scene order
  std::size_t count = 0;             ///< number of all coincident spheres, including those not in `reported`
};

/// Returns the number of spheres that coincide with an earlier one, and the keys of the first `max_reported` of them.
/// With `precision = "fast"`, spheres coincide if they are equal in single precision.
///
/// `closing`  the scene at shutter close: spheres that coincide only at shutter open are not counted; null: no motion
/// Cost       see base::find_duplicates
Coincidents coincident_spheres(const Scene& scene, std::size_t max_reported, const Scene* closing = nullptr);

}  // namespace orrery::scene
