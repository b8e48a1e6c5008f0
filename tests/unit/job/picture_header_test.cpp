// SPDX-License-Identifier: Apache-2.0
#include "job/picture_header.h"

#include <gtest/gtest.h>

#include <regex>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "format/read_result.h"
#include "image/header.h"
#include "job/camera_matrices.h"
#include "job/job_report.h"
#include "job/version.h"

namespace orrery::job {
namespace {

image::Header header_of(const scene::Scene& scene, bool reproducible = true,
                        const std::vector<format::Setting>& settings = {}) {
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
  const std::vector<format::Setting> settings = {{"camera.vfov", "20", "scene.toml:3"},
                                                 {"render.precision", "\"fast\"", "--set"},
                                                 {"render.accelerator", "\"list\"", "default"}};
  EXPECT_EQ(text_of(header_of({}, false, settings), "orrery/settings"),
            "camera.vfov = 20\nrender.precision = \"fast\"\nrender.accelerator = \"list\"\n");
  EXPECT_EQ(text_of(header_of({}, false, settings), "orrery/precision"), "fast");
  EXPECT_EQ(text_of(header_of({}, true, settings), "orrery/settings"),
            "camera.vfov = 20\nrender.precision = \"fast\"\n");
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

}  // namespace
}  // namespace orrery::job
