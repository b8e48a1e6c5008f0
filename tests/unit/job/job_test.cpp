// SPDX-License-Identifier: Apache-2.0
#include "job/job.h"

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
#include "image/partial_file.h"
#include "image/read.h"
#include "job/shards.h"
#include "render/settings.h"
#include "support/exr_file.h"
#include "support/temp_dir.h"

namespace orrery::job {
namespace {

constexpr const char* kScene = R"(
[image]
width = 24
height = 16
[render]
samples = 2
[material.grey]
type = "lambertian"
albedo = [0.5, 0.5, 0.5]
[[sphere]]
center = [0, 0, -1]
radius = 0.5
material = "grey"
)";

class JobRun : public testing::Test {
 protected:
  JobRun() {
    ::unsetenv("OCIO");
    support::write_bytes(folder_ / "scene.toml", kScene);
    job_.scene.file = folder_ / "scene.toml";
    job_.outputs.statistics = folder_ / "stats.json";
    job_.hooks.on_progress = [this](const render::Progress&) { rendered_ = true; };
  }

  /// The error of the job.
  base::Error error() {
    try {
      run_job(job_);
    } catch (const base::Error& error) {
      return error;
    }
    ADD_FAILURE() << "the job succeeded";
    return {base::ErrorKind::kInternal, ""};
  }

  /// Stops the job while it renders, and lets it resume from the checkpoint.
  void stop_while_rendering() {
    std::atomic<bool> cancel{false};
    job_.hooks.cancel = &cancel;
    job_.hooks.on_progress = [&](const render::Progress&) { cancel = true; };
    EXPECT_EQ(error().kind(), base::ErrorKind::kStopped);
    job_.hooks.cancel = nullptr;
    job_.hooks.on_progress = {};
    job_.checkpoint.resume = true;
  }

  nlohmann::json statistics() { return nlohmann::json::parse(support::file_bytes(job_.outputs.statistics)); }

