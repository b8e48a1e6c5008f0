// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernel/camera.h"
#include "math/vec3.h"
#include "scene/scene.h"

namespace orrery::compile {

/// The orthonormal axes of an authored camera.
///
/// Space      world; right-handed: x to the right of the picture, y up, z against the view
struct CameraAxes {
  math::Vec3d x, y, z;
};
CameraAxes camera_axes(const scene::Camera& camera);

/// From look_from to the plane that is in focus.
double focus_distance(const scene::Camera& camera);

/// The authored camera as the sampler reads it.
///
/// Precision  tangents are rounded from long double, so that they don't depend on the processor
kernel::Camera compile_camera(const scene::Camera& camera, const scene::Image& image);

}  // namespace orrery::compile
