// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "job/batch.h"

namespace orrery::submit {

enum class Engine { kSlurm, kOpenJd, kOpenCue, kParallel };

/// A request to `orrery submit`.
struct Submission {
  job::Batch batch;  ///< one scene, its frames, and the job of each
  Engine engine = Engine::kSlurm;
  int shards = 1;           ///< per frame, by pixels
  int jobs_at_a_time = 1;   ///< for kParallel
  std::string program;      ///< command that the engine runs
  std::string frames_text;  ///< as the user wrote them; empty: one still image
  /// Arguments of `orrery render` besides the scene and the frames, as the user wrote them: "-o", "shot.####.exr",
  /// "--samples", "64". With shards, without those that describe the images.
  std::vector<std::string> render_arguments;
  std::vector<std::string> merge_arguments;  ///< those of `orrery merge`, with shards
};

/// Reads and checks the scene, and returns the whole job in the engine's format, as readable text.
///
/// Errors     those of jobs_of and load_scene; base::Error(kUsage) for settings that cannot be combined with shards,
///            and for words that the engine would not pass on unchanged
std::string submission_text(const Submission& submission);

}  // namespace orrery::submit