  support::TempDir folder_;
  Job job_;
  bool rendered_ = false;
};

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

TEST_F(JobRun, LooksUpADisplayOnlyForDisplayFormats) {
  job_.outputs.images = {folder_ / "a.exr"};
  ::setenv("OCIO", (folder_ / "nowhere.ocio").c_str(), 1);
  const JobReport report = run_job(job_);
  ::unsetenv("OCIO");
  EXPECT_EQ(report.display.display, "");
  job_.outputs.display.config = folder_ / "nowhere.ocio";
  EXPECT_EQ(error().kind(), base::ErrorKind::kMissingInput) << "named explicitly";
}

TEST_F(JobRun, RejectsInvalidRequestsBeforeRendering) {
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
  job_.outputs.display.view = "none such";
  EXPECT_EQ(kind_of_error("a.png"), base::ErrorKind::kUsage);
  job_.outputs.display.view.clear();
  job_.scene.overrides = {"render.samples=0"};
  EXPECT_EQ(kind_of_error("a.png"), base::ErrorKind::kBadData);
  job_.scene.file = folder_ / "missing.toml";
  EXPECT_EQ(kind_of_error("a.png"), base::ErrorKind::kMissingInput);
  EXPECT_FALSE(rendered_);
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

TEST_F(JobRun, ResumesFromTheCheckpointOfAStoppedRenderToTheSameBytes) {
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
TEST_F(JobRun, MoreSamplesContinueAStoppedOrAFinishedRender) {
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
TEST_F(JobRun, MoreSamplesDoNotContinueARenderWhoseSumsDependOnTheirNumber) {
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
      part.sampling.shard = {shard, 2};
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

TEST_F(JobRun, RejectsACheckpointOfAnotherRender) {
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
  job_.sampling.noise = 0.0008;  // the nearest double is 0.00080000000000000004
  expect_refused("--noise 0, not 0.0008;");
  job_.sampling.shard = {0, 2};
  expect_refused("--shard 1/1, not 1/2");
  job_.scene.overrides.add("output.layers=[\"N\"]");
  expect_refused("layers none, not N");
  job_.denoise = true;
  expect_refused("layers none, not halves, as for --denoise;");
  support::write_bytes(folder_ / "a.checkpoint.exr", checkpoint.substr(0, checkpoint.size() / 2));
  EXPECT_EQ(error().kind(), base::ErrorKind::kBadData);
}

/// A checkpoint whose header fits the render, but whose sums do not.
TEST_F(JobRun, RejectsACheckpointWithOtherSumsThanItsHeaderSays) {
  const std::filesystem::path checkpoint = folder_ / "a.checkpoint.exr";
  job_.outputs.images = {folder_ / "a.exr"};
  job_.scene.overrides = {"image.width=200", "image.height=100", "render.samples=300", "output.layers=[\"Z\"]"};
  job_.denoise = true;
  stop_while_rendering();
  const image::PartialFile right = image::read_partial(checkpoint, 200, 100);
  const std::vector<std::function<void(film::Partial&)>> changes = {
      [](film::Partial& sums) { sums.layers.clear(); }, [](film::Partial& sums) { sums.halves.clear(); },
      [](film::Partial& sums) { sums.add_second_half(); }, [](film::Partial& sums) { sums.layers[5].sphere = 1; }};
  film::Picture preview = right.partial.film.picture();
  preview.frame_width = 200;
  preview.frame_height = 100;
  for (const auto& change : changes) {
    image::PartialFile wrong = right;
    change(wrong.partial);
    image::write_partial(checkpoint, preview, {}, wrong.provenance, wrong.partial);
    const base::Error refused = error();
    EXPECT_EQ(refused.kind(), base::ErrorKind::kBadData);
    EXPECT_NE(std::string(refused.what()).find("contains sums that do not match its header; delete it"),
              std::string::npos)
        << refused.what();
  }
  image::write_partial(checkpoint, preview, {}, right.provenance, right.partial);
  run_job(job_);
  EXPECT_EQ(statistics()["resumed"], true);
}

/// While spheres of two files are compiled, they are in memory twice. With the list, the render needs less than that.
TEST_F(JobRun, SpheresThatDoNotFitTwiceAreNotCompiled) {
  std::string rows = "x,y,z\n";
  for (int i = 0; i < 1000; ++i) rows += std::to_string(i) + ",0.5,0.25\n";
  support::write_bytes(folder_ / "a.csv", rows);
  const std::string points = "[[points]]\nfile = \"a.csv\"\nradius = 0.01\nmaterial = \"grey\"\n";
  support::write_bytes(folder_ / "scene.toml",
                       std::string(kScene) + points + points + "transform = { translate = [0, 1, 0] }\n");
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

TEST_F(JobRun, WritesCheckpointsAtTheInterval) {
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
  support::write_bytes(job_.scene.file, kScene + twice);
  std::vector<base::Diagnostic> warnings;
  job_.hooks.on_warning = [&](const base::Diagnostic& warning) { warnings.push_back(warning); };
  job_.outputs.images = {folder_ / "a.exr"};
  run_job(job_);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].severity, base::Severity::kWarning);
}

TEST_F(JobRun, OptionsOverrideTheDisplayOfTheScene) {
  support::write_bytes(folder_ / "scene.toml",
                       std::string(kScene) + "[color]\ndisplay = \"Gamma 2.0 Rec.709\"\nexposure = -2\n");
  job_.outputs.images = {folder_ / "a.png"};
  EXPECT_EQ(run_job(job_).display.display, "Gamma 2.0 Rec.709");
  const float dark = image::read(folder_ / "a.png").planes[0].values[0];
  job_.outputs.display.exposure = 0;
  run_job(job_);
  EXPECT_NEAR(image::read(folder_ / "a.png").planes[0].values[0], 2 * dark, 0.01);
  job_.outputs.display.display = "sRGB";
  EXPECT_EQ(run_job(job_).display.display, "sRGB");
}

TEST_F(JobRun, AConfigPathIsRelativeToTheScene) {
  support::write_bytes(folder_ / "scene.toml", std::string(kScene) + "[color]\nconfig = \"none.ocio\"\n");
  job_.outputs.images = {folder_ / "a.png"};
  const base::Error missing = error();
  EXPECT_EQ(missing.kind(), base::ErrorKind::kMissingInput);
  ASSERT_EQ(missing.diagnostics().size(), 1u);
  EXPECT_NE(missing.diagnostics()[0].text.find((folder_ / "none.ocio").string()), std::string::npos);
  EXPECT_FALSE(rendered_);
}

TEST_F(JobRun, LayersNeedAnExrOutput) {
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

TEST_F(JobRun, RejectsLossyCompressionOfDataBeforeRendering) {
  job_.scene.overrides = {"output.layers=[\"CryptoObject\"]"};
  job_.outputs.images = {folder_ / "a.exr"};
  job_.outputs.exr.compression = "dwaa";
  EXPECT_EQ(error().kind(), base::ErrorKind::kUsage);
  EXPECT_FALSE(rendered_);
}

TEST_F(JobRun, AnHdrDisplayHasSixteenBits) {
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
