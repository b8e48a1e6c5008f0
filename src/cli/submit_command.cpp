// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>

#include "base/error.h"
#include "base/frames.h"
#include "cli/commands.h"
#include "cli/messages.h"
#include "cli/render_options.h"
#include "submit/submit.h"

namespace orrery::cli {
namespace {

/// Heading, in the help, of the options that are not those of `render`.
constexpr const char* kJobOptions = "Job options";

struct SubmitOptions {
  RenderOptions render;
  submit::Submission submission;
  std::filesystem::path scene_file;
  bool slurm = false, openjd = false, opencue = false;
  const Option* parallel = nullptr;
  const Command *command = nullptr, *merge = nullptr;
};

bool has_option(const Command& command, const std::string& name) {
  return std::any_of(command.options().begin(), command.options().end(),
                     [&](const Option& option) { return option.name() == name; });
}

/// Passes the arguments of `render` on as typed. With shards, the merge gets those that it has, and the renders get all
/// but those that describe the images.
void pass_arguments_on(const SubmitOptions& options, submit::Submission& submission) {
  const bool is_split = submission.shards > 1;
  const auto is_passed_on = [](const Option& option) { return option.heading() != kJobOptions; };
  submission.render_arguments = options.command->arguments([&](const Option& option) {
    const bool is_of_images =
        (option.heading() == kImageOptions && option.name() != "--denoise") || option.name() == "--stats";
    return is_passed_on(option) && !(is_split && is_of_images);
  });
  if (is_split)  // the shards carry what --set sets
    submission.merge_arguments = options.command->arguments([&](const Option& option) {
      return is_passed_on(option) && option.name() != "--set" && has_option(*options.merge, option.name());
    });
}

int submit(SubmitOptions& options) {
  submit::Submission& s = options.submission;
  s.batch = options.render.batch;
  s.batch.scenes = {options.scene_file};
  s.batch.job.scene.overrides = options.render.scene.overrides();
  options.render.picture.finish(s.batch.job);
  if (!s.frames_text.empty()) s.batch.frames = base::parse_frames(s.frames_text);
  if (options.slurm + options.openjd + options.opencue + static_cast<int>(options.parallel->count()) != 1)
    base::refuse("specify one of --slurm, --openjd, --opencue and --parallel N");
  pass_arguments_on(options, s);
  s.engine = options.slurm     ? submit::Engine::kSlurm
             : options.openjd  ? submit::Engine::kOpenJd
             : options.opencue ? submit::Engine::kOpenCue
                               : submit::Engine::kParallel;
  print_result(submit::submission_text(s));
  return 0;
}

void add_job_options(Command& command, SubmitOptions& options) {
  const OptionGroup group(command, kJobOptions);
  submit::Submission& s = options.submission;
  command.add_option("SCENE", options.scene_file, "FILE", "Scene file")->required();
  command.add_flag("--slurm", options.slurm, "Write a shell script that calls sbatch");
  command.add_flag("--openjd", options.openjd, "Write an Open Job Description template (jobtemplate-2023-09)");
  command.add_flag("--opencue", options.opencue, "Write an OpenCue job specification (XML, cjsl-1.12)");
  options.parallel = command
                         .add_option("--parallel", s.jobs_at_a_time, "N",
                                     "Write a shell script that calls GNU parallel, N tasks at a time")
                         ->transform(whole_number(1, kMaxThreads));
  command.add_option("--frames", s.frames_text, "RANGE", "Frames to render, e.g. 1-48, 1-48x2 or 1,3,7-9");
  command.add_option("--shards", s.shards, "N", "Number of shards per frame, merged at the end; default: 1")
      ->details("Not with --noise, --time and --deep.")
      ->transform(whole_number(1, 1000));
  command.add_option("--program", s.program, "FILE", "orrery executable on the render nodes; default: orrery");
  s.program = "orrery";
}

}  // namespace

void add_submit(Command& program) {
  const auto options = std::make_shared<SubmitOptions>();
  Command& command = *program.add_subcommand(
      "submit", "Write a render-farm job (Slurm, OpenJD, OpenCue, GNU parallel) to standard output");
  options->command = &command;
  options->merge = &*std::find_if(program.subcommands().begin(), program.subcommands().end(),
                                  [](const Command& other) { return other.name() == "merge"; });
  add_job_options(command, *options);
  add_render_options(command, options->render);
  command.details(
      "The job renders and merges the frames of a scene. Its tasks get the options of orrery render as typed; with "
      "--shards, the merge gets those that describe the images, and --stats. Names with control characters, or that "
      "are not UTF-8, are refused.");
  command.footer(
      "All other options are those of orrery render; the tasks get them as typed.\n"
      "\n"
      "Examples:\n"
      "  orrery submit shot.toml -o shot.####.exr --frames 1-240 --shards 4 --slurm > shot.sh; sh shot.sh\n"
      "  orrery submit shot.toml -o shot.####.png --frames 1-48 --parallel 2 | sh");
  command.action([options] { return submit(*options); });
}

}  // namespace orrery::cli
