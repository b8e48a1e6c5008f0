// SPDX-License-Identifier: Apache-2.0
#include "job/shards.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "support/exr_file.h"
#include "unit/job/job_fixture.h"

namespace orrery::job {
namespace {

class JobShards : public JobTest {
 protected:
  JobShards() {
    job_.outputs.statistics.clear();
    job_.outputs.reproducible = true;
  }

  /// Renders shard `index` of `count`.
  std::filesystem::path shard(int index, int count) {
    Job job = job_;
    job.settings.shard = {index, count};
    job.as_shard = true;
    const std::filesystem::path file = folder_ / (std::to_string(index) + "of" + std::to_string(count) + ".exr");
    job.outputs.images = {file};
    run_job(job);
    return file;
  }
  /// Merges shards to an image.
  ///
  /// Result     the error; empty if there is none
  std::string merge(const std::vector<std::filesystem::path>& files, bool allow_missing = false) {
    Job job = job_;
    job.outputs.images = {folder_ / "merged.exr"};
    try {
      job.merge = {read_shards(files), allow_missing};
      take_scene(job.merge.shards.front(), job);
      run_job(job);
    } catch (const base::Error& error) {
      EXPECT_EQ(error.kind(), base::ErrorKind::kBadData);
      return error.what() + (error.diagnostics().empty() ? std::string() : " " + error.diagnostics().front().text);
    }
    return {};
  }
};

TEST_F(JobShards, MergeToTheBytesOfTheImage) {
  const std::vector<std::filesystem::path> files = {shard(1, 2), shard(0, 2)};
  EXPECT_EQ(merge(files), "");
  job_.outputs.images = {folder_ / "whole.exr"};
  run_job(job_);
  EXPECT_TRUE(support::file_bytes(folder_ / "merged.exr") == support::file_bytes(folder_ / "whole.exr"));
}

TEST_F(JobShards, AMissingShardIsAnErrorUnlessAllowed) {
  const std::filesystem::path first = shard(0, 2);
  EXPECT_NE(merge({first}).find("are in no shard"), std::string::npos);
  EXPECT_EQ(merge({first}, true), "");
}

TEST_F(JobShards, SamplesThatTwoShardsHaveAreAnError) {
  const std::filesystem::path half = shard(0, 2), all = shard(0, 1);
  EXPECT_NE(merge({half, all}), "");
}

TEST_F(JobShards, AnotherSceneIsAnError) {
  const std::filesystem::path first = shard(0, 2);
  job_.scene.overrides = {"material.grey.albedo=[0.6, 0.5, 0.5]"};
  EXPECT_NE(merge({first, shard(1, 2)}), "");
}

}  // namespace
}  // namespace orrery::job
