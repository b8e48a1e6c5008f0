// SPDX-License-Identifier: Apache-2.0
#include "render/sphere_images.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace orrery::render {
namespace {

using math::Vec3d;

}  // namespace

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

std::optional<Reflection> reflection_of(const kernel::Sphere& light, const kernel::Sphere& ball, Vec3d eye, int steps) {
  constexpr double kParallel = 1e-3;
  const Vec3d center = center_of(ball), to_eye = (eye - center) / ball.radius,
              to_light = (center_of(light) - center) / ball.radius;
  const double p = length(to_eye), d = length(to_light), radius = light.radius / ball.radius;
  if (!(p > 1 && d > 1 + radius)) return std::nullopt;

  // The point on the arc between both at which both have the same angle to the normal.
  Vec3d nearer = to_eye / p, farther = to_light / d, point;
  const double sine = length(cross(nearer, farther));
  double cosine = 0;
  for (int i = 0; i < steps; ++i) {
    point = normalized(nearer + farther);
    cosine = dot(point, normalized(to_eye - point));
    (cosine > dot(point, normalized(to_light - point)) ? nearer : farther) = point;
  }
  if (!(cosine > 0)) return std::nullopt;  // behind the ball

  // A ray of the impact parameter s = sin i turns around the centre by an angle Theta(i) whose derivative is h(i). The
  // directions in which the light is seen are those of s ds, and those in which the ball sees it of sin Theta dTheta.
  const double s2 = 1 - cosine * cosine, from_eye = std::sqrt(p * p - s2), from_light = std::sqrt(d * d - s2);
  const double h = 2 - cosine / from_eye - cosine / from_light;
  const double ratio = sine > kParallel ? std::sqrt(s2) / sine : 1 / h;
  const double square = radius * radius / (d * from_light) * ratio * cosine / h / (p * from_eye);  // of half its angle
  const Vec3d along = normalized(point - to_eye);
  const double away = length(point - to_eye) + cosine / 2;  // a small mirror's focal length, as it makes images blur
  const Vec3d seen = center + (to_eye + along * away) * ball.radius;
  return Reflection{sphere_around(seen, away * std::sqrt(square) * ball.radius), point * ball.radius, cosine};
}

}  // namespace orrery::render
