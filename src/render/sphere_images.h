// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "kernel/camera.h"
#include "kernel/sphere.h"
#include "math/vec3.h"

namespace orrery::render {

inline math::Vec3d center_of(const kernel::Sphere& sphere) { return {sphere.x, sphere.y, sphere.z}; }
inline kernel::Sphere sphere_around(math::Vec3d center, double radius) {
  return {center.x, center.y, center.z, radius};
}

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

/// How a light is seen in a ball.
struct Reflection {
  kernel::Sphere image;  ///< where the light seems to be, as large as it seems
  math::Vec3d point;     ///< that reflects it, from the ball's centre
  double cosine;         ///< of the angle of incidence
};

/// The reflection of a light in a ball. Empty if there is none, or if eye or light are within the ball.
///
/// `steps`     accuracy of the place: 2^-steps radii of the ball
std::optional<Reflection> reflection_of(const kernel::Sphere& light, const kernel::Sphere& ball, math::Vec3d eye,
                                        int steps);

}  // namespace orrery::render
