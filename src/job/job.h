// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/file_set.h"
#include "job/checkpoint.h"
#include "job/hooks.h"
#include "job/outputs.h"
#include "job/shard_file.h"
#include "load/scene_source.h"
#include "render/sampling_limits.h"

namespace orrery::job {

struct JobReport;
class PreparedScene;

/// Limits on the job's use of the machine.
struct Resources {
  int threads = 0;                 ///< 0: default_threads()
  std::uint64_t memory_limit = 0;  ///< bytes; 0: the free memory
  std::uint64_t disk_limit = 0;    ///< bytes per file system; 0: its free space
  std::string isa;                 ///< best instruction set to use, "avx2"; empty: see choose_isa()
};

/// The shards that a job merges instead of rendering.
struct MergeSettings {
  std::vector<ShardFile> shards;  ///< empty: render
  bool allow_missing = false;
};

struct Rendering;

/// A request to `orrery render` or `orrery merge`.
struct Job {
  load::SceneSource scene;
  Outputs outputs;
  render::SamplingLimits sampling;  ///< `unlimited` is derived from the scene source
  Resources resources;
  CheckpointSettings checkpoint;
  MergeSettings merge;
  Hooks hooks;
  bool as_shard = false;       ///< write a shard even if it has all samples of all pixels
  bool denoise = false;        ///< denoise the images; a shard instead keeps the halves of its samples for denoising
  bool skip_existing = false;  ///< do nothing if all files exist, are intact, and come from this job
  /// Files of the batch that this job belongs to; null: the job is not part of a batch.
  std::shared_ptr<base::FileSet> files = nullptr;
  /// The scene of an earlier job, of which this job prepares only what has changed; null: nothing is kept.
  std::shared_ptr<PreparedScene> prepared = nullptr;
  Rendering* keep = nullptr;  ///< receives the image and all layers of the scene; no file is written
  double prepare_s = 0;       ///< time taken to create the scene, for the report
};

/// True if the scene's sample count limits adaptive sampling, because an override sets it.
bool is_limited(const Job& job);

/// True if the output is a shard, not an image.
inline bool is_shard(const Job& job) { return job.as_shard || job.sampling.is_partial(); }

/// Renders a scene to files, or merges shards: read, check, compile, render or merge, develop, write.
///
/// A shard is an EXR of exact sums; so is the checkpoint of a stopped job. A resumed job gives the same bits as one
/// that was never stopped. No output replaces an input, including the scene's points files and OCIO configs.
///
/// Before rendering starts, the job checks that its files can be created and that formats, compression, display and
/// view exist. The statistics file is also written if the job is stopped or fails after these checks.
///
/// Domain     at least one output, or `keep` and none: no deep image, no checkpoint, no shard
/// Errors     base::Error of any kind; kStopped if `cancel` stopped the job, in which case no image was written
JobReport run_job(const Job& job);

}  // namespace orrery::job
