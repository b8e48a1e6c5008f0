// SPDX-License-Identifier: Apache-2.0
// Origins and focus points of thin-lens camera rays.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "kernel/camera-inl.h"
#include "support/first_lane-inl.h"

namespace orrery::kernel {
struct CameraCase {
  Camera camera;
  bool has_lens = true;
  double pixel[2] = {0, 0}, random[4] = {0.5, 0.5, 0.5, 0.5};
  double offset[3] = {}, direction[3] = {};
};
}  // namespace orrery::kernel

HWY_BEFORE_NAMESPACE();
namespace orrery::kernel::HWY_NAMESPACE {

void camera_case(CameraCase& c) {
  const hn::FixedTag<double, 1> d;
  using V = hn::Vec<hn::FixedTag<double, 1>>;
  const Four<V> random{
      {hn::Set(d, c.random[0]), hn::Set(d, c.random[1]), hn::Set(d, c.random[2]), hn::Set(d, c.random[3])}};
  SceneView scene;
  scene.camera = c.camera;
  scene.features.lens = c.has_lens;
  const auto ray =
      camera_ray(d, scene, camera_vectors(d, scene, nullptr), hn::Set(d, c.pixel[0]), hn::Set(d, c.pixel[1]), random);
  math::set(c.offset, test::HWY_NAMESPACE::first_lane(ray.offset));
  math::set(c.direction, test::HWY_NAMESPACE::first_lane(ray.direction));
}

}  // namespace orrery::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace orrery::kernel {
namespace {

/// Looks along -z through a lens of radius 2; the focus plane is at distance 10, with one unit per pixel.
CameraCase lens_case() {
  CameraCase c;
  c.camera.forward = {0, 0, -10};
  c.camera.lens_u = {2, 0, 0};
  c.camera.lens_v = {0, 2, 0};
  c.camera.half_width = 4;
  c.camera.half_height = 3;
  return c;
}

TEST(KernelCamera, LensRaysStartOnTheLensAndIntersectOnTheFocusPlane) {
  std::mt19937_64 engine(5);
  double farthest = 0, corner = 0;
  for (int i = 0; i < 20000; ++i) {
    CameraCase c = lens_case();
    c.pixel[0] = 6;
    c.pixel[1] = 1;
    for (double& u : c.random) u = static_cast<double>(engine() >> 11) * 0x1p-53;
    HWY_NAMESPACE::camera_case(c);
    const double x = c.pixel[0] + c.random[0] - 4, y = -(c.pixel[1] + c.random[1] - 3);  // on the plane
    const double along = -10 / c.direction[2];
    EXPECT_NEAR(c.offset[0] + along * c.direction[0], x, 1e-13);
    EXPECT_NEAR(c.offset[1] + along * c.direction[1], y, 1e-13);
    EXPECT_EQ(c.offset[2], 0);
    EXPECT_NEAR(std::hypot(c.direction[0], c.direction[1], c.direction[2]), 1, 1e-15);
    farthest = std::max(farthest, std::hypot(c.offset[0], c.offset[1]));
    corner = std::max(corner, std::min(std::abs(c.offset[0]), std::abs(c.offset[1])));
  }
  EXPECT_LE(farthest, 2 * (1 + 1e-15));
  EXPECT_GT(farthest, 2 * 0.999);
  EXPECT_GT(corner, std::sqrt(2.0) * 0.98) << "samples also cover the diagonal of the disc";
}

TEST(KernelCamera, PinholeRaysStartAtThePinhole) {
  CameraCase c = lens_case();
  c.has_lens = false;
  c.random[2] = 0.9;
  HWY_NAMESPACE::camera_case(c);
  for (const double x : c.offset) EXPECT_EQ(x, 0);
  EXPECT_NEAR(c.direction[0] / c.direction[2], (0.5 - 4) / -10, 1e-15);
  EXPECT_NEAR(c.direction[1] / c.direction[2], (3 - 0.5) / -10, 1e-15);
}

TEST(KernelCamera, OrthographicRaysAreParallel) {
  for (const double place : {0.0, 0.25, 0.9}) {
    CameraCase c = lens_case();
    c.has_lens = false;
    c.camera.is_orthographic = true;
    c.random[0] = place;
    c.pixel[1] = 5;
    HWY_NAMESPACE::camera_case(c);
    EXPECT_EQ(c.offset[0], place - 4);
    EXPECT_EQ(c.offset[1], -2.5);
    EXPECT_EQ(c.offset[2], 0);
    EXPECT_EQ(c.direction[0], 0);
    EXPECT_EQ(c.direction[1], 0);
    EXPECT_EQ(c.direction[2], -1);
  }
}

TEST(KernelCamera, OrthographicLensRaysIntersectOnTheFocusPlane) {
  CameraCase c = lens_case();
  c.camera.is_orthographic = true;
  c.random[2] = 0.1;
  c.random[3] = 0.7;
  HWY_NAMESPACE::camera_case(c);
  const double along = -10 / c.direction[2];
  EXPECT_NE(c.direction[0], 0);
  EXPECT_NEAR(c.offset[0] + along * c.direction[0], 0.5 - 4, 1e-13);
  EXPECT_NEAR(c.offset[1] + along * c.direction[1], 3 - 0.5, 1e-13);
}

}  // namespace
}  // namespace orrery::kernel
