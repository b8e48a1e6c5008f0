// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "cli/options.h"
#include "job/batch.h"

namespace orrery::cli {

/// The options of a command that renders.
struct RenderOptions {
  job::Batch batch;
  SceneOptions scene;
  PictureOptions picture;
  std::string preview, progress = "auto", sample_range, shard, frames;
  bool quiet = false, verbose = false;
  std::function<void()> before_files;  ///< called when all names are checked, before any file is written
};

/// Adds the options that say how well to render, and with what: --noise, --time, --threads, --memory-limit.
void add_sampling_options(Command& command, job::Job& job);

/// Adds the options of rendering, except those that name the scene, its frames and its shard.
///
/// Domain     called once; `options` does not move until the command line is parsed
void add_render_options(Command& command, RenderOptions& options);

/// Renders the scenes and frames of a batch.
///
/// Result     the exit status
/// Errors     those of job::jobs_of and job::run_job
int run_render(RenderOptions& options);

/// Optional contents of the summary of a render, in addition to files, samples and render time.
struct ReportDetail {
  bool is_verbose = false;  ///< time of each phase, accelerator, display
  bool has_total = false;   ///< time of the whole job
};

/// Warnings about an image and a summary of its render, as whole lines.
std::string report_text(const job::Job& job, const job::JobReport& report, ReportDetail detail);

}  // namespace orrery::cli
