// SPDX-License-Identifier: Apache-2.0
#include "job/camera_matrices.h"

#include <gtest/gtest.h>

#include <cmath>

#include "compile/camera_basis.h"
#include "scene/scene.h"

namespace orrery::job {
namespace {

using math::Vec3d;

struct Point4 {
  double x, y, z, w;
};

/// A row vector times a row-major matrix, as in OpenEXR.
Point4 times(Vec3d p, const std::array<float, 16>& m) {
  const double in[4] = {p.x, p.y, p.z, 1};
  double out[4] = {};
  for (std::size_t column = 0; column < 4; ++column)
    for (std::size_t row = 0; row < 4; ++row) out[column] += in[row] * static_cast<double>(m[row * 4 + column]);
  return {out[0], out[1], out[2], out[3]};
}

scene::Camera book_camera() {
  scene::Camera camera;
  camera.look_from = {13, 2, 3};
  camera.look_at = {0, 0, 0};
  camera.vfov = 20;
  return camera;
}

TEST(JobCameraMatrices, CameraSpaceIsLeftHandedAndLooksForward) {
  scene::Camera camera;
  camera.look_from = {1, 2, 3};
  camera.look_at = {1, 2, -5};
  const CameraMatrices m = camera_matrices(camera, {});
  const Point4 origin = times({1, 2, 3}, m.world_to_camera);
  EXPECT_EQ(origin.x, 0);
  EXPECT_EQ(origin.y, 0);
  EXPECT_EQ(origin.z, 0);
  EXPECT_EQ(origin.w, 1);
  const Point4 ahead = times({1, 2, -7}, m.world_to_camera);
  EXPECT_DOUBLE_EQ(ahead.z, 10) << "what is seen has positive z";
  const Point4 right_and_up = times({2, 5, 3}, m.world_to_camera);
  EXPECT_DOUBLE_EQ(right_and_up.x, 1);
  EXPECT_DOUBLE_EQ(right_and_up.y, 3);
}

TEST(JobCameraMatrices, CameraSpaceKeepsDistances) {
  const CameraMatrices m = camera_matrices(book_camera(), {});
  const Point4 target = times({0, 0, 0}, m.world_to_camera);
  EXPECT_NEAR(target.x, 0, 1e-5);
  EXPECT_NEAR(target.y, 0, 1e-5);
  EXPECT_NEAR(target.z, std::sqrt(13 * 13 + 2 * 2 + 3 * 3), 1e-5);
}

TEST(JobCameraMatrices, LookAtIsAtTheCentreOfTheImage) {
  const CameraMatrices m = camera_matrices(book_camera(), {1200, 675});
  const Point4 p = times({0, 0, 0}, m.world_to_ndc);
  EXPECT_NEAR(p.x / p.w, 0.5, 1e-6);
  EXPECT_NEAR(p.y / p.w, 0.5, 1e-6);
}

TEST(JobCameraMatrices, NdcGoesFromZeroToOneFromTheUpperLeft) {
  scene::Camera camera;  // looks along -z, 90 degrees high: at distance 1 it sees y -1..1
  const CameraMatrices m = camera_matrices(camera, {1600, 800});
  const Point4 upper_left = times({-2 * 3, 1 * 3, -3}, m.world_to_ndc);
  EXPECT_NEAR(upper_left.x / upper_left.w, 0, 1e-6);
  EXPECT_NEAR(upper_left.y / upper_left.w, 0, 1e-6);
  const Point4 lower_right = times({2 * 7, -1 * 7, -7}, m.world_to_ndc);
  EXPECT_NEAR(lower_right.x / lower_right.w, 1, 1e-6);
  EXPECT_NEAR(lower_right.y / lower_right.w, 1, 1e-6);
}

TEST(JobCameraMatrices, PointsProjectToThePixelWhoseRaysHitThem) {
  const scene::Camera camera = book_camera();
  const scene::Image image{1200, 675};
  const CameraMatrices m = camera_matrices(camera, image);
  const kernel::Camera rays = compile::compile_camera(camera, image, 1);
  for (const double px : {0.0, 17.5, 600.0, 1199.0}) {
    for (const double py : {0.0, 337.5, 674.0}) {
      const double x = px - rays.half_width, y = py - rays.half_height;
      const auto at = [&](int i) {
        return rays.origin[i] + 1.7 * (rays.forward[i] + x * rays.right[i] + y * rays.down[i]);
      };
      const Point4 p = times({at(0), at(1), at(2)}, m.world_to_ndc);
      EXPECT_NEAR(p.x / p.w * image.width, px, 1e-3);
      EXPECT_NEAR(p.y / p.w * image.height, py, 1e-3);
    }
  }
}

TEST(JobCameraMatrices, OrthographicPointsProjectToThePixelWhoseRaysHitThem) {
  scene::Camera camera = book_camera();
  camera.projection = scene::Projection::kOrthographic;
  camera.width = 5;
  const scene::Image image{1200, 675, 1.5};
  const CameraMatrices m = camera_matrices(camera, image);
  const kernel::Camera rays = compile::compile_camera(camera, image, 1);
  for (const double px : {0.0, 17.5, 1199.0}) {
    for (const double py : {0.0, 674.0}) {
      const double x = px - rays.half_width, y = py - rays.half_height;
      const auto at = [&](int i) {
        return rays.origin[i] + 0.7 * rays.forward[i] + x * rays.right[i] + y * rays.down[i];
      };
      const Point4 p = times({at(0), at(1), at(2)}, m.world_to_ndc);
      EXPECT_EQ(p.w, 1);
      EXPECT_NEAR(p.x * image.width, px, 1e-3);
      EXPECT_NEAR(p.y * image.height, py, 1e-3);
      EXPECT_NEAR(p.z, 0.7 * math::length(camera.look_from), 1e-4);
    }
  }
}

}  // namespace
}  // namespace orrery::job
