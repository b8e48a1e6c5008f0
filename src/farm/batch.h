// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/error.h"
#include "job/check_job.h"
#include "job/job.h"

namespace orrery::farm {

/// Frames and scenes to render with one command.
struct Batch {
  job::Job job;  ///< the settings that all jobs share; its file names have patterns for the frame and the scene
  std::vector<std::filesystem::path> scenes;
  std::vector<int> frames;              ///< empty: one still image per scene
  std::filesystem::path preview;        ///< file that the caller writes previews to; empty: none
  std::vector<job::OutputFile> others;  ///< more files that the caller writes
  bool keep_going = false;              ///< continue after a job that fails

  std::function<void(std::size_t index, std::size_t count)> on_begin;
  std::function<void(const job::Job&, const job::JobReport&)> on_end;
  std::function<void(const job::Job&, const base::Error&)> on_failure;
};

/// Creates one job per frame and scene. In file names, replaces `####` and `%04d` by the frame, and `{scene}` by the
/// scene's file name without its extension. The jobs share one set of files, which detects conflicts between them.
///
/// Errors     base::Error(kUsage) if a file would be written twice, if an output is an input, or if a name lacks a
///            needed pattern or has a frame pattern without frames
std::vector<job::Job> jobs_of(const Batch& batch);

/// The result of a batch.
struct BatchReport {
  std::size_t jobs = 0, rendered = 0, skipped = 0;
  struct Failure {
    std::string name;  ///< "frame 7 of shot.toml"
    base::Error error;
  };
  std::vector<Failure> failures;
};

/// Runs the jobs one after another. If the batch keeps going, reports failures and continues.
///
/// `jobs`     jobs_of(batch)
/// Errors     kStopped if a job was stopped; the first failure if the batch does not keep going
BatchReport run_batch(const Batch& batch, const std::vector<job::Job>& jobs);

/// "frame 7 of shot.toml"; without frames, "shot.toml".
std::string job_name(const Batch& batch, const job::Job& job);

}  // namespace orrery::farm
