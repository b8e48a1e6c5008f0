// SPDX-License-Identifier: Apache-2.0
#include "job/picture_header.h"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "compile/camera_basis.h"
#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "image/header.h"
#include "job/job.h"
#include "job/version.h"
#include "load/read_scene.h"
#include "scene/scene.h"
#include "support/mentions.h"

namespace orrery::job {
namespace {

image::Header header_of(const scene::Scene& scene, bool reproducible = true,
                        const std::vector<load::Setting>& settings = {}) {
  JobReport report;
  report.scene_hash = "0123456789abcdef";
  report.phases.render_s = 1.5;
  report.render.accelerator = "list";
  report.render.isa = "avx2";
  return picture_header({scene, {}, settings}, compile::compile(scene), report, reproducible);
}

/// The text of an attribute; "none" if it is missing.
std::string text_of(const image::Header& header, const std::string& name) {
  for (const image::Attribute& attribute : header.attributes)
    if (attribute.name == name) {
      if (const auto* text = std::get_if<std::string>(&attribute.value)) return *text;
      if (const auto* number = std::get_if<int>(&attribute.value)) return std::to_string(*number);
      return std::to_string(std::get<float>(attribute.value));
    }
  return "none";
}

TEST(JobPictureHeader, IdentifiesTheRender) {
  scene::Scene scene;
  scene.render.seed = 4'000'000'000u;
  scene.render.samples = 7;
  const image::Header header = header_of(scene);
  EXPECT_EQ(header.software, "orrery " + program_version());
  EXPECT_EQ(text_of(header, "orrery/version"), program_version());
  EXPECT_EQ(text_of(header, "orrery/sceneHash"), "0123456789abcdef");
  EXPECT_EQ(text_of(header, "orrery/seed"), "4000000000");
  EXPECT_EQ(text_of(header, "orrery/samples"), "7");
  EXPECT_EQ(text_of(header, "orrery/maxDepth"), "50");
  EXPECT_EQ(header.world_to_camera, camera_matrices(scene.camera, scene.image).world_to_camera);
  EXPECT_EQ(header.world_to_ndc, camera_matrices(scene.camera, scene.image).world_to_ndc);
}

TEST(JobPictureHeader, HoldsTheSettings) {
  const std::vector<load::Setting> settings = {{"camera.vfov", "20", "scene.toml:3"},
                                               {"render.precision", "\"fast\"", "--set"},
                                               {"render.accelerator", "\"list\"", "default"}};
  EXPECT_EQ(text_of(header_of({}, false, settings), "orrery/settings"),
            "camera.vfov = 20\nrender.precision = \"fast\"\nrender.accelerator = \"list\"\n");
  EXPECT_EQ(text_of(header_of({}, false, settings), "orrery/precision"), "fast");
  EXPECT_TRUE(test::mentions(text_of(header_of({}, true, settings), "orrery/settings"),
                             {"camera.vfov = 20", "render.precision = \"fast\""}));
}

TEST(JobPictureHeader, HasTheInteropIdsOfKnownColourSpaces) {
  const image::Header rec709 = header_of({});
  EXPECT_EQ(rec709.color_interop_id, "lin_rec709_scene");
  ASSERT_TRUE(rec709.chromaticities);
  EXPECT_EQ(rec709.chromaticities->at(0), 0.64f);
  EXPECT_EQ(rec709.chromaticities->at(6), 0.3127f);
  scene::Scene scene;
  scene.color.space = "acescg";
  EXPECT_EQ(header_of(scene).color_interop_id, "lin_ap1_scene");
  EXPECT_EQ(header_of(scene).chromaticities->at(0), 0.713f);
}

TEST(JobPictureHeader, OmitsUnknownColourSpaces) {
  scene::Scene scene;
  scene.color.space = "my_camera_log";
  EXPECT_EQ(header_of(scene).color_interop_id, "");
  EXPECT_FALSE(header_of(scene).chromaticities);
}

TEST(JobPictureHeader, ReproducibleOmitsWhatVaries) {
  const image::Header header = header_of({}, true);
  EXPECT_EQ(header.capture_date, "");
  for (const char* name : {"orrery/renderSeconds", "orrery/accelerator", "orrery/isa"})
    EXPECT_EQ(text_of(header, name), "none");
}

TEST(JobPictureHeader, HasTimeAndMachineByDefault) {
  const image::Header header = header_of({}, false);
  EXPECT_TRUE(std::regex_match(header.capture_date, std::regex(R"(\d{4}:\d\d:\d\d \d\d:\d\d:\d\d)")))
      << header.capture_date;
  EXPECT_EQ(text_of(header, "orrery/renderSeconds"), "1.500000");
  EXPECT_EQ(text_of(header, "orrery/accelerator"), "list");
  EXPECT_EQ(text_of(header, "orrery/isa"), "avx2");
}

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
      const math::Vec3d at = rays.origin + 1.7 * (rays.forward + x * rays.right + y * rays.down);
      const Point4 p = times(at, m.world_to_ndc);
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
      const math::Vec3d at = rays.origin + 0.7 * rays.forward + x * rays.right + y * rays.down;
      const Point4 p = times(at, m.world_to_ndc);
      EXPECT_EQ(p.w, 1);
      EXPECT_NEAR(p.x * image.width, px, 1e-3);
      EXPECT_NEAR(p.y * image.height, py, 1e-3);
      EXPECT_NEAR(p.z, 0.7 * math::length(camera.look_from), 1e-4);
    }
  }
}

}  // namespace
}  // namespace orrery::job
