// SPDX-License-Identifier: Apache-2.0
#include "job/rendering.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "base/error.h"
#include "job/run_job.h"
#include "support/temp_dir.h"

namespace orrery::job {
namespace {

constexpr const char* kSceneWithLayers = R"(
[image]
width = 24
height = 16
[render]
samples = 2
[output]
layers = ["Z", "CryptoObject"]
[material.grey]
type = "lambertian"
albedo = [0.5, 0.5, 0.5]
[[sphere]]
center = [0, 0, -1]
radius = 0.5
material = "grey"
)";

class JobRendering : public testing::Test {
 protected:
  JobRendering() {
    ::unsetenv("OCIO");
    support::write_bytes(folder_ / "scene.toml", kSceneWithLayers);
    job_.scene.file = folder_ / "scene.toml";
  }

  Outputs outputs(const std::string& name) {
    Outputs out;
    out.images = {folder_ / name};
    out.reproducible = true;
    return out;
  }

  support::TempDir folder_;
  Job job_;
};

TEST_F(JobRendering, KeepsTheImageAndWritesNothing) {
  const Rendering rendering = render_in_memory(job_);
  EXPECT_EQ(rendering.picture.width, 24);
  EXPECT_NE(rendering.picture.find("Z"), nullptr) << "layers are kept without an EXR";
  EXPECT_EQ(folder_.count(), 1u) << "the scene";
}

TEST_F(JobRendering, FilesAreThoseOfAJob) {
  const Rendering rendering = render_in_memory(job_);
  for (const char* extension : {".exr", ".hdr"}) {
    Job direct = job_;
    direct.outputs = outputs(std::string("direct") + extension);
    run_job(direct);
    write_rendering(rendering, outputs(std::string("kept") + extension));
    EXPECT_EQ(support::file_bytes(folder_ / (std::string("direct") + extension)),
              support::file_bytes(folder_ / (std::string("kept") + extension)))
        << extension;
  }
}

TEST_F(JobRendering, ChecksFilesBeforeItWrites) {
  const Rendering rendering = render_in_memory(job_);
  Outputs twice = outputs("a.exr");
  twice.images.emplace_back(folder_ / "a.exr");
  EXPECT_THROW(write_rendering(rendering, twice), base::Error);
  Outputs bad = outputs("a.exr");
  bad.images.emplace_back(folder_ / "missing" / "a.exr");
  EXPECT_THROW(write_rendering(rendering, bad), base::Error);
  Outputs unknown = outputs("a.png");
  unknown.display.view = "no such view";
  EXPECT_THROW(write_rendering(rendering, unknown), base::Error);
  Outputs config = outputs("a.exr");
  config.display.config = folder_ / "a.exr";
  EXPECT_THROW(write_rendering(rendering, config), base::Error);
  EXPECT_EQ(folder_.count(), 1u);
}

TEST_F(JobRendering, AStoppedRenderWritesNoCheckpoint) {
  const std::atomic<bool> cancel{true};
  job_.hooks.cancel = &cancel;
  EXPECT_THROW(render_in_memory(job_), base::Error);
  EXPECT_EQ(folder_.count(), 1u);
}

}  // namespace
}  // namespace orrery::job
