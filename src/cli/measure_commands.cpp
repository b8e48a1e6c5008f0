// SPDX-License-Identifier: Apache-2.0
// The commands that measure on a scene: bench and study.
#include <cstdint>
#include <cstdio>
#include <memory>

#include <fmt/core.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_name.h"
#include "cli/commands.h"
#include "cli/messages.h"
#include "cli/options.h"
#include "cli/progress.h"
#include "cli/signals.h"
#include "study/bench.h"
#include "study/study.h"

namespace orrery::cli {
namespace {

constexpr std::uint64_t kMaxRounds = 1000;
constexpr double kMaxSeconds = 3600;  // of one measurement

template <class Request>
struct MeasureOptions {
  Request request;
  SceneOptions scene;
  bool json = false, quiet = false;

  void add_scene_to(Command& command) {
    command.add_option("SCENE", request.scene.file, "FILE", "Scene file")->required();
  }
  void add_output_to(Command& command, const char* schema) {
    command.add_flag("--json", json, "Print JSON")->details(schema);
    command.add_flag("-q,--quiet", quiet, "Do not show progress");
  }

  /// Completes the request. Returns the printer of its progress.
  ProgressPrinter begin() {
    request.scene.overrides = scene.overrides();
    request.scene.frame = scene.frame();
    request.cancel = &stop_on_signals();
    return ProgressPrinter(quiet ? ProgressStyle::kNone : ProgressStyle::kAuto, stderr);
  }
};

int bench(MeasureOptions<study::BenchRequest>& options) {
  ProgressPrinter printer = options.begin();
  options.request.on_progress = [&](int done, int total) {
    printer.update({static_cast<std::uint64_t>(done), static_cast<std::uint64_t>(total), 0,
                    fmt::format("measurement {} of {}", done, total)});
  };
  const study::Benchmark found = study::bench_scene(options.request);
  printer.finish();
  print_result(options.json ? study::benchmark_json(found) : study::benchmark_text(found));
  return 0;
}

int study(MeasureOptions<study::Request>& options) {
  ProgressPrinter printer = options.begin();
  options.request.on_progress = [&](const std::string& what, double fraction) {
    constexpr std::uint64_t kSteps = 1000;
    printer.update({static_cast<std::uint64_t>(fraction * kSteps), kSteps, 0, what});
  };
  const std::filesystem::path& report = options.request.report;
  if (!report.empty() && base::extension(report) != ".html" && base::extension(report) != ".htm")
    base::refuse(report.string() + ": the report is an HTML file; name it .html, or print numbers with --json");
  const study::Study found = study::run_study(options.request);
  printer.finish();
  if (!report.empty()) base::write_text_file(report, study::study_html(found));
  print_result(options.json ? study::study_json(found) : study::study_text(found));
  return 0;
}

}  // namespace

void add_bench(Command& program) {
  const auto options = std::make_shared<MeasureOptions<study::BenchRequest>>();
  Command& command =
      *program.add_subcommand("bench", "Benchmark a scene in each precision, with Embree and with a list of spheres");
  options->add_scene_to(command);
  options->scene.add_to(command, SceneOptions::Short::kSize);
  options->scene.add_frame_to(command);
  add_threads_option(command, options->request.threads, "1");
  command.add_option("--rounds", options->request.rounds, "N", "Repetitions per case; default: 7")
      ->transform(whole_number(1, kMaxRounds));
  command
      .add_option("--seconds", options->request.seconds, "SECONDS",
                  "Minimum duration of each repetition, in seconds; default: 0.25")
      ->check(real_number(0.001, kMaxSeconds));
  options->add_output_to(command, "Schema orrery.bench/1.");
  command.details(
      "Lists of spheres are skipped if they would take too long. Each round measures all cases; results are the ratios "
      "to \"embree exact\" of the same round.");
  command.footer(
      "Samples, precision, accelerator and layers of the scene have no effect. Larger images are reduced to about "
      "5,184 pixels.\n"
      "Examples:\n"
      "  orrery bench scenes/book/final.toml\n"
      "  orrery bench cloud.toml --threads 8 --rounds 15 --json");
  command.action([options] { return bench(*options); });
}

void add_study(Command& program) {
  const auto options = std::make_shared<MeasureOptions<study::Request>>();
  Command& command = *program.add_subcommand(
      "study", "Measure the trade-off between render time and error on a scene, and recommend settings");
  options->add_scene_to(command);
  command
      .add_option("-o,--output", options->request.report, "FILE",
                  "Write a report: a self-contained HTML file with plots and images")
      ->details("Its name ends in .html.");
  options->scene.add_to(command);
  options->scene.add_frame_to(command);
  command
      .add_option("--budget", options->request.budget_s, "TIME",
                  "Time budget of the study, e.g. 90s or 5m; default: 2m")
      ->details(
          "Measurements that it does not allow are skipped and listed. A budget that does not allow a reference and "
          "two choices is an error.")
      ->transform(duration());
  command.add_option("--noise", options->request.noise, "X", "Target noise of the recommendation; default: 0.01")
      ->transform(real_number(1e-4, 1));
  add_threads_option(command, options->request.threads);
  options->add_output_to(command, "Schema orrery.study/1.");
  command.details(
      "Renders a reference, then varies the settings that affect this scene (samples, sampler, --noise, precision, "
      "Russian roulette, depth, Fresnel model, accelerator), and recommends a command, which it has "
      "tried at the scene's full size. docs/trade.md explains the table.");
  command.footer(
      "Examples:\n"
      "  orrery study scenes/book/final.toml --budget 5m -o report.html\n"
      "  orrery study cloud.toml --noise 0.02 --json");
  command.action([options] { return study(*options); });
}

}  // namespace orrery::cli
