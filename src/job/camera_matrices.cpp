// SPDX-License-Identifier: Apache-2.0
#include "job/camera_matrices.h"

#include <cmath>
#include <cstddef>
#include <numbers>

#include "compile/camera_basis.h"
#include "scene/scene.h"

namespace orrery::job {
namespace {

using Matrix = std::array<double, 16>;

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix out{};
  for (std::size_t row = 0; row < 4; ++row)
    for (std::size_t column = 0; column < 4; ++column)
      for (std::size_t k = 0; k < 4; ++k) out[row * 4 + column] += a[row * 4 + k] * b[k * 4 + column];
  return out;
}

std::array<float, 16> as_float(const Matrix& m) {
  std::array<float, 16> out{};
  for (std::size_t i = 0; i < 16; ++i) out[i] = static_cast<float>(m[i]);
  return out;
}

}  // namespace

CameraMatrices camera_matrices(const scene::Camera& camera, const scene::Image& image) {
  const compile::CameraAxes axes = compile::camera_axes(camera);
  const math::Vec3d x = axes.x, y = axes.y, z = -axes.z, from = camera.look_from;
  const Matrix view = {x.x,
                       y.x,
                       z.x,
                       0,
                       x.y,
                       y.y,
                       z.y,
                       0,
                       x.z,
                       y.z,
                       z.z,
                       0,
                       -math::dot(from, x),
                       -math::dot(from, y),
                       -math::dot(from, z),
                       1};
  const double aspect = image.width * image.pixel_aspect / image.height;
  if (camera.projection == scene::Projection::kOrthographic) {
    // x = X / width + 1/2, y = 1/2 - Y / height, z = Z
    const double width = camera.width.value_or(0);
    const Matrix parallel = {1 / width, 0, 0, 0, 0, -aspect / width, 0, 0, 0, 0, 1, 0, 0.5, 0.5, 0, 1};
    return {as_float(view), as_float(product(view, parallel))};
  }
  const double tangent = std::tan(camera.vfov / 360 * std::numbers::pi);
  // x / w = (X / (Z tangent aspect) + 1) / 2, y / w = (1 - Y / (Z tangent)) / 2, z / w = 1: layers hold the depth.
  const Matrix projection = {0.5 / (tangent * aspect), 0, 0, 0, 0, -0.5 / tangent, 0, 0, 0.5, 0.5, 1, 1, 0, 0, 0, 0};
  return {as_float(view), as_float(product(view, projection))};
}

}  // namespace orrery::job
