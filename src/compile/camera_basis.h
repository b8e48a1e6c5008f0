// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernel/camera.h"
#include "math/vec3.h"
#include "scene/scene.h"

namespace orrery::compile {

/// The orthonormal axes of a camera.
///
/// Space      world; right-handed: x to the right in the image, y up, z against the view direction
struct CameraAxes {
  math::Vec3d x, y, z;
};
CameraAxes camera_axes(const scene::Camera& camera);

/// Returns the distance from look_from to the plane of focus, scene units.
double focus_distance(const scene::Camera& camera);

/// Returns the camera in the form in which the kernel generates rays.
///
/// Precision  tangents are rounded from long double, so that they do not depend on the processor
kernel::Camera compile_camera(const scene::Camera& camera, const scene::Image& image);

}  // namespace orrery::compile
