// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/forward.h"
#include "kernel/precision.h"

namespace orrery::accel {

/// Ids, ascending, of spheres that coincide with an earlier one: equal centre and radius, in the number type of this
/// precision, throughout the shutter interval.
///
/// Accelerators skip them. Root exclusion is by the id of the sphere that a ray leaves, so a coincident second sphere
/// would be hit again at a distance of a few rounding errors.
///
/// Cost       none if the scene is known to have no duplicates; else see base::find_duplicates
std::vector<std::uint32_t> duplicates(const kernel::SceneView& scene, kernel::Precision precision);

}  // namespace orrery::accel
