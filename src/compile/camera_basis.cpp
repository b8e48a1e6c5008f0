// SPDX-License-Identifier: Apache-2.0
#include "compile/camera_basis.h"

#include <cmath>
#include <cstdlib>
#include <numbers>

#include "scene/scene.h"

namespace orrery::compile {
namespace {

using math::Vec3d;

double tangent_of_half(double angle_deg) {
  return static_cast<double>(std::tan(static_cast<long double>(angle_deg) / 360 * std::numbers::pi_v<long double>));
}

}  // namespace

CameraAxes camera_axes(const scene::Camera& camera) {
  const Vec3d z = math::normalized(camera.look_from - camera.look_at);
  const Vec3d x = math::normalized(math::cross(math::normalized(camera.up), z));
  return {x, math::cross(z, x), z};
}

double focus_distance(const scene::Camera& camera) {
  return camera.focus_distance.value_or(math::length(camera.look_from - camera.look_at));
}

double view_scale(const scene::Camera& camera) {
  constexpr int kMaxUnscaledExponent = 40;
  if (camera.projection == scene::Projection::kOrthographic) return 1;
  const int exponent = std::ilogb(focus_distance(camera));
  return std::abs(exponent) <= kMaxUnscaledExponent ? 1 : std::ldexp(1.0, -exponent);
}

kernel::Camera compile_camera(const scene::Camera& camera, const scene::Image& image, double view_scale) {
  const CameraAxes axes = camera_axes(camera);
  const double focus = focus_distance(camera);
  const bool is_orthographic = camera.projection == scene::Projection::kOrthographic;
  const double pixel = is_orthographic ? camera.width.value_or(0) / (image.width * image.pixel_aspect)
                                       : 2 * tangent_of_half(camera.vfov) * focus / image.height;
  const double lens_radius = camera.defocus_angle > 0 ? tangent_of_half(camera.defocus_angle) * focus : 0;
  kernel::Camera out;
  out.origin = camera.look_from;
  out.forward = axes.z * -focus * view_scale;
  out.right = axes.x * (pixel * image.pixel_aspect) * view_scale;
  out.down = axes.y * -pixel * view_scale;
  out.lens_u = axes.x * lens_radius;
  out.lens_v = axes.y * lens_radius;
  out.is_orthographic = is_orthographic;
  out.half_width = image.width / 2.0 - image.data_window().x;
  out.half_height = image.height / 2.0 - image.data_window().y;
  return out;
}

}  // namespace orrery::compile
