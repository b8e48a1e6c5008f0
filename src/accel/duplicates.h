// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/precision.h"
#include "kernel/scene_view.h"

namespace orrery::accel {

/// Ids, ascending, of spheres that coincide with an earlier one: equal centre and radius, in the number type of this
/// precision, throughout the shutter interval.
///
/// Accelerators skip them. Root exclusion is by the id of the sphere that a ray leaves, so a coincident second sphere
/// would be hit again at a distance of a few rounding errors.
///
/// Cost       none if the scene is known to have none; else see base::find_duplicates
std::vector<std::uint32_t> duplicates(const kernel::SceneView& scene, kernel::Precision precision);

/// A scene, and the ids of its duplicate spheres, which are never hit.
struct DistinctSpheres {
  kernel::SceneView view;
  std::vector<std::uint32_t> duplicates;
};

}  // namespace orrery::accel
