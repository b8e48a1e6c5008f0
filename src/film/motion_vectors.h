// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "kernel/camera.h"
#include "kernel/forward.h"
#include "kernel/rod.h"
#include "kernel/sphere.h"
#include "math/vec3.h"

namespace orrery::film {

struct Sums;

/// What has moved a frame before or after that of the image.
struct NeighborFrame {
  kernel::Camera camera;
  std::vector<kernel::Sphere> sphere_motion;  ///< change of the first spheres since the frame of the image
  std::vector<kernel::Rod> rod_motion;        ///< the same of the rods
};

/// The frames before and after that of the image; null: there is none.
using NeighborFrames = std::array<std::shared_ptr<const NeighborFrame>, 2>;

/// A place in the image.
///
/// Space      px from the centre of the frame, y down
struct FilmPlace {
  double x, y;
};

/// Where a camera sees a point through the centre of its lens; empty if the point is not in front of it.
///
/// `from_camera`  the point relative to the camera's origin, or the direction of a point at infinity
std::optional<FilmPlace> film_place(const kernel::Camera& camera, math::Vec3d from_camera);

/// Writes the motion vector of a pixel's nearest hit, or of the background at its centre: X and Y of the place in the
/// frame before less that in this one, then of the place in this frame less that in the next. As in Blender, y is up.
/// 0 where there is no such frame or place.
///
/// Units      px
/// Domain     `sums` has hits and positions
/// Reference  docs/decisions/0045-motion-vectors.md
void write_motion_vector(const NeighborFrames& neighbors, const kernel::SceneView& view, const Sums& sums,
                         std::size_t pixel, float* xyzw);

}  // namespace orrery::film
