// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "kernel/sphere.h"

namespace orrery::accel {

/// The space in which a box hierarchy in single precision holds the scene's spheres: recentred on their middle and
/// scaled by a power of two to about one, so that neither the scene's place nor its size costs a bit.
///
/// Boxes are padded by what rounding rays and boxes to floats can move them apart, hence no hit is ever lost:
/// boxes are a hint, the hit itself is computed from the authored doubles.
class BoxFrame {
 public:
  BoxFrame() = default;

  /// `motion`   of the spheres below moving_count, which are then held with all the way they go
  /// Domain     `ids` not empty
  BoxFrame(const kernel::Sphere* spheres, const std::vector<std::uint32_t>& ids, const kernel::Sphere* motion = nullptr,
           std::size_t moving_count = 0);

  /// Corners of a sphere's padded box.
  struct Box {
    float lower[3], upper[3];
  };
  Box box(const kernel::Sphere& sphere) const noexcept;

  double middle[3] = {0, 0, 0};  ///< world space
  double scale = 1;              ///< box space = (world - middle) * scale; a power of two
  double reach = 1;              ///< box space: radius of a sphere around the origin that holds all boxes
  double padding = 0;            ///< box space
};

}  // namespace orrery::accel
