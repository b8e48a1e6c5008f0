// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "job/job.h"
#include "base/error.h"

namespace orrery::farm {

/// Frames and scenes to render by one call.
struct Batch {
  job::Job job;  ///< what all have in common; its files' names have places for the frame and the scene
  std::vector<std::filesystem::path> scenes;
  std::vector<int> frames;    ///< empty: each scene as it is, one picture
  std::filesystem::path log;  ///< that the caller writes messages to; empty: none
  bool keep_going = false;    ///< after a job that fails

  std::function<void(const job::Job&, std::size_t index, std::size_t count)> on_begin;
  std::function<void(const job::Job&, const job::JobReport&)> on_end;
  std::function<void(const job::Job&, const base::Error&)> on_failure;
};

/// One job for each frame of each scene. Names are filled in: `####` and `%04d` by the frame, `{scene}` by the scene's
/// file name without its extension.
///
/// No file of theirs is written twice, or is read and overwritten: the jobs share one set of all their files.
///
/// Errors     base::Error(kUsage) where they do, or frames have names without need
std::vector<job::Job> jobs_of(const Batch& batch);

/// What came of a batch.
struct BatchReport {
  std::size_t jobs = 0, rendered = 0, skipped = 0;
  struct Failure {
    std::string name;  ///< "frame 7 of shot.toml"
    base::Error error;
  };
  std::vector<Failure> failures;
};

/// Runs the jobs one after the other. A failure of one is told and, where the batch keeps going, not the end of all.
///
/// `jobs`     jobs_of(batch)
/// Errors     kStopped of a job that was stopped; the failure itself where the batch does not keep going
BatchReport run_batch(const Batch& batch, const std::vector<job::Job>& jobs);

/// "frame 7 of shot.toml"; of a batch without frames the scene alone.
std::string job_name(const Batch& batch, const job::Job& job);

}  // namespace orrery::farm
