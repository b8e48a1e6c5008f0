// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "job/job.h"

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

/// The commands of a submission, the same for every engine.
struct Commands {
  std::string name;              ///< job name: the scene's name in letters, digits, - and _
  std::filesystem::path folder;  ///< folder of shards and logs
  std::vector<int> frames;
  std::vector<std::string> render;  ///< renders a shard
  std::vector<std::string> merge;   ///< merges the shards of a frame; empty without shards

  // Placeholders in words: control characters, which no other part of a word contains.
  static constexpr char kFrame = '\1';    ///< number of the frame
  static constexpr char kShard = '\2';    ///< number of the shard, from 1
  static constexpr char kThreads = '\3';  ///< threads of a task; kParallel only
};

/// Reads and checks the scene, and composes the commands.
///
/// Errors     those of jobs_of and load_scene; base::Error(kUsage) for settings that cannot be combined with shards,
///            and for words that the engine would not pass on unchanged
Commands commands_of(const Submission& submission);

/// The whole job in the engine's format, as readable text.
///
/// Errors     those of commands_of
std::string submission_text(const Submission& submission);

}  // namespace orrery::submit
