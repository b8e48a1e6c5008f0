// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "kernel/sphere_array.h"

namespace orrery::accel {

/// The space of a single-precision BVH: the spheres recentred on the origin and scaled by a power of two to order one,
/// so that neither the scene's position nor its size costs precision.
///
/// Boxes are padded by the worst rounding error of rays and boxes in float, so no hit is lost. Boxes only select
/// candidates; the hit itself is computed from the authored doubles.
class BoxFrame {
 public:
  BoxFrame() = default;

  /// `motion`   of the spheres below moving_count; the frame then encloses their whole motion
  /// Domain     `ids` not empty
  BoxFrame(const kernel::SphereArray& spheres, const std::vector<std::uint32_t>& ids,
           const kernel::Sphere* motion = nullptr, std::size_t moving_count = 0);

  /// A sphere's padded bounding box.
  struct Box {
    float lower[3], upper[3];
  };
  Box box(const kernel::Sphere& sphere) const noexcept;

  double middle[3] = {0, 0, 0};  ///< world space
  double scale = 1;              ///< box space = (world - middle) * scale; a power of two
  double reach = 1;              ///< box space: radius of a sphere around the origin that encloses all boxes
  double padding = 0;            ///< box space
};

}  // namespace orrery::accel
