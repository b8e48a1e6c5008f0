// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "cli/picture_options.h"
#include "cli/scene_options.h"
#include "farm/batch.h"

namespace orrery::cli {

/// The options of a command that renders.
struct RenderOptions {
  farm::Batch batch;
  SceneOptions scene;
  PictureOptions picture;
  std::string preview, progress = "auto", sample_range, shard, frames;
  bool quiet = false, verbose = false, strict = false, fail_fast = false;
  bool shows_display = false;          ///< the display transform is used for more than images
  std::function<void()> before_files;  ///< called when all names are checked, before any file is written
};

/// Adds the options of rendering, except those that name the scene, its frames and its shard.
///
/// Domain     called once; `options` does not move until the command line is parsed
void add_render_options(Command& command, RenderOptions& options);

/// Sets the format of messages to that of --progress. Called first, so that it applies to all messages.
void begin_messages(const RenderOptions& options);

/// Renders the scenes and frames of a batch.
///
/// Result     the exit status
/// Errors     those of farm::jobs_of and farm::run_batch
int run_render(RenderOptions& options);

}  // namespace orrery::cli
