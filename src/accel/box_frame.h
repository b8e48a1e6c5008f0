// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernel/rod.h"
#include "kernel/sphere.h"
#include "math/scalar.h"

namespace orrery::accel {

/// Spheres as the kernel intersects them: in `fast`, rounded to single precision. BVHs bound these.
struct BoundedSpheres {
  kernel::SphereArray spheres;
  bool in_single = false;  ///< rounded as in `fast`; far from the origin, the rounding exceeds the padding of boxes
  const kernel::Sphere* motion = nullptr;  ///< as in kernel::SceneView
  std::size_t moving_count = 0;

  BoundedSpheres() = default;
  BoundedSpheres(const kernel::SphereArray& all, bool rounded = false,  // NOLINT(google-explicit-constructor)
                 const kernel::Sphere* changes = nullptr, std::size_t moving = 0)
      : spheres(all), in_single(rounded), motion(changes), moving_count(moving) {}
  BoundedSpheres(const kernel::Sphere* all) : spheres(all) {}  // NOLINT(google-explicit-constructor)

  kernel::Sphere operator[](std::size_t id) const noexcept {
    const kernel::Sphere s = spheres[id];
    if (!in_single) return s;
    using math::in_single_precision;
    return {in_single_precision(s.x), in_single_precision(s.y), in_single_precision(s.z),
            in_single_precision(s.radius)};
  }

  /// A sphere when the shutter opens (0) or closes (1).
  kernel::Sphere at(std::size_t id, int step) const noexcept {
    const kernel::Sphere s = (*this)[id];
    if (step == 0 || id >= moving_count) return s;
    const kernel::Sphere& change = motion[id];
    return {s.x + change.x, s.y + change.y, s.z + change.z, s.radius + change.radius};
  }

  /// When the shutter opens. See kernel::SphereArray.
  double coordinate(std::size_t id, int axis) const noexcept {
    const double x = spheres.coordinate(id, axis);
    return in_single ? math::in_single_precision(x) : x;
  }
};

/// Rods as the kernel intersects them, see BoundedSpheres.
struct BoundedRods {
  kernel::RodArray rods;
  bool in_single = false;

  /// A rod when the shutter opens (0) or closes (1).
  kernel::Rod at(std::size_t rod, int step) const noexcept {
    kernel::Rod out = in_single ? rounded(rods[rod]) : rods[rod];
    if (step == 0 || !rods.moves(rod)) return out;
    const kernel::Rod change = in_single ? rounded(rods.change(rod)) : rods.change(rod);
    for (int k = 0; k < 3; ++k) {
      out.a[k] += change.a[k];
      out.b[k] += change.b[k];
    }
    out.radius += change.radius;
    return out;
  }

 private:
  static kernel::Rod rounded(kernel::Rod rod) noexcept {
    using math::in_single_precision;
    for (int k = 0; k < 3; ++k) {
      rod.a[k] = in_single_precision(rod.a[k]);
      rod.b[k] = in_single_precision(rod.b[k]);
    }
    rod.radius = in_single_precision(rod.radius);
    return rod;
  }
};

/// The space of a single-precision BVH: spheres and rods recentred on the origin and scaled by a power of two to order
/// one, so that neither the scene's position nor its size costs precision.
///
/// Boxes are padded by the worst rounding error of rays and boxes in float, so no hit is lost. Boxes only select
/// candidates; the hit itself is computed from the authored doubles.
class BoxFrame {
 public:
  BoxFrame() = default;

  /// The frame of the spheres with these ids, and of all rods. It encloses their whole motion.
  ///
  /// Domain     there are ids or rods
  BoxFrame(const BoundedSpheres& spheres, const std::vector<std::uint32_t>& ids, const BoundedRods& rods = {});

  /// A padded bounding box.
  struct Box {
    float lower[3], upper[3];
  };
  Box box(const kernel::Sphere& sphere) const noexcept;
  /// The box of a rod between two fractions of its axis.
  Box box(const kernel::Rod& rod, double from, double to) const noexcept;

  double middle[3] = {0, 0, 0};  ///< world space
  double scale = 1;              ///< box space = (world - middle) * scale; a power of two
  double reach = 1;              ///< box space: radius of a sphere around the origin that encloses all boxes
  double padding = 0;            ///< box space
};

}  // namespace orrery::accel
