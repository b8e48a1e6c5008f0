// SPDX-License-Identifier: Apache-2.0
#include "job/checkpoint.h"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <thread>

#include "base/error.h"
#include "image/read.h"
#include "image/sums_file.h"
#include "render/settings.h"
#include "support/exr_file.h"
#include "unit/job/job_fixture.h"

namespace orrery::job {
namespace {

class JobCheckpoint : public JobTest {};

TEST_F(JobCheckpoint, ResumesFromTheCheckpointOfAStoppedRenderToTheSameBytes) {
  job_.outputs.images = {folder_ / "a.exr"};
  job_.scene.overrides = {"image.width=200", "image.height=100", "render.samples=300", "output.layers=[\"Z\"]"};
  job_.outputs.reproducible = true;
  run_job(job_);
  const std::string uninterrupted = support::file_bytes(folder_ / "a.exr");
  std::filesystem::remove(folder_ / "a.exr");

  stop_while_rendering();
  EXPECT_EQ(folder_.count(), 3u);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "a.checkpoint.exr"));
  EXPECT_EQ(statistics()["exit_reason"], "stopped");
  EXPECT_EQ(statistics()["checkpoint"], (folder_ / "a.checkpoint.exr").string());
  const auto rays = statistics()["rays"].get<std::uint64_t>();
  EXPECT_GT(rays, 0u);

  run_job(job_);
  EXPECT_EQ(support::file_bytes(folder_ / "a.exr"), uninterrupted);
  EXPECT_EQ(statistics()["resumed"], true);
  EXPECT_GT(statistics()["rays"], rays);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.checkpoint.exr"));
}

/// The samples of a pixel do not depend on how many there are, so that a render with fewer samples is a beginning.
TEST_F(JobCheckpoint, MoreSamplesContinueAStoppedOrAFinishedRender) {
  job_.outputs.images = {folder_ / "a.exr"};
  const auto set_samples = [&](int samples) {
    job_.scene.overrides = {"image.width=200", "image.height=100", "output.layers=[\"Z\", \"diffuse\"]",
                            "render.samples=" + std::to_string(samples)};
  };
  job_.outputs.reproducible = true;
  set_samples(300);
  run_job(job_);
  const std::string uninterrupted = support::file_bytes(folder_ / "a.exr");

  set_samples(100);
  stop_while_rendering();
  set_samples(300);
  run_job(job_);
  EXPECT_EQ(statistics()["resumed"], true);
  EXPECT_TRUE(support::file_bytes(folder_ / "a.exr") == uninterrupted) << "of a stopped render";
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.checkpoint.exr"));

  set_samples(60);
  job_.checkpoint.keep = true;
  run_job(job_);
  EXPECT_EQ(statistics()["resumed"], false);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "a.checkpoint.exr"));
  set_samples(300);
  job_.checkpoint.keep = false;
  const JobReport report = run_job(job_);
  EXPECT_EQ(statistics()["resumed"], true);
  EXPECT_EQ(report.render.paths, 200u * 100 * 300) << "counts the samples of both runs";
  EXPECT_TRUE(support::file_bytes(folder_ / "a.exr") == uninterrupted) << "of a finished render";
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.checkpoint.exr"));
}

/// With blue noise and with halves for denoising, the samples depend on their number.
TEST_F(JobCheckpoint, MoreSamplesDoNotContinueARenderWhoseSumsDependOnTheirNumber) {
  job_.outputs.images = {folder_ / "a.exr"};
  for (const char* setting : {"render.sampler=\"blue-noise\"", "output.layers=[\"halves\"]"}) {
    job_.checkpoint.keep = true;
    job_.scene.overrides = {setting, "render.samples=10"};
    run_job(job_);
    job_.checkpoint.resume = true;
    job_.scene.overrides = {setting, "render.samples=30"};
    EXPECT_NE(std::string(error().what()).find("samples per pixel: 10, not 30"), std::string::npos) << setting;
    std::filesystem::remove(folder_ / "a.checkpoint.exr");
  }
}

TEST_F(JobCheckpoint, RejectsACheckpointOfAnotherRender) {
  job_.outputs.images = {folder_ / "a.exr"};
  job_.scene.overrides = {"image.width=200", "image.height=100", "render.samples=300"};
  stop_while_rendering();
  const std::string checkpoint = support::file_bytes(folder_ / "a.checkpoint.exr");
  const Job right = job_;
  const auto expect_refused = [&](const std::string& word) {
    const base::Error refused = error();
    EXPECT_EQ(refused.kind(), base::ErrorKind::kBadData) << word;
    EXPECT_NE(std::string(refused.what()).find(word), std::string::npos) << refused.what();
    EXPECT_EQ(support::file_bytes(folder_ / "a.checkpoint.exr"), checkpoint);
    job_ = right;
  };
  job_.scene.overrides.add("render.seed=2");
  expect_refused("render.seed = 1, not 2;");
  job_.scene.overrides.add("sphere[0].radius=0.4");
  expect_refused("other spheres, materials, lights or images");
  job_.scene.overrides.add("render.samples=200");
  expect_refused("a.checkpoint.exr has samples 0:300, not 0:200");
  job_.settings.noise = 0.0008;  // the nearest double is 0.00080000000000000004
  expect_refused("--noise 0, not 0.0008;");
  job_.settings.shard = {0, 2};
  expect_refused("--shard 1/1, not 1/2");
  job_.scene.overrides.add("output.layers=[\"N\"]");
  expect_refused("layers none, not N");
  job_.denoise = true;
  expect_refused("layers none, not halves, as for --denoise;");
  support::write_bytes(folder_ / "a.checkpoint.exr", checkpoint.substr(0, checkpoint.size() / 2));
  EXPECT_EQ(error().kind(), base::ErrorKind::kBadData);
}

TEST_F(JobCheckpoint, WritesCheckpointsAtTheInterval) {
  job_.outputs.images = {folder_ / "a.exr"};
  job_.scene.overrides = {"image.width=64", "image.height=64", "render.samples=64"};
  job_.checkpoint.interval_s = 0.01;
  job_.resources.threads = 1;
  bool seen = false;
  job_.hooks.on_progress = [&](const render::Progress&) {
    seen = seen || std::filesystem::exists(folder_ / "a.checkpoint.exr");
    // The single render thread waits until a checkpoint is due, at any speed.
    if (!seen) std::this_thread::sleep_for(std::chrono::milliseconds(11));
  };
  run_job(job_);
  EXPECT_TRUE(seen);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.checkpoint.exr"));
}

/// The samples of a frame do not depend on the next one, but its motion vectors do.
TEST_F(JobCheckpoint, AnImageWithMotionVectorsDependsOnTheNextFrame) {
  const auto write_scene = [&](const char* next) {
    support::write_bytes(folder_ / "scene.toml", std::string(kSmallScene) +
                                                     "[[key]]\ntarget = \"sphere[0].radius\"\nframes = [1, 2]\n"
                                                     "values = [0.5, " +
                                                     next + "]\n");
  };
  job_.outputs.images = {folder_ / "a.exr"};
  job_.skip_existing = true;
  for (const char* layers : {"output.layers=[\"Z\"]", "output.layers=[\"Vector\"]"}) {
    job_.scene.overrides = {layers};
    write_scene("0.6");
    EXPECT_FALSE(run_job(job_).was_skipped);
    EXPECT_TRUE(run_job(job_).was_skipped);
    write_scene("0.7");
    EXPECT_EQ(run_job(job_).was_skipped, std::string(layers).find("Vector") == std::string::npos) << layers;
  }
}

}  // namespace
}  // namespace orrery::job
