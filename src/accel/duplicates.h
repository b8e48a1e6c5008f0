// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/precision.h"
#include "kernel/scene_view.h"

namespace orrery::accel {

/// Ids, ascending, of spheres that coincide with an earlier one: the same centre and the same radius in the numbers
/// that this precision computes with, all the while the shutter is open.
///
/// No accelerator holds them. A ray that leaves a sphere has its own root excluded by the sphere's id; a second sphere
/// in the same place would be hit again at a distance of some rounding errors.
///
/// Cost       see base::find_repeated
std::vector<std::uint32_t> duplicates(const kernel::SceneView& scene, kernel::Precision precision);

/// The spheres of a scene, and which of them no ray meets.
struct DistinctSpheres {
  kernel::SceneView view;
  std::vector<std::uint32_t> duplicates;
};

}  // namespace orrery::accel
