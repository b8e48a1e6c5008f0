// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "job/run_job.h"
#include "support/temp_dir.h"

namespace orrery::job {

inline constexpr const char* kSmallScene = R"(
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

/// A job that renders kSmallScene.
class JobTest : public testing::Test {
 protected:
  JobTest() {
    ::unsetenv("OCIO");
    support::write_bytes(folder_ / "scene.toml", kSmallScene);
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

}  // namespace orrery::job
