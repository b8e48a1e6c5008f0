// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/file_set.h"
#include "base/diagnostic.h"
#include "display/develop.h"
#include "film/picture.h"
#include "format/read_scene.h"
#include "image/partial_file.h"
#include "image/write.h"
#include "render/render.h"

namespace orrery::job {

/// A file with a part of a picture, and what it says of itself.
struct ShardFile {
  std::filesystem::path file;
  image::Provenance provenance;
};

/// What `orrery render` or `orrery merge` was asked for.
struct Job {
  std::filesystem::path scene;
  std::vector<format::Override> overrides;     ///< "camera.vfov=30"
  std::vector<std::filesystem::path> outputs;  ///< the extension chooses the format
  display::Settings display;                   ///< for display formats; the working space is the scene's
  int bits = 0;                                ///< of display formats; 0: 8
  image::ExrOptions exr;
  bool reproducible = false;         ///< leave out of headers what changes between runs
  std::filesystem::path deep;        ///< EXR of samples in depth; empty: none
  std::filesystem::path statistics;  ///< empty: none
  int threads = 0;                   ///< 0: default_threads()
  std::uint64_t memory_limit = 0;    ///< bytes; 0: what is free
  std::uint64_t disk_limit = 0;      ///< bytes of each file system; 0: what is free
  std::string traversal = "auto";    ///< auto, packet or single; how rays go through the hierarchy, for comparison
  double noise = 0;                  ///< that the picture shall have, as film/display_error.h measures it; 0: not asked
  double seconds = 0;                ///< for all but writing the files; 0: as long as it takes
  std::string isa;                   ///< "avx2": no better instruction set; empty: the processor's best
  std::function<void(const render::Progress&)> on_progress;
  std::function<void(double fraction)> on_build;  ///< what is done of building the hierarchy; from any thread
  std::function<void(const base::Diagnostic&)> on_warning;
  const std::atomic<bool>* cancel = nullptr;
  std::function<void(const std::string&)> on_note;  ///< what somebody has asked for and wants to hear of
  bool resume = false;                              ///< go on from a checkpoint, where there is one
  double checkpoint_s = 0;                          ///< seconds between checkpoints; 0: one when it is stopped
  std::atomic<bool>* snapshot = nullptr;            ///< true: write a checkpoint at once; it is set to false again
  std::uint32_t sample_begin = 0, sample_end = 0;   ///< render only these, as a part; end 0: all
  render::PixelShard shard;                         ///< render only these pixels, as a part
  bool as_shard = false;                            ///< render a part, though it be of all samples and pixels
  std::vector<ShardFile> parts;                     ///< join these instead of rendering
  bool allow_missing = false;                       ///< of parts
  int frame = format::kFirstFrame;                  ///< of the scene's animation
  /// Files of the batch that this job belongs to; null: the job stands alone.
  std::shared_ptr<base::FileSet> files = nullptr;
  bool skip_existing = false;  ///< do nothing where all files are there, whole, and of this job
};

/// True where the samples of the scene are a limit although something else ends the render.
bool is_limited(const Job& job);

/// True where a part is rendered, not a picture.
inline bool is_shard(const Job& job) { return job.as_shard || job.sample_end > 0 || job.shard.count > 1; }

/// Seconds by phase.
struct Phases {
  double read_s = 0, compile_s = 0, build_s = 0, render_s = 0;
  double finish_s = 0;  ///< from sums to the finished picture and its layers; of a merge also reading the parts
  double write_s = 0;
};

/// What came of it.
struct JobReport {
  render::Statistics render;
  Phases phases;
  film::BadValues bad_values;                                       ///< of the picture, before any display transform
  std::vector<std::pair<std::string, film::BadValues>> bad_layers;  ///< the same of each layer that has any
  image::WriteReport written;                                       ///< changed so that it fits into the files
  int width = 0, height = 0;
  std::string target_missed;  ///< "noise 0.013 instead of 0.01: time was over"; empty: as was asked
  std::size_t spheres = 0;
  std::string scene_hash;
  display::Choice display;           ///< where a display format was written
  std::filesystem::path checkpoint;  ///< that was written when it was stopped; empty: none
  bool was_resumed = false;          ///< from a checkpoint
  std::string missing;               ///< of joined parts, in words; empty: nothing
  std::vector<std::string> hosts;    ///< that have rendered it
  bool was_skipped = false;          ///< its files were there already
};

/// Renders a scene into files, or joins parts of its picture: read, check, compile, render, develop, write.
///
/// A part is an EXR of sums. A job that is stopped writes a checkpoint, of the same kind, and one that resumes ends
/// with the bits of one that was never stopped.
///
/// No output replaces an input, the points files and OCIO configs of the scene included.
///
/// That the files can be written, and that formats, compression, display and view exist, is known before rendering
/// starts. A statistics file is written also where it was stopped or failed later.
///
/// Domain     one output at least
/// Errors     base::Error of every kind; kStopped where `cancel` stopped it, and then no picture was written
JobReport run_job(const Job& job);

}  // namespace orrery::job
