// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <sstream>
#include <vector>

#include "job/merge_shards.h"
#include "job/job.h"
#include "cli/commands.h"
#include "cli/messages.h"
#include "cli/option_checks.h"
#include "cli/picture_options.h"
#include "cli/render_report.h"
#include "cli/signals.h"

namespace orrery::cli {
namespace {

struct MergeOptions {
  job::Job job;
  PictureOptions picture;
  std::vector<std::filesystem::path> parts;
  bool quiet = false, verbose = false;
};

int merge(MergeOptions& options) {
  job::Job& job = options.job;
  options.picture.finish(job);
  job.hooks.on_warning = [&](const base::Diagnostic& warning) {
    if (!options.quiet) tell(base::formatted(warning));
  };
  job.merge.shards = job::read_shards(options.parts, job.merge.allow_missing ? job.hooks.on_warning : nullptr);
  job::take_scene(job.merge.shards.front(), job);
  job.hooks.cancel = &stop_on_signals();
  const job::JobReport report = job::run_job(job);
  if (!options.quiet) tell(report_text(job, report, options.verbose));
  return 0;
}

}  // namespace

void add_merge(Command& program, Action& action) {
  const auto options = std::make_shared<MergeOptions>();
  Command& command = *program.add_subcommand("merge", "Join parts of a picture that were rendered apart");
  command.add_option("PART", options->parts, "EXR files that --samples A:B or --shard I/N have made, in any order")
      ->required()
      ->type_name("FILE");
  options->picture.add_to(command, options->job);
  command
      .add_option("--scene", options->job.scene.file,
                  "The scene file, where it is no longer where it was when the parts were rendered")
      ->type_name("FILE");
  command.add_flag("--allow-missing", options->job.merge.allow_missing,
                   "Make a picture of what is there, and say in its header what is not");
  command
      .add_option("--memory-limit", options->job.resources.memory_limit,
                  "Refuse what needs more, as 8G; default: what is free")
      ->transform(byte_size())
      ->type_name("SIZE");
  command.add_option("--stats", options->job.outputs.statistics, "Write what all parts together did as JSON")
      ->type_name("FILE");
  command.add_flag("-q,--quiet", options->quiet, "Say nothing but errors");
  command.add_flag("-v,--verbose", options->verbose, "Say what was done and how long it took");
  command.footer(
      "Examples:\n"
      "  orrery merge part.*.exr -o final.exr -o final.png\n"
      "  orrery merge part.1.exr part.3.exr -o preview.png --allow-missing");
  command.callback([options, &action] { action = [options] { return merge(*options); }; });
}

}  // namespace orrery::cli
