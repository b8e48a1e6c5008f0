// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "farm/batch.h"

namespace orrery::farm {

enum class Engine { kSlurm, kOpenJd, kOpenCue, kParallel };

/// A request to `orrery submit`.
struct Submission {
  Batch batch;  ///< one scene, its frames, and the job of each
  Engine engine = Engine::kSlurm;
  int shards = 1;           ///< per frame, by pixels
  int jobs_at_a_time = 1;   ///< for kParallel
  std::string program;      ///< command that the engine runs
  std::string frames_text;  ///< as the user wrote them; empty: one still image
  std::vector<std::string>
      arguments;  ///< arguments of the command that writes the images: "-o", "shot.####.exr", "--bits", "16"
};

/// The commands of a submission, the same for every engine.
struct Commands {
  std::string name;              ///< job name: the scene's name in letters, digits, - and _
  std::filesystem::path folder;  ///< folder of shards and logs
  std::vector<int> frames;
  std::vector<std::string> render;  ///< renders a shard; kFrame and kShard are placeholders for its numbers
  std::vector<std::string> merge;   ///< merges the shards of a frame; empty without shards

  static constexpr const char* kFrame = "@FRAME@";
  static constexpr const char* kShard = "@SHARD@";
};

/// Reads and checks the scene, and composes the commands.
///
/// Errors     those of jobs_of and load_scene; base::Error(kUsage) for settings that cannot be combined with shards
Commands commands_of(const Submission& submission);

/// The whole job in the engine's format, as readable text.
///
/// Errors     those of commands_of
std::string submission_text(const Submission& submission);

}  // namespace orrery::farm
