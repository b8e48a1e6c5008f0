// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "annotation/drawing.h"
#include "base/error.h"
#include "base/file_set.h"
#include "display/forward.h"
#include "display/settings.h"
#include "film/picture.h"
#include "image/header.h"
#include "image/write.h"
#include "job/outputs.h"
#include "load/load_scene.h"
#include "render/result.h"
#include "render/settings.h"

namespace orrery::job {

class PreparedScene;

/// Limits on the job's use of the machine.
struct Resources {
  int threads = 0;                 ///< 0: default_threads()
  std::uint64_t memory_limit = 0;  ///< bytes; 0: the free memory
  std::uint64_t disk_limit = 0;    ///< bytes per file system; 0: its free space
};

/// When checkpoints are written and read.
struct CheckpointSettings {
  bool resume = false;    ///< continue from the checkpoint if it exists
  bool keep = false;      ///< keep a checkpoint of the finished render, from which one with more samples can continue
  double interval_s = 0;  ///< 0: only when the job is stopped
};

/// An EXR with a shard of an image, and its provenance.
struct ShardFile {
  std::filesystem::path file;
  image::Provenance provenance;
};

/// The shards that a job merges instead of rendering.
struct MergeSettings {
  std::vector<ShardFile> shards;  ///< empty: render
  bool allow_missing = false;
};

/// Callbacks by which a job reports to its caller, and flags by which the caller controls it. Every member may be
/// empty.
struct Hooks {
  std::function<void(const render::Progress&)> on_progress;  ///< see render::Settings
  /// Called before the first sample with what is done, "reading", "compiling" or "building", and its progress, 0..1.
  std::function<void(const char* phase, double fraction)> on_preparation;
  /// Called before rendering starts, with what is drawn over the image, without outlines. Not called for a merge.
  std::function<void(const display::PictureInfo&, const annotation::Drawing&)> on_start;
  /// See render::Settings. Not called for a merge.
  std::function<void(const film::Sums&, const film::RenderedPixels&)> on_pixels;
  std::function<void(const film::Picture&)> on_denoised;  ///< receives the denoised image
  bool develops_pixels = false;  ///< `on_pixels` applies the display transform, so its names must be checked
  std::function<void(const base::Diagnostic&)> on_warning;
  std::function<void(const std::string&)> on_note;  ///< receives replies to requests that were made by a signal
  const std::atomic<bool>* cancel = nullptr;        ///< true stops the job
  std::atomic<bool>* checkpoint_request = nullptr;  ///< true requests a checkpoint; the job resets it to false

  bool is_cancelled() const { return cancel != nullptr && cancel->load(std::memory_order_relaxed); }
  void warn(const base::Diagnostic& diagnostic) const {
    if (on_warning) on_warning(diagnostic);
  }
  void prepare(const char* phase, double fraction = 0) const {
    if (on_preparation) on_preparation(phase, fraction);
  }
};

/// A request to render or to merge; run_job.h.
struct Job {
  load::SceneSource scene;
  Outputs outputs;
  render::Settings settings;  ///< the job sets threads, traversal, layers, `unlimited` and the callbacks
  Resources resources;
  CheckpointSettings checkpoint;
  MergeSettings merge;
  Hooks hooks;
  bool as_shard = false;       ///< write a shard even if it has all samples of all pixels
  bool denoise = false;        ///< denoise the images; a shard instead keeps the halves of its samples for denoising
  bool is_strict = false;      ///< a missed target is a failure, see JobReport::exit_status
  bool skip_existing = false;  ///< do nothing if all files exist, are intact, and come from this job
  /// Files of the batch that this job belongs to; null: the job is not part of a batch. In Batch::job: files of the
  /// caller; null: none.
  std::shared_ptr<base::FileSet> files = nullptr;
  /// The scene of an earlier job, of which this job prepares only what has changed; null: nothing is kept.
  std::shared_ptr<PreparedScene> prepared = nullptr;
  double prepare_s = 0;  ///< time taken to create the scene, for the report

  /// True if the image, with all layers of the scene, stays in memory.
  bool is_in_memory() const { return outputs.images.empty(); }
};

/// True if the scene's sample count limits adaptive sampling, because an override sets it.
inline bool is_limited(const Job& job) { return job.scene.overrides.sets("render.samples"); }

/// True if the output is a shard, not an image.
inline bool is_shard(const Job& job) { return job.as_shard || job.settings.is_partial(); }

/// True if the sums are needed when the image is finished: for a checkpoint, or to save them if it cannot be written.
/// The denoiser needs their memory.
inline bool keeps_sums(const Job& job) {
  const CheckpointSettings& kept = job.checkpoint;
  return is_shard(job) || (!job.is_in_memory() && (!job.denoise || kept.resume || kept.keep || kept.interval_s > 0));
}

/// Seconds by phase.
struct Phases {
  double prepare_s = 0;  ///< Job::prepare_s: before the job, once for all jobs of a batch
  double read_s = 0, compile_s = 0, build_s = 0, render_s = 0;
  double denoise_s = 0;  ///< with Job::denoise
  double finish_s = 0;   ///< from sums to the finished image and its layers; for a merge, includes reading the shards
  double write_s = 0;

  /// Of the job.
  double total_s() const { return read_s + compile_s + build_s + render_s + denoise_s + finish_s + write_s; }
};

/// Exit status of the program if a target was missed with Job::is_strict: running it again would miss it again.
inline constexpr int kTargetMissed = 76;

/// Result of a job.
struct JobReport {
  render::Statistics render;
  Phases phases;
  film::BadValues bad_values;  ///< bad values of the image, before any display transform
  std::vector<std::pair<std::string, film::BadValues>> bad_layers;  ///< layers with bad values
  image::WriteReport written;                                       ///< values changed to fit the files
  int width = 0, height = 0;                                        ///< px
  std::string target_missed;  ///< "noise 0.013 instead of 0.01: the time budget ended"; empty: the target was met
  std::size_t spheres = 0;
  std::size_t rods = 0;
  std::string scene_hash;
  display::Choice display;           ///< if a display format was written
  std::filesystem::path checkpoint;  ///< written because the job was stopped; empty: none
  bool was_resumed = false;          ///< from a checkpoint
  std::string missing;               ///< samples that no merged shard has, as text; empty: none
  std::vector<std::string> hosts;    ///< machines that rendered the image
  bool was_skipped = false;          ///< its files existed and were up to date
  int exit_status = 0;               ///< of the program: 0 or kTargetMissed
};

}  // namespace orrery::job
