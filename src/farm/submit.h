// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "farm/batch.h"

namespace orrery::farm {

enum class Engine { kSlurm, kOpenJd, kOpenCue, kParallel };

/// What `orrery submit` was asked for.
struct Submission {
  Batch batch;  ///< one scene; its frames; what the pictures shall be
  Engine engine = Engine::kSlurm;
  int shards = 1;           ///< parts that each frame is split into, by tiles
  int jobs_at_a_time = 1;   ///< kParallel
  std::string program;      ///< that the engine shall call
  std::string frames_text;  ///< as the user wrote them; empty: one picture
};

/// The commands that a submission comes to, the same for every engine.
struct Commands {
  std::string name;             ///< of the job: the scene's, letters, digits, - and _
  std::filesystem::path parts;  ///< folder of parts, and of logs
  std::vector<int> frames;
  /// Words of the command that renders a part of a frame; kFrame and kShard stand for its numbers.
  std::vector<std::string> render;
  std::vector<std::string> merge;  ///< of the one that joins a frame's parts; empty where there is but one

  static constexpr const char* kFrame = "@FRAME@";
  static constexpr const char* kShard = "@SHARD@";
};

/// Errors     base::Error: kUsage as jobs_of, and for what cannot be split; those of reading the scene
Commands commands_of(const Submission& submission);

/// The whole job as text that the engine takes, and that a person can read and edit.
///
/// Errors     as commands_of
std::string submission_text(const Submission& submission);

}  // namespace orrery::farm
