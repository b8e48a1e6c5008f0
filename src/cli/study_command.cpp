// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <memory>

#include "base/error.h"
#include "base/file_name.h"
#include "base/output_file.h"
#include "cli/commands.h"
#include "cli/option_checks.h"
#include "cli/output.h"
#include "cli/scene_options.h"
#include "cli/signals.h"
#include "measure/study.h"

namespace orrery::cli {
namespace {

struct StudyOptions {
  measure::Request request;
  SceneOptions scene;
  bool json = false, quiet = false;
};

void check_report_name(const std::filesystem::path& file) {
  if (base::extension(file) != ".html" && base::extension(file) != ".htm")
    throw base::Error(base::ErrorKind::kUsage,
                      file.string() + ": the report is an HTML file; name it .html, or print numbers with --json");
}

int run(StudyOptions& options) {
  measure::Request& request = options.request;
  request.scene.overrides = options.scene.overrides();
  request.scene.frame = options.scene.frame();
  request.cancel = &stop_on_signals();
  const bool on_terminal = ::isatty(STDERR_FILENO) == 1;
  int last = -1;
  if (!options.quiet)
    request.on_progress = [&](const std::string& what, double fraction) {
      const int percent = static_cast<int>(fraction * 100);
      if (on_terminal) {
        std::fprintf(stderr, fraction < 1 ? "\r%3d %%  %s\x1b[K" : "\r\x1b[K", percent, what.c_str());
      } else if (percent != last) {
        std::fprintf(stderr, "%d%% done\n", percent);
      }
      last = percent;
    };
  if (!request.report.empty()) check_report_name(request.report);
  const measure::Study found = measure::run_study(request);
  if (!request.report.empty()) base::write_text_file(request.report, measure::study_html(found));
  print_result(options.json ? measure::study_json(found) : measure::study_text(found));
  return 0;
}

}  // namespace

void add_study(Command& program, Action& action) {
  const auto options = std::make_shared<StudyOptions>();
  Command& command = *program.add_subcommand(
      "study", "Measure the trade-off between render time and error on a scene, and recommend settings");
  command.add_option("SCENE", options->request.scene.file, "Scene file")->required()->type_name("FILE");
  command
      .add_option("-o,--output", options->request.report,
                  "Write a report: a self-contained HTML file with plots and images")
      ->type_name("FILE");
  options->scene.add_to(command);
  options->scene.add_frame_to(command);
  command.add_option("--budget", options->request.budget_s, "Time budget of the study, e.g. 90s or 5m; default: 2m")
      ->transform(duration())
      ->type_name("TIME");
  command.add_option("--noise", options->request.noise, "Target noise of the recommendation; default: 0.01")
      ->transform(real_number(1e-4, 1))
      ->type_name("X");
  command
      .add_option("-t,--threads", options->request.threads,
                  "Number of threads; default: all CPUs available to the process")
      ->transform(whole_number(1, kMaxThreads))
      ->type_name("N");
  command.add_flag("--json", options->json, "Print JSON");
  command.add_flag("-q,--quiet", options->quiet, "Do not show progress");
  command.footer(
      "Examples:\n"
      "  orrery study scenes/book/final.toml --budget 5m -o report.html\n"
      "  orrery study cloud.toml --noise 0.02 --json");
  command.callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace orrery::cli
