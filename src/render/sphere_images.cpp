// SPDX-License-Identifier: Apache-2.0
#include "render/sphere_images.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace orrery::render {

using math::Vec3d;

kernel::Sphere distant_sphere(const kernel::Camera& camera, Vec3d direction, double solid_angle) {
  const double distance = kSkyDistance * length(camera.forward);
  return sphere_around(camera.origin + direction * distance, distance * std::sqrt(solid_angle / std::numbers::pi));
}

std::optional<SphereImage> sphere_image(const kernel::Camera& camera, const kernel::Sphere& sphere) {
  const Vec3d &forward = camera.forward, &right = camera.right, &down = camera.down;
  const Vec3d to = center_of(sphere) - camera.origin, across = cross(right, down);
  const double determinant = dot(forward, across), radius = sphere.radius;
  const double depth = dot(to, across) / determinant;  // 1 at the focus plane
  if (!(depth * length(forward) > radius)) return std::nullopt;
  const double scale = camera.is_orthographic ? 1 : depth;
  const double x = dot(to, cross(down, forward)) / (determinant * scale) + camera.half_width;
  const double y = dot(to, cross(forward, right)) / (determinant * scale) + camera.half_height;
  const double pixel_width = scale * length(right), pixel_height = scale * length(down);  // at the sphere
  const double blurred = radius + length(camera.lens_u) * std::abs(1 - depth);
  return SphereImage{x - blurred / pixel_width, x + blurred / pixel_width, y - blurred / pixel_height,
                     y + blurred / pixel_height, std::numbers::pi * radius * radius / (pixel_width * pixel_height)};
}

double distance(const SphereImage& a, const SphereImage& b) {
  return std::hypot((a.x0 + a.x1 - b.x0 - b.x1) / 2, (a.y0 + a.y1 - b.y0 - b.y1) / 2);
}

std::optional<SphereImage> between(const std::optional<SphereImage>& a, const std::optional<SphereImage>& b,
                                   double part) {
  if (!a || !b) return std::nullopt;
  return SphereImage{std::min(a->x0, b->x0), std::max(a->x1, b->x1), std::min(a->y0, b->y0), std::max(a->y1, b->y1),
                     distance(*a, *b) * (std::sqrt(a->area) + std::sqrt(b->area)) / std::sqrt(std::numbers::pi) +
                         part * (a->area + b->area) / 2};
}

}  // namespace orrery::render
