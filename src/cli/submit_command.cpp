// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "base/error.h"
#include "base/frames.h"
#include "cli/commands.h"
#include "cli/display_options.h"
#include "cli/option_checks.h"
#include "cli/output.h"
#include "cli/picture_options.h"
#include "cli/scene_options.h"
#include "farm/submit.h"

namespace orrery::cli {
namespace {

struct SubmitOptions {
  farm::Submission submission;
  SceneOptions scene;
  PictureOptions picture;
  std::filesystem::path scene_file;
  bool slurm = false, openjd = false, opencue = false;
  const Option* parallel = nullptr;
  std::vector<const Option*> forwarded;  ///< besides the image and display options
  const Command* command = nullptr;
};

int submit(SubmitOptions& options) {
  farm::Submission& s = options.submission;
  farm::Batch& batch = s.batch;
  batch.scenes = {options.scene_file};
  batch.job.scene.overrides = options.scene.overrides();
  options.picture.finish(batch.job);
  if (!s.frames_text.empty()) batch.frames = base::parse_frames(s.frames_text);
  if (options.slurm + options.openjd + options.opencue + static_cast<int>(options.parallel->count()) != 1)
    throw base::Error(base::ErrorKind::kUsage, "specify one of --slurm, --openjd, --opencue and --parallel N");
  s.arguments = options.command->arguments(kImageOptions);
  const auto forward = [&](const std::vector<std::string>& words) {
    s.arguments.insert(s.arguments.end(), words.begin(), words.end());
  };
  forward(options.command->arguments(kDisplayOptions));
  for (const Option* option : options.forwarded) forward(option->arguments());
  s.engine = options.slurm     ? farm::Engine::kSlurm
             : options.openjd  ? farm::Engine::kOpenJd
             : options.opencue ? farm::Engine::kOpenCue
                               : farm::Engine::kParallel;
  print_result(farm::submission_text(s));
  return 0;
}

}  // namespace

void add_submit(Command& program, Action& action) {
  const auto options = std::make_shared<SubmitOptions>();
  farm::Submission& s = options->submission;
  Command& command = *program.add_subcommand(
      "submit", "Write a render-farm job (Slurm, OpenJD, OpenCue, GNU parallel) to standard output");
  command.add_option("SCENE", options->scene_file, "Scene file")->required()->type_name("FILE");
  command.add_flag("--slurm", options->slurm, "Write a shell script that calls sbatch");
  command.add_flag("--openjd", options->openjd, "Write an Open Job Description template (jobtemplate-2023-09)");
  command.add_flag("--opencue", options->opencue, "Write an OpenCue job specification (XML, cjsl-1.12)");
  options->parallel =
      command
          .add_option("--parallel", s.jobs_at_a_time, "Write a shell script that calls GNU parallel, N tasks at a time")
          ->transform(whole_number(1, kMaxThreads))
          ->type_name("N");
  options->picture.add_to(command, s.batch.job);
  options->scene.add_to(command);
  command.add_option("--frames", s.frames_text, "Frames to render, e.g. 1-48, 1-48x2 or 1,3,7-9")->type_name("RANGE");
  command.add_option("--shards", s.shards, "Number of shards per frame, merged at the end; default: 1")
      ->transform(whole_number(1, 1000))
      ->type_name("N");
  Option* const noise =
      command.add_option("--noise", s.batch.job.sampling.noise, "Target noise of each frame; not with --shards")
          ->transform(real_number(1e-6, 1))
          ->type_name("X");
  Option* const time =
      command.add_option("--time", s.batch.job.sampling.seconds, "Time budget of each frame; not with --shards")
          ->transform(duration())
          ->type_name("TIME");
  Option* const stats =
      command.add_option("--stats", s.batch.job.outputs.statistics, "Write statistics of each frame as JSON")
          ->type_name("FILE");
  options->forwarded = {noise, time, stats};
  options->command = &command;
  command.add_option("--program", s.program, "orrery executable on the render nodes; default: orrery")
      ->type_name("FILE");
  s.program = "orrery";
  command.footer(
      "Examples:\n"
      "  orrery submit shot.toml -o shot.####.exr --frames 1-240 --shards 4 --slurm > shot.sh; sh shot.sh\n"
      "  orrery submit shot.toml -o shot.####.png --frames 1-48 --parallel 2 | sh");
  command.callback([options, &action] { action = [options] { return submit(*options); }; });
}

}  // namespace orrery::cli
