// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include "compile/forward.h"
#include "image/header.h"
#include "job/job.h"
#include "load/read_scene.h"
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

/// The header of a job's images: camera, colour space, settings, statistics.
///
/// `reproducible` omits everything that depends on the machine, the thread count or the accelerator.
image::Header picture_header(const load::ReadResult& read, const compile::CompiledScene& compiled,
                             const JobReport& report, bool reproducible);

/// All settings as lines of a scene file: "camera.vfov = 20".
///
/// `reproducible` omits the accelerator.
std::string settings_lines(const load::ReadResult& read, bool reproducible);

}  // namespace orrery::job
