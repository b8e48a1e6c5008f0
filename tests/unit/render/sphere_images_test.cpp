// SPDX-License-Identifier: Apache-2.0
#include "render/sphere_images.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace orrery::render {
namespace {

using math::Vec3d;

/// Looks along -z; a pixel is 0.1 units at the focus plane, 10 units away.
kernel::Camera image_camera() {
  kernel::Camera c;
  c.forward = {0, 0, -10};
  c.right = {0.1, 0, 0};
  c.down = {0, -0.1, 0};
  c.half_width = 20;
  c.half_height = 15;
  return c;
}

TEST(RenderSphereImages, DistantSpheresAreWhereTheyAreProjected) {
  kernel::Camera camera = image_camera();
  const auto image = sphere_image(camera, {2, 1, -20, 0.4});
  ASSERT_TRUE(image);
  EXPECT_NEAR((image->x0 + image->x1) / 2, 30, 1e-9);
  EXPECT_NEAR((image->y0 + image->y1) / 2, 10, 1e-9);
  EXPECT_NEAR(image->x1 - image->x0, 4, 1e-9);
  EXPECT_NEAR(image->area, 4 * std::numbers::pi, 1e-9);
  camera.lens_u = {0.3, 0, 0};
  const auto blurred = sphere_image(camera, {2, 1, -20, 0.4});
  EXPECT_NEAR(blurred->x1 - blurred->x0, 4 + 2 * 0.3 / 0.2, 1e-9);
  EXPECT_EQ(blurred->area, image->area);
  EXPECT_FALSE(sphere_image(camera, {0, 0, 5, 1})) << "behind the camera";
  EXPECT_FALSE(sphere_image(camera, {0, 0, -1, 2})) << "around the camera";
}

TEST(RenderSphereImages, CylindersHaveTheAreaBetweenTheirEnds) {
  const kernel::Camera camera = image_camera();
  const auto a = sphere_image(camera, {-1, 0, -10, 0.1}), b = sphere_image(camera, {1, 0, -10, 0.1});
  EXPECT_NEAR(distance(*a, *b), 20, 1e-9);
  const auto all = between(a, b, 1);
  EXPECT_NEAR(all->area, 20 * 2 + std::numbers::pi, 1e-9);
  EXPECT_NEAR(all->x1 - all->x0, 22, 1e-9);
  EXPECT_FALSE(between(a, std::nullopt, 1));
}

}  // namespace
}  // namespace orrery::render
