// SPDX-License-Identifier: Apache-2.0
#include "job/prepare_job.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "base/error.h"
#include "image/format.h"
#include "image/read.h"
#include "job/run_job.h"
#include "unit/job/job_fixture.h"

namespace orrery::job {
namespace {

class JobPrepareJob : public JobTest {};

TEST_F(JobPrepareJob, LooksUpADisplayOnlyForDisplayFormats) {
  job_.outputs.images = {folder_ / "a.exr"};
  ::setenv("OCIO", (folder_ / "nowhere.ocio").c_str(), 1);
  const JobReport report = run_job(job_);
  ::unsetenv("OCIO");
  EXPECT_EQ(report.display.display, "");
  job_.outputs.display.config = folder_ / "nowhere.ocio";
  EXPECT_EQ(error().kind(), base::ErrorKind::kMissingInput) << "named explicitly";
}

/// While spheres of two files are compiled, they are in memory twice. With the list, the render needs less than that.
TEST_F(JobPrepareJob, SpheresThatDoNotFitTwiceAreNotCompiled) {
  std::string rows = "x,y,z\n";
  for (int i = 0; i < 1000; ++i) rows += std::to_string(i) + ",0.5,0.25\n";
  support::write_bytes(folder_ / "a.csv", rows);
  const std::string points = "[[points]]\nfile = \"a.csv\"\nradius = 0.01\nmaterial = \"grey\"\n";
  support::write_bytes(folder_ / "scene.toml",
                       std::string(kSmallScene) + points + points + "transform = { translate = [0, 1, 0] }\n");
  for (const char* text : {"image.width=1", "image.height=1", "render.accelerator=\"list\""})
    job_.scene.overrides.add(text);
  job_.outputs.images = {folder_ / "a.exr"};
  // The 2,000 spheres take 12 bytes each, and need 24 while they are read.
  job_.resources.memory_limit = 49'000;
  EXPECT_NO_THROW(run_job(job_));
  job_.resources.memory_limit = 47'000;
  const base::Error refused = error();
  EXPECT_EQ(refused.kind(), base::ErrorKind::kNoMemory);
  EXPECT_NE(std::string(refused.what()).find("the spheres need about 46.9 KiB while they are compiled"),
            std::string::npos)
      << refused.what();
}

TEST_F(JobPrepareJob, OptionsOverrideTheDisplayOfTheScene) {
  support::write_bytes(folder_ / "scene.toml",
                       std::string(kSmallScene) + "[color]\ndisplay = \"Gamma 2.0 Rec.709\"\nexposure = -2\n");
  job_.outputs.images = {folder_ / "a.png"};
  EXPECT_EQ(run_job(job_).display.display, "Gamma 2.0 Rec.709");
  const float dark = image::read(folder_ / "a.png").planes[0].values[0];
  job_.outputs.display.exposure = 0;
  run_job(job_);
  EXPECT_NEAR(image::read(folder_ / "a.png").planes[0].values[0], 2 * dark, 0.01);
  job_.outputs.display.display = "sRGB";
  EXPECT_EQ(run_job(job_).display.display, "sRGB");
}

TEST_F(JobPrepareJob, AConfigPathIsRelativeToTheScene) {
  support::write_bytes(folder_ / "scene.toml", std::string(kSmallScene) + "[color]\nconfig = \"none.ocio\"\n");
  job_.outputs.images = {folder_ / "a.png"};
  const base::Error missing = error();
  EXPECT_EQ(missing.kind(), base::ErrorKind::kMissingInput);
  ASSERT_EQ(missing.diagnostics().size(), 1u);
  EXPECT_NE(missing.diagnostics()[0].text.find((folder_ / "none.ocio").string()), std::string::npos);
  EXPECT_FALSE(rendered_);
}

TEST_F(JobPrepareJob, AnHdrDisplayHasSixteenBits) {
  job_.outputs.display.display = "Rec.2100-PQ";
  job_.outputs.images = {folder_ / "a.png"};
  run_job(job_);
  bool between = false;  // two 8-bit levels
  for (const float v : image::read(folder_ / "a.png").planes[0].values)
    between = between || std::abs(v * 255 - std::round(v * 255)) > 0.01f;
  EXPECT_TRUE(between);
  job_.outputs.images = {folder_ / "a.jpg"};
  EXPECT_EQ(error().kind(), base::ErrorKind::kUsage);
}

}  // namespace
}  // namespace orrery::job
