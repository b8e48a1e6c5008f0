// SPDX-License-Identifier: Apache-2.0
#include "job/check_job.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "base/error.h"
#include "image/read.h"
#include "unit/job/job_fixture.h"

namespace orrery::job {
namespace {

class JobCheckJob : public JobTest {};

TEST_F(JobCheckJob, RejectsInvalidRequestsBeforeRendering) {
  const auto kind_of_error = [&](const char* output) {
    job_.outputs.images = {folder_ / output};
    return error().kind();
  };
  EXPECT_EQ(kind_of_error("none/a.png"), base::ErrorKind::kCannotCreate);
  job_.outputs.exr.compression = "zipps";
  EXPECT_EQ(kind_of_error("a.exr"), base::ErrorKind::kUsage);
  job_.outputs.exr.compression = "zip";
  ::setenv("ORRERY_ISA", "mmx", 1);
  EXPECT_EQ(kind_of_error("a.exr"), base::ErrorKind::kUsage);
  ::unsetenv("ORRERY_ISA");
  job_.scene.overrides = {"color.view=none such"};
  EXPECT_EQ(kind_of_error("a.png"), base::ErrorKind::kBadData);
  job_.scene.overrides = {"render.samples=0"};
  EXPECT_EQ(kind_of_error("a.png"), base::ErrorKind::kBadData);
  job_.scene.file = folder_ / "missing.toml";
  EXPECT_EQ(kind_of_error("a.png"), base::ErrorKind::kMissingInput);
  EXPECT_FALSE(rendered_);
}

TEST_F(JobCheckJob, LayersNeedAnExrOutput) {
  job_.scene.overrides = {"output.layers=[\"Z\", \"CryptoObject\"]"};
  job_.outputs.images = {folder_ / "a.exr", folder_ / "a.png"};
  job_.outputs.deep = folder_ / "deep.exr";
  run_job(job_);
  EXPECT_NE(image::read(folder_ / "a.exr").find("Z"), nullptr);
  EXPECT_NE(image::read(folder_ / "a.exr").find("CryptoObject02.A"), nullptr);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "deep.exr"));
  EXPECT_EQ(image::read(folder_ / "a.png").planes.size(), 3u);
  job_.outputs.deep = folder_ / "deep.png";
  EXPECT_EQ(error().kind(), base::ErrorKind::kUsage);
  job_.outputs.deep.clear();
  job_.outputs.images = {folder_ / "a.png"};  // explicit layers need an EXR
  EXPECT_EQ(error().kind(), base::ErrorKind::kUsage);
}

TEST_F(JobCheckJob, RejectsLossyCompressionOfDataBeforeRendering) {
  job_.scene.overrides = {"output.layers=[\"CryptoObject\"]"};
  job_.outputs.images = {folder_ / "a.exr"};
  job_.outputs.exr.compression = "dwaa";
  EXPECT_EQ(error().kind(), base::ErrorKind::kUsage);
  EXPECT_FALSE(rendered_);
}

}  // namespace
}  // namespace orrery::job
