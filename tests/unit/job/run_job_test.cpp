// SPDX-License-Identifier: Apache-2.0
#include "job/run_job.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <thread>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "image/format.h"
#include "image/header.h"
#include "image/read.h"
#include "image/sums_file.h"
#include "job/shards.h"
#include "render/settings.h"
#include "support/exr_file.h"
#include "support/picture_of.h"
#include "unit/job/job_fixture.h"

namespace orrery::job {
namespace {

class JobRun : public JobTest {};

TEST_F(JobRun, WritesEveryOutputAndTheStatistics) {
  job_.outputs.images = {folder_ / "a.exr", folder_ / "a.png", folder_ / "a.hdr"};
  const JobReport report = run_job(job_);
  for (const ImageFile& output : job_.outputs.images) EXPECT_EQ(image::read(output.path).width, 24) << output.path;
  EXPECT_EQ(folder_.count(), 5u) << "the scene, three images, statistics";
  EXPECT_EQ(report.render.paths, 24u * 16 * 2);
  EXPECT_EQ(report.spheres, 1u);
  EXPECT_EQ(report.display.config, "built-in");
  EXPECT_TRUE(rendered_);
  EXPECT_EQ(statistics()["exit_reason"], "completed");
  EXPECT_EQ(statistics()["exit_status"], 0);
  EXPECT_EQ(statistics().count("error"), 0u);
}

TEST_F(JobRun, WritesNoImageIfStoppedBeforeRendering) {
  const std::atomic<bool> cancel{true};
  job_.hooks.cancel = &cancel;
  job_.outputs.images = {folder_ / "a.exr"};
  EXPECT_EQ(error().kind(), base::ErrorKind::kStopped);
  EXPECT_FALSE(rendered_);
  EXPECT_EQ(folder_.count(), 2u) << "the scene and the statistics";
  EXPECT_EQ(statistics()["exit_reason"], "stopped");
  EXPECT_EQ(statistics()["exit_status"], 75);
}

/// A sky with the sun and an image background, each with a lamp and light groups: the checkpoint of a stopped render
/// and two shards lead to the bytes of an uninterrupted render.
TEST_F(JobRun, ResumedRendersAndShardsUnderASkyOrAnImageHaveTheSameBytes) {
  support::ExrFile map = support::ExrFile::constant(32, 16, {0.2F, 0.3F, 0.4F});
  map.rgb[3 * (4 * 32 + 10)] = 500;
  support::write_bytes(folder_ / "map.exr", map.bytes());
  const std::string lamp =
      "material.lamp = { type = \"emitter\", radiance = [4, 3, 2], light_group = \"lamp\" }\n"
      "material.grey = { type = \"lambertian\", albedo = [0.5, 0.5, 0.5] }\n"
      "sphere = [{ center = [0, -100.5, -1], radius = 100, material = \"grey\" }, "
      "{ center = [0, 0, -1], radius = 0.5, material = \"grey\" }, "
      "{ center = [1, 1, -1], radius = 0.25, material = \"lamp\" }]\n";
  for (const char* background :
       {"{ type = \"sky\", light_group = \"sky\" }", "{ type = \"image\", file = \"map.exr\" }"}) {
    support::write_bytes(folder_ / "scene.toml", "background = " + std::string(background) + "\n" + lamp);
    const auto file = [&](const char* name) {
      job_.outputs.images = {folder_ / name};
      return folder_ / name;
    };
    job_.scene.overrides = {"image.width=96", "image.height=64", "render.samples=64",
                            "output.layers=[\"light_groups\"]"};
    job_.outputs.reproducible = true;
    job_.checkpoint.resume = false;
    const auto whole = file("whole.exr");
    run_job(job_);
    const std::string expected = support::file_bytes(whole);

    const auto resumed = file("resumed.exr");
    stop_while_rendering();
    run_job(job_);
    EXPECT_EQ(statistics()["resumed"], true);
    EXPECT_TRUE(support::file_bytes(resumed) == expected) << background;

    Job merge = job_;
    std::vector<std::filesystem::path> shards;
    for (int shard = 0; shard < 2; ++shard) {
      Job part = job_;
      part.checkpoint.resume = false;
      part.settings.shard = {shard, 2};
      part.outputs.images = {shards.emplace_back(folder_ / ("shard" + std::to_string(shard) + ".exr"))};
      run_job(part);
    }
    merge.merge.shards = read_shards(shards);
    merge.outputs.images = {folder_ / "merged.exr"};
    take_scene(merge.merge.shards.front(), merge);
    run_job(merge);
    const film::Picture a = image::read(whole), b = image::read(folder_ / "merged.exr");
    ASSERT_EQ(a.planes.size(), b.planes.size());
    EXPECT_NE(a.find("lamp_diffuse_direct.R"), nullptr);
    for (std::size_t i = 0; i < a.planes.size(); ++i)
      EXPECT_TRUE(a.planes[i].values == b.planes[i].values) << background << ' ' << a.planes[i].name;
  }
}

/// A checkpoint whose header fits the render, but whose sums do not.
TEST_F(JobRun, RejectsACheckpointWithOtherSumsThanItsHeaderSays) {
  const std::filesystem::path checkpoint = folder_ / "a.checkpoint.exr";
  job_.outputs.images = {folder_ / "a.exr"};
  job_.scene.overrides = {"image.width=200", "image.height=100", "render.samples=300", "output.layers=[\"Z\"]"};
  job_.denoise = true;
  stop_while_rendering();
  const image::SumsFile right = image::read_sums(checkpoint, 200, 100);
  const std::vector<std::function<void(film::Sums&)>> changes = {
      [](film::Sums& sums) { sums.layers = {}; }, [](film::Sums& sums) { sums.guides = {}; },
      [](film::Sums& sums) { sums.largest.resize(sums.pixel_count()); },
      [](film::Sums& sums) { sums.layers.hit[5] = 2; }};
  film::Picture preview = test::picture_of(right.sums);
  preview.frame_width = 200;
  preview.frame_height = 100;
  for (const auto& change : changes) {
    image::SumsFile wrong = right;
    change(wrong.sums);
    image::write_sums(checkpoint, preview, {}, wrong.provenance, wrong.sums);
    const base::Error refused = error();
    EXPECT_EQ(refused.kind(), base::ErrorKind::kBadData);
    EXPECT_NE(std::string(refused.what()).find("do not match its header"), std::string::npos) << refused.what();
  }
  image::write_sums(checkpoint, preview, {}, right.provenance, right.sums);
  run_job(job_);
  EXPECT_EQ(statistics()["resumed"], true);
}

TEST_F(JobRun, ReportsAFailedWriteInTheStatistics) {
  job_.outputs.images = {folder_ / "a.exr"};
  job_.scene.overrides = {"image.width=512", "image.height=512", "render.samples=1"};
  job_.outputs.exr.compression = "none";
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small{100'000, before.rlim_max};  // the image has 2 MB, the statistics less than 2 kB
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const base::Error failed = error();
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  EXPECT_EQ(failed.kind(), base::ErrorKind::kIo);
  EXPECT_EQ(folder_.count(), 2u);
  EXPECT_EQ(statistics()["exit_reason"], "failed");
  EXPECT_EQ(statistics()["exit_status"], 74);
  EXPECT_EQ(statistics()["error"], failed.what());
}

TEST_F(JobRun, WarningsReachTheCaller) {
  const std::string twice = "[[sphere]]\ncenter = [0, 0, -1]\nradius = 0.5\nmaterial = \"grey\"\n";
  support::write_bytes(job_.scene.file, kSmallScene + twice);
  std::vector<base::Diagnostic> warnings;
  job_.hooks.on_warning = [&](const base::Diagnostic& warning) { warnings.push_back(warning); };
  job_.outputs.images = {folder_ / "a.exr"};
  run_job(job_);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].severity, base::Severity::kWarning);
}

}  // namespace
}  // namespace orrery::job
