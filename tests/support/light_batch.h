// SPDX-License-Identifier: Apache-2.0
// The kernel's light sampling, one call at a time.
#pragma once

#include <cstdint>

#include "kernel/scene_view.h"
#include "math/vec3.h"

namespace orrery::test {

struct VisiblePoint {
  math::Vec3d direction;  ///< unit, to the point
  math::Vec3d normal;     ///< unit, of the sphere
  double solid_angle;     ///< of the sphere, steradians
};

/// Samples a point of a sphere that is visible from the origin.
VisiblePoint visible_point(math::Vec3d center, double radius, double u, double v);

struct Choice {
  std::uint32_t sphere;
  double probability;
};

/// Chooses an emitter for a vertex.
Choice choose_light(const kernel::SceneView& scene, math::Vec3d point, math::Vec3d normal, double u, double fresh);

/// The probability of that choice.
double choice_probability(const kernel::SceneView& scene, math::Vec3d point, math::Vec3d normal, std::uint32_t sphere);

}  // namespace orrery::test
