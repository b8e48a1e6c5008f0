// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "scene/forward.h"

namespace orrery::job {

/// The camera matrices of an EXR header, in row-major order, for row vectors.
struct CameraMatrices {
  std::array<float, 16> world_to_camera;  ///< x to the right, y up, +z forward (left-handed); scene units
  std::array<float, 16> world_to_ndc;     ///< after division by w: x 0..1 from the left, y 0..1 from the top
};

/// Computes the camera matrices of a frame.
///
/// Reference  openexr-standard-attributes
CameraMatrices camera_matrices(const scene::Camera& camera, const scene::Image& image);

}  // namespace orrery::job
