// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "display/settings.h"
#include "film/picture.h"
#include "image/write.h"
#include "render/statistics.h"

namespace orrery::job {

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
  std::string scene_hash;
  display::Choice display;           ///< if a display format was written
  std::filesystem::path checkpoint;  ///< written because the job was stopped; empty: none
  bool was_resumed = false;          ///< from a checkpoint
  std::string missing;               ///< samples that no merged shard has, as text; empty: none
  std::vector<std::string> hosts;    ///< machines that rendered the image
  bool was_skipped = false;          ///< its files existed and were up to date
};

}  // namespace orrery::job
