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

/// Returns the distance from look_from to the focus plane, scene units.
double focus_distance(const scene::Camera& camera);

/// Returns the power of two by which the view vectors of a camera are scaled: 1, unless their squares could overflow or
/// underflow in single precision. Only their ratios matter.
///
/// Domain     a camera without a lens
double view_scale(const scene::Camera& camera);

/// Returns the camera in the form in which the kernel generates rays.
///
/// `view_scale`  scale of the view vectors, the same at shutter open and close; 1 with a lens
/// Precision  tangents are rounded from long double, so that they do not depend on the processor
kernel::Camera compile_camera(const scene::Camera& camera, const scene::Image& image, double view_scale);

}  // namespace orrery::compile
