// SPDX-License-Identifier: Apache-2.0
#include "job/disk_space.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "film/layers.h"
#include "generate/generate.h"
#include "generate/generate_files.h"
#include "job/job.h"
#include "job/job_report.h"
#include "support/temp_dir.h"

namespace orrery::job {
namespace {

class JobDiskSpace : public testing::Test {
 protected:
  JobDiskSpace() {
    generate::generate_final({}, folder_ / "final.toml");
    job_.scene.file = folder_ / "final.toml";
    job_.scene.overrides = {"image.width=200", "image.height=112", "render.samples=4"};
  }

  /// Ratio of the estimated to the actual size of a file.
  double ratio(const std::string& name, const film::LayerRequest& layers = {}) {
    job_.outputs.images = {folder_ / name};
    run_job(job_);
    const auto needed = estimate_disk_space(job_.outputs, is_shard(job_), image_size(200, 112, layers));
    EXPECT_EQ(needed.size(), 1u);
    return needed.begin()->second / static_cast<double>(std::filesystem::file_size(folder_ / name));
  }

  support::TempDir folder_;
  Job job_;
};

TEST_F(JobDiskSpace, TheEstimateIsNearTheFiles) {
  for (const char* name : {"a.exr", "a.hdr", "a.png", "a.tif", "a.jpg", "a.ppm"}) {
    const double r = ratio(name);
    EXPECT_GT(r, 0.8) << name;  // the header is a large part of so small a file
    EXPECT_LT(r, 1.6) << name;
  }
  for (const char* compression : {"none", "rle", "zip", "piz", "dwaa"}) {
    job_.outputs.exr.compression = compression;
    EXPECT_GT(ratio("b.exr"), 0.8) << compression;
    EXPECT_LT(ratio("b.exr"), 1.6) << compression;
  }
  job_.outputs.exr.compression = "zips";
  job_.sampling.sample_end = 2;
  EXPECT_GT(ratio("shard.exr"), 0.8);
  EXPECT_LT(ratio("shard.exr"), 1.6);
}

TEST_F(JobDiskSpace, LayersIncreaseTheEstimate) {
  job_.scene.overrides.add("output.layers=[\"Z\", \"N\", \"variance\"]");
  film::LayerRequest layers;
  layers.z = layers.normal = layers.variance = true;
  EXPECT_GT(ratio("a.exr", layers), 0.8);
  EXPECT_LT(ratio("b.exr", layers), 2);  // distances compress better than noise
}

/// The light of one group, which is the whole image.
TEST_F(JobDiskSpace, LightGroupsIncreaseTheEstimate) {
  job_.scene.overrides.add("output.layers=[\"light_groups\"]");
  film::LayerRequest layers;
  layers.light_groups = true;
  layers.groups = {{"default", false, true}};
  EXPECT_EQ(image_size(200, 112, layers).half_planes, 24u);
  EXPECT_GT(ratio("a.exr", layers), 0.8);
  EXPECT_LT(ratio("a.exr", layers), 3);  // in most pixels most lobes are black
  job_.sampling.sample_end = 2;
  EXPECT_GT(ratio("shard.exr", layers), 0.8);
  EXPECT_LT(ratio("shard.exr", layers), 5);  // there are no other layers
}

TEST_F(JobDiskSpace, ALimitReplacesTheFreeSpace) {
  Outputs outputs;
  outputs.images = {folder_ / "a.exr"};
  const ImageSize size{65536, 65536, 0};  // 16 GiB
  try {
    require_disk_space(outputs, false, size, std::uint64_t{1} << 30);
    ADD_FAILURE() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kCannotCreate);
    EXPECT_NE(std::string(error.what()).find("--disk-limit allows"), std::string::npos) << error.what();
  }
  EXPECT_NO_THROW(require_disk_space(outputs, false, size, std::uint64_t{1} << 50)) << "whoever gives a limit insists";
}

}  // namespace
}  // namespace orrery::job
