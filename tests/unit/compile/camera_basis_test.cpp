// SPDX-License-Identifier: Apache-2.0
#include "compile/camera_basis.h"

#include <gtest/gtest.h>

#include <cmath>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "scene/scene.h"

namespace orrery::compile {
namespace {

TEST(CompileCameraBasis, ViewVectorsFitIntoSinglePrecision) {
  const auto length_of = [](const kernel::Camera& c) { return length(c.forward); };
  for (const double distance : {1e-25, 1e18}) {
    scene::Scene scene;
    scene.camera.look_from = {0, 0, distance};
    scene.camera.look_at = {0, 0, 0};
    const double length = length_of(compile(scene).camera);
    EXPECT_GE(length, 1) << distance;
    EXPECT_LE(length, 2) << distance;
    EXPECT_EQ(std::ldexp(length, std::ilogb(distance)), distance) << "scaled by a power of two";
    scene.camera.defocus_angle = 1;
    EXPECT_EQ(length_of(compile(scene).camera), distance) << "a lens has a size";
  }
  scene::Scene usual;
  usual.camera.look_from = {0, 0, 999};  // looks at z = -1
  EXPECT_EQ(length_of(compile(usual).camera), 1000);
}

TEST(CompileCameraBasis, SpansTheImageOnTheFocusPlane) {
  scene::Camera camera;
  camera.look_from = {0, 0, 10};
  camera.look_at = {0, 0, 0};
  camera.vfov = 90;
  camera.defocus_angle = 90;
  camera.focus_distance = 2;
  const kernel::Camera c = compile_camera(camera, {200, 100}, 1);
  EXPECT_DOUBLE_EQ(c.forward.z, -2);
  EXPECT_DOUBLE_EQ(c.right.x * 100, 4);  // 2 tan(45 degrees) at distance 2, divided by the height in pixels
  EXPECT_DOUBLE_EQ(c.down.y * 100, -4);
  EXPECT_DOUBLE_EQ(c.lens_u.x, 2);
  EXPECT_EQ(c.half_width, 100);
}

TEST(CompileCameraBasis, AnOrthographicImageHasItsWidthAtAnyDistance) {
  scene::Camera camera;
  camera.projection = scene::Projection::kOrthographic;
  camera.width = 3;
  for (const double distance : {1e-3, 7.0, 1e9}) {
    camera.look_from = {0, 0, distance};
    camera.look_at = {0, 0, 0};
    const kernel::Camera c = compile_camera(camera, {200, 100, 2}, 1);
    EXPECT_TRUE(c.is_orthographic);
    EXPECT_DOUBLE_EQ(c.right.x * 200, 3);
    EXPECT_DOUBLE_EQ(c.down.y * 100, -0.75) << "pixels are twice as wide as high";
  }
}

TEST(CompileCameraBasis, FocusesOnLookAtByDefault) {
  scene::Camera camera;
  camera.look_from = {3, 0, 4};
  camera.look_at = {0, 0, 0};
  EXPECT_EQ(focus_distance(camera), 5);
}

}  // namespace
}  // namespace orrery::compile
