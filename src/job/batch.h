// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "job/job.h"

namespace orrery::job {

/// Frames and scenes to render with one command.
struct Batch {
  Job job;  ///< the settings that all jobs share; its file names have patterns for the frame and the scene
  std::vector<std::filesystem::path> scenes;
  std::vector<int> frames;          ///< empty: one still image per scene
  std::vector<NamedOutput> others;  ///< files that the caller writes
};

/// Replaces the patterns in the name of an output: `{scene}` by the scene's file name without its extension; `####` and
/// `%04d` by the frame, if there is one.
std::filesystem::path output_name(const std::filesystem::path& name, const std::filesystem::path& scene,
                                  std::optional<int> frame);

/// Creates one job per frame and scene, with output_name() for its files. The jobs share one set of files, which
/// detects conflicts between them.
///
/// Errors     base::Error: kUsage if a file would be written twice, if an output is an input, or if a name lacks a
///            needed pattern or has a frame pattern without frames; kCannotCreate for one of the `others`
std::vector<Job> jobs_of(const Batch& batch);

}  // namespace orrery::job
