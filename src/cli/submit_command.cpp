// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "farm/submit.h"
#include "base/error.h"
#include "base/frames.h"
#include "cli/commands.h"
#include "cli/option_checks.h"
#include "cli/output.h"
#include "cli/picture_options.h"
#include "cli/scene_options.h"

namespace orrery::cli {
namespace {

struct SubmitOptions {
  farm::Submission submission;
  SceneOptions scene;
  PictureOptions picture;
  std::filesystem::path scene_file;
  bool slurm = false, openjd = false, opencue = false;
  const Option* parallel = nullptr;
};

int submit(SubmitOptions& options) {
  farm::Submission& s = options.submission;
  farm::Batch& batch = s.batch;
  batch.scenes = {options.scene_file};
  batch.job.scene.overrides = options.scene.overrides();
  options.picture.finish(batch.job);
  if (!s.frames_text.empty()) batch.frames = base::parse_frames(s.frames_text);
  if (options.slurm + options.openjd + options.opencue + static_cast<int>(options.parallel->count()) != 1)
    throw base::Error(base::ErrorKind::kUsage,
                      "say who shall run it, by one of --slurm, --openjd, --opencue and --parallel N");
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
  Command& command = *program.add_subcommand("submit", "Print a job for Slurm, OpenJD, OpenCue or GNU parallel");
  command.add_option("SCENE", options->scene_file, "Scene file")->required()->type_name("FILE");
  command.add_flag("--slurm", options->slurm, "A shell script that calls sbatch");
  command.add_flag("--openjd", options->openjd, "An Open Job Description template, jobtemplate-2023-09");
  command.add_flag("--opencue", options->opencue, "A job of OpenCue's specification language, cjsl-1.12");
  options->parallel =
      command.add_option("--parallel", s.jobs_at_a_time, "A shell script that calls GNU parallel, N tasks at a time")
          ->transform(whole_number(1, kMaxThreads))
          ->type_name("N");
  options->picture.add_to(command, s.batch.job);
  options->scene.add_to(command);
  command.add_option("--frames", s.frames_text, "Frames to render, as 1-48, 1-48x2 or 1,3,7-9")->type_name("RANGE");
  command.add_option("--shards", s.shards, "Shards that each frame is split into and merged from; default: 1")
      ->transform(whole_number(1, 1000))
      ->type_name("N");
  command.add_option("--noise", s.batch.job.sampling.noise, "As of orrery render; only without --shards")
      ->transform(real_number(1e-6, 1))
      ->type_name("X");
  command.add_option("--time", s.batch.job.sampling.seconds, "As of orrery render; only without --shards")
      ->transform(duration())
      ->type_name("TIME");
  command.add_option("--stats", s.batch.job.outputs.statistics, "Write what each frame did as JSON")->type_name("FILE");
  command.add_option("--program", s.program, "The program that the engine calls; default: orrery")->type_name("FILE");
  s.program = "orrery";
  command.footer(
      "Examples:\n"
      "  orrery submit shot.toml -o shot.####.exr --frames 1-240 --shards 4 --slurm > shot.sh; sh shot.sh\n"
      "  orrery submit shot.toml -o shot.####.png --frames 1-48 --parallel 2 | sh");
  command.callback([options, &action] { action = [options] { return submit(*options); }; });
}

}  // namespace orrery::cli
