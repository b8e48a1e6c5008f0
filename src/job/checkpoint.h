// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>

#include "film/partial.h"
#include "image/partial_file.h"
#include "job/hooks.h"

namespace orrery::job {

/// Where a job that writes this picture keeps what is rendered of it: shot.0007.exr has shot.0007.checkpoint.exr. A
/// name that would be too long is shortened.
std::filesystem::path checkpoint_file(const std::filesystem::path& first_output);

/// When checkpoints are written and read.
struct CheckpointSettings {
  bool resume = false;    ///< continue from the checkpoint, if there is one
  double interval_s = 0;  ///< 0: only when the job is stopped
};

/// The checkpoint of one job: when it is due, what is in it, and when it has done its work.
class Checkpoint {
 public:
  /// Writes a partial under a name.
  using Write = std::function<void(const std::filesystem::path& file, const film::Partial& partial)>;

  /// Domain     `settings` and `hooks` outlive this
  Checkpoint(std::filesystem::path file, const CheckpointSettings& settings, const Hooks& hooks,
             image::Provenance provenance, Write write);

  const std::filesystem::path& file() const { return file_; }

  /// What an earlier run has left, where the job wants to go on from it and there is something.
  ///
  /// Errors     base::Error(kBadData) where it is damaged or of another scene, setting or version
  std::optional<film::Partial> load(int width_px, int height_px);

  /// True from time to time, as the job wants it, and when it is asked by signal. From any thread.
  bool is_due() const;

  /// Writes a checkpoint while rendering; a failure is a warning, since the render can still end well.
  void write_snapshot(const film::Partial& partial);

  /// Writes a checkpoint because the render stops.
  ///
  /// Errors     base::Error: kCannotCreate, kIo
  void write(const film::Partial& partial);

  /// The pictures are written: a checkpoint that this job has written or gone on from goes.
  void remove();

 private:
  using Clock = std::chrono::steady_clock;

  const CheckpointSettings& settings_;
  const Hooks& hooks_;
  std::filesystem::path file_;
  image::Provenance provenance_;
  Write write_;
  Clock::time_point next_;
  bool is_ours_ = false;
};

}  // namespace orrery::job
