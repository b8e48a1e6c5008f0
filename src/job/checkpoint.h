// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>

#include "film/forward.h"
#include "image/provenance.h"

namespace orrery::job {

struct Hooks;

/// The checkpoint file of a job, named after its first output: shot.0007.checkpoint.exr for shot.0007.exr. Names that
/// would be too long are shortened.
std::filesystem::path checkpoint_file(const std::filesystem::path& first_output);

/// When checkpoints are written and read.
struct CheckpointSettings {
  bool resume = false;    ///< continue from the checkpoint if it exists
  bool keep = false;      ///< keep a checkpoint of the finished render, from which one with more samples can continue
  double interval_s = 0;  ///< 0: only when the job is stopped
};

/// The checkpoint of one job: decides when it is due, reads, writes and removes it.
class Checkpoint {
 public:
  /// Writes a partial film to a file.
  using Write = std::function<void(const std::filesystem::path& file, const film::Partial& partial)>;

  /// Starts the first interval; no file is read or written yet.
  ///
  /// Domain     `settings` and `hooks` outlive this
  Checkpoint(std::filesystem::path file, const CheckpointSettings& settings, const Hooks& hooks,
             image::Provenance provenance, Write write);

  const std::filesystem::path& file() const { return file_; }

  /// Reads the checkpoint of an earlier run, if the job resumes and the file exists. Warns if it exists and the job
  /// does not resume, because a checkpoint of this run will replace it.
  ///
  /// Errors     base::Error(kBadData) if it is damaged or from another scene, setting or version
  std::optional<film::Partial> load(int width_px, int height_px);

  /// True once per interval, and when a signal requests a checkpoint. Thread-safe.
  bool is_due() const;

  /// Writes a checkpoint during rendering. A failure is only a warning, since the render can still succeed.
  void write_snapshot(const film::Partial& partial);

  /// Writes a checkpoint when the render stops.
  ///
  /// Errors     base::Error: kCannotCreate, kIo
  void write(const film::Partial& partial);

  /// Removes the checkpoint if this job wrote it or resumed from it; writes it instead if the settings keep it. Call
  /// after the images are written.
  ///
  /// `partial`  the finished sums; null for a merge, which has no checkpoint
  void finish(const film::Partial* partial);

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
