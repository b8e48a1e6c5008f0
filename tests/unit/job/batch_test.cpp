// SPDX-License-Identifier: Apache-2.0
#include "job/batch.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/error.h"
#include "support/temp_dir.h"
#include "unit/job/job_fixture.h"

namespace orrery::job {
namespace {

class JobBatch : public testing::Test {
 protected:
  JobBatch() {
    for (const char* scene : {"a.toml", "b.toml"}) support::write_bytes(folder_ / scene, kSmallScene);
  }

  Batch batch(const std::vector<std::string>& scenes, const std::vector<int>& frames, const std::string& output) const {
    Batch out;
    for (const std::string& scene : scenes) out.scenes.push_back(folder_ / scene);
    out.frames = frames;
    out.job.outputs.images = {folder_ / output};
    return out;
  }
  static std::string refusal(const Batch& batch) {
    try {
      jobs_of(batch);
    } catch (const base::Error& error) {
      EXPECT_EQ(error.kind(), base::ErrorKind::kUsage);
      return error.what();
    }
    return {};
  }

  support::TempDir folder_;
};

TEST_F(JobBatch, HasAJobForEachFrameOfEachScene) {
  std::vector<std::string> names;
  for (const Job& job : jobs_of(batch({"a.toml", "b.toml"}, {1, 3}, "{scene}.##.png")))
    names.push_back(job.outputs.images.front().path.filename().string() + " " + std::to_string(job.scene.frame));
  EXPECT_EQ(names, (std::vector<std::string>{"a.01.png 1", "a.03.png 3", "b.01.png 1", "b.03.png 3"}));
}

TEST_F(JobBatch, FramesShareAPreparedScene) {
  EXPECT_EQ(jobs_of(batch({"a.toml"}, {}, "a.png")).front().prepared, nullptr);
  const std::vector<Job> jobs = jobs_of(batch({"a.toml"}, {1, 2}, "a.##.png"));
  EXPECT_NE(jobs[0].prepared, nullptr);
  EXPECT_EQ(jobs[0].prepared, jobs[1].prepared);
}

TEST_F(JobBatch, NamesMustTellFramesAndScenesApart) {
  EXPECT_NE(refusal(batch({"a.toml"}, {1, 2}, "a.png")).find("frame"), std::string::npos);
  EXPECT_NE(refusal(batch({"a.toml"}, {}, "a.##.png")).find("--frames"), std::string::npos);
  EXPECT_NE(refusal(batch({"a.toml", "b.toml"}, {}, "a.png")).find("{scene}"), std::string::npos);
  EXPECT_NE(refusal(batch({"a.toml", "a.toml"}, {}, "{scene}.png")).find("given twice"), std::string::npos);
  EXPECT_EQ(refusal(batch({"a.toml", "b.toml"}, {1, 2}, "{scene}.##.png")), "");
}

TEST_F(JobBatch, NoFileIsReadAndWritten) {
  Batch with_statistics = batch({"a.toml"}, {}, "a.png");
  with_statistics.job.outputs.statistics = folder_ / "a.toml";
  EXPECT_NE(refusal(with_statistics).find("would overwrite"), std::string::npos);
  Batch with_other = batch({"a.toml"}, {}, "a.png");
  with_other.others = {{folder_ / "a.png", "--preview"}};
  EXPECT_NE(refusal(with_other).find("--preview"), std::string::npos);
}

}  // namespace
}  // namespace orrery::job
