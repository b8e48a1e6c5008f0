// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "kernel/camera.h"
#include "kernel/sphere.h"
#include "math/vec3.h"

namespace orrery::render {

inline math::Vec3d center_of(const kernel::Sphere& sphere) { return {sphere.x, sphere.y, sphere.z}; }
inline kernel::Sphere sphere_around(math::Vec3d center, double radius) {
  return {center.x, center.y, center.z, radius};
}

/// An object when the shutter opens and closes.
template <class T>
using Moving = std::array<T, 2>;

/// The distance of the sky, in distances to the focus plane. The result does not depend on it as long as it is large.
inline constexpr double kSkyDistance = 0x1p40;

/// An emitter as far away as the sky.
///
/// `direction`  unit
kernel::Sphere distant_sphere(const kernel::Camera& camera, math::Vec3d direction, double solid_angle);

/// The image of a sphere, or of a part of a rod: a rectangle around it, and its area without the blur of the lens.
struct SphereImage {
  double x0, x1, y0, y1;  ///< px, relative to the rendered window
  double area;            ///< square pixels
};

/// Projects a sphere. Empty if the sphere is behind the camera or contains it.
std::optional<SphereImage> sphere_image(const kernel::Camera& camera, const kernel::Sphere& sphere);

/// The distance between the centres of two images, px.
double distance(const SphereImage& a, const SphereImage& b);

/// The image of a cylinder between two spheres, and of a part of the spheres. Empty if one of them has none.
std::optional<SphereImage> between(const std::optional<SphereImage>& a, const std::optional<SphereImage>& b,
                                   double part);

}  // namespace orrery::render
