// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <vector>

#include "base/stop_point.h"
#include "cli/commands.h"
#include "cli/messages.h"
#include "cli/render_options.h"
#include "cli/signals.h"
#include "job/run_job.h"
#include "job/shards.h"

namespace orrery::cli {
namespace {

struct MergeOptions {
  job::Job job;
  SceneOptions scene;
  PictureOptions picture;
  std::vector<std::filesystem::path> shards;
  bool quiet = false, verbose = false;
};

int merge(MergeOptions& options) {
  job::Job& job = options.job;
  options.picture.finish(job);
  job.hooks.on_warning = [&](const base::Diagnostic& warning) {
    if (!options.quiet) print_message(base::formatted(warning));
  };
  job.hooks.cancel = &stop_on_signals();
  const base::StopScope scope(job.hooks.cancel);
  job.merge.shards = job::read_shards(options.shards, job.merge.allow_missing ? job.hooks.on_warning : nullptr);
  job::take_scene(job.merge.shards.front(), job);
  for (const load::Override& setting : options.scene.overrides()) job.scene.overrides.add(setting);
  const job::JobReport report = job::run_job(job);
  if (!options.quiet) print_message(report_text(job, report, {options.verbose}));
  return 0;
}

}  // namespace

void add_merge(Command& program) {
  const auto options = std::make_shared<MergeOptions>();
  Command& command = *program.add_subcommand("merge", "Merge shards of an image");
  command
      .add_option("SHARD", options->shards, "FILE",
                  "EXR files rendered with --sample-range A:B or --shard I/N, in any order")
      ->required();
  options->picture.add_to(command, options->job);
  options->scene.add_to(command, SceneOptions::Short::kNone);
  command.add_option("--scene", options->job.scene.file, "FILE",
                     "Scene file; default: the file that the shards were rendered from");
  command
      .add_flag("--allow-missing", options->job.merge.allow_missing,
                "Merge even if shards are missing or damaged; record missing samples in the header")
      ->details("They are skipped with a warning.");
  command
      .add_option("--memory-limit", options->job.resources.memory_limit, "SIZE",
                  "Refuse to merge if the estimated memory exceeds SIZE, e.g. 8G; default: free memory")
      ->transform(byte_size());
  command.add_option("--stats", options->job.outputs.statistics, "FILE", "Write statistics of all shards as JSON");
  command.add_flag("-q,--quiet", options->quiet, "Print only errors");
  command.add_flag("-v,--verbose", options->verbose, "Also print the time of each phase");
  command.details(
      "Writes the files that a single render would have written; --set can choose another display transform. Lists "
      "every shard that is missing, damaged, unfinished, overlapping, or of another scene or setting, and the samples "
      "that no shard has. --denoise needs shards that were rendered with --denoise.");
  command.footer(
      "Examples:\n"
      "  orrery merge shard.*.exr -o final.exr -o final.png\n"
      "  orrery merge shard.1.exr shard.3.exr -o preview.png --allow-missing");
  command.action([options] { return merge(*options); });
}

}  // namespace orrery::cli
