// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <memory>

#include "cli/commands.h"
#include "cli/option_checks.h"
#include "cli/output.h"
#include "cli/scene_options.h"
#include "cli/signals.h"
#include "measure/bench_scene.h"

namespace orrery::cli {
namespace {

constexpr std::uint64_t kMaxRounds = 1000;
constexpr double kMaxSeconds = 3600;  // of one measurement

struct BenchOptions {
  measure::BenchRequest request;
  SceneOptions scene;
  bool json = false, quiet = false;
};

int bench(BenchOptions& options) {
  measure::BenchRequest& request = options.request;
  request.scene.overrides = options.scene.overrides();
  request.scene.frame = options.scene.frame();
  request.cancel = &stop_on_signals();
  const bool shows_progress = !options.quiet && ::isatty(STDERR_FILENO) == 1;
  if (shows_progress)
    request.on_progress = [](int done, int total) {
      std::fprintf(stderr, done < total ? "\rmeasurement %d of %d" : "\r\x1b[K", done, total);
    };
  const measure::Benchmark found = measure::bench_scene(request);
  print_result(options.json ? measure::benchmark_json(found) : measure::benchmark_text(found));
  return 0;
}

}  // namespace

void add_bench(Command& program, Action& action) {
  const auto options = std::make_shared<BenchOptions>();
  Command& command =
      *program.add_subcommand("bench", "Benchmark a scene in each precision, with Embree and with a list of spheres");
  command.add_option("SCENE", options->request.scene.file, "Scene file")->required()->type_name("FILE");
  options->scene.add_to(command, SceneOptions::Short::kSize);
  options->scene.add_frame_to(command);
  command.add_option("-t,--threads", options->request.threads, "Number of threads; default: 1")
      ->transform(whole_number(1, kMaxThreads))
      ->type_name("N");
  command.add_option("--rounds", options->request.rounds, "Repetitions per case; default: 7")
      ->transform(whole_number(1, kMaxRounds))
      ->type_name("N");
  command
      .add_option("--seconds", options->request.seconds,
                  "Minimum duration of each repetition, in seconds; default: 0.25")
      ->check(real_number(0.001, kMaxSeconds))
      ->type_name("SECONDS");
  command.add_flag("--json", options->json, "Print JSON");
  command.add_flag("-q,--quiet", options->quiet, "Do not show progress");
  command.footer(
      "Samples, precision, accelerator and layers of the scene have no effect. Larger images are reduced to about "
      "5,184 "
      "pixels.\n"
      "Examples:\n"
      "  orrery bench scenes/book/final.toml\n"
      "  orrery bench cloud.toml --threads 8 --rounds 15 --json");
  command.callback([options, &action] { action = [options] { return bench(*options); }; });
}

}  // namespace orrery::cli
