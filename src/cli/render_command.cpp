// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <memory>

#include "app/job.h"
#include "base/error.h"
#include "base/exit_status.h"
#include "cli/commands.h"
#include "cli/display_options.h"
#include "cli/option_checks.h"
#include "cli/progress.h"
#include "cli/scene_options.h"
#include "cli/signals.h"

namespace orrery::cli {
namespace {

struct RenderOptions {
  app::Job job;
  SceneOptions scene;
  std::string type = "half", progress = "auto";
  bool quiet = false, verbose = false, strict = false;
};

/// Quiet is about what people read; a farm manager that asked for its lines gets them.
ProgressStyle style_of(const RenderOptions& options) {
  const ProgressStyle style = progress_style(options.progress);
  return options.quiet && style == ProgressStyle::kAuto ? ProgressStyle::kNone : style;
}

/// What somebody should know before trusting the picture.
void print_bad_values(const app::JobReport& report) {
  const auto tell = [](std::uint64_t count, const char* what) {
    if (count > 0) std::fprintf(stderr, "warning: %llu %s\n", static_cast<unsigned long long>(count), what);
  };
  tell(report.render.bad_samples, "samples were not finite and were left out of their pixels");
  for (const auto& [layer, bad] : report.bad_layers) {
    const auto tell_of = [&, &name = layer](std::uint64_t count, const char* what) {
      if (count > 0)
        std::fprintf(stderr, "warning: %s: %llu values are %s\n", name.c_str(), static_cast<unsigned long long>(count),
                     what);
    };
    tell_of(bad.nan, "not a number");
    tell_of(bad.infinite, "infinite");
    tell_of(bad.negative, "negative");
  }
  tell(report.written.not_finite, "values that are not finite were written as 0");
  tell(report.written.clamped, "values do not fit into their file and were clamped; EXR with --type float keeps them");
}

void print_summary(const RenderOptions& options, const app::JobReport& report) {
  std::string files;
  for (const auto& output : options.job.outputs) files += (files.empty() ? "" : ", ") + output.string();
  const double seconds = report.render.render_s;
  const double pixels = static_cast<double>(report.width) * report.height;
  std::fprintf(stderr, "wrote %s: %d x %d, %.5g samples per pixel in %.1f s, %.2f M samples/s", files.c_str(),
               report.width, report.height, static_cast<double>(report.render.paths) / pixels, seconds,
               seconds > 0 ? static_cast<double>(report.render.paths) / seconds / 1e6 : 0.0);
  if (report.render.noise)
    std::fprintf(stderr, "; noise %.3g, %llu to %llu samples", *report.render.noise,
                 static_cast<unsigned long long>(report.render.fewest_samples),
                 static_cast<unsigned long long>(report.render.most_samples));
  std::fputc('\n', stderr);
  if (!options.verbose) return;
  std::fprintf(stderr, "%zu spheres, %s, %s, traversal %s, %d threads, %llu rays; scene %s\n", report.spheres,
               report.render.accelerator.c_str(), report.render.isa.c_str(), report.render.traversal.c_str(),
               report.render.threads, static_cast<unsigned long long>(report.render.rays), report.scene_hash.c_str());
  const app::Phases& phases = report.phases;
  std::fprintf(stderr, "read %.3f s, compile %.3f s, build %.3f s, render %.3f s, write %.3f s\n", phases.read_s,
               phases.compile_s, phases.build_s, phases.render_s, phases.write_s);
  const display::Choice& display = report.display;
  if (!display.display.empty())
    std::fprintf(stderr, "display %s, view %s, OCIO config %s\n", display.display.c_str(), display.view.c_str(),
                 display.config.c_str());
}

int render(RenderOptions& options) {
  app::Job& job = options.job;
  job.overrides = options.scene.overrides();
  job.exr.as_float = options.type == "float";
  job.cancel = &stop_on_signals();
  ProgressPrinter printer(style_of(options), stderr);
  job.on_progress = [&](const auto& p) { printer.update({p.samples_done, p.samples_total, p.seconds, p.goal}); };
  job.on_build = [&](double fraction) { printer.building(fraction); };
  job.on_warning = [&](const base::Finding& warning) {
    if (!options.quiet) std::fputs(base::formatted(warning).c_str(), stderr);
  };
  const app::JobReport report = app::run_job(job);
  printer.finish();
  if (!options.quiet) {
    print_bad_values(report);
    print_summary(options, report);
  }
  if (report.target_missed.empty()) return 0;
  if (!options.quiet || options.strict)
    std::fprintf(stderr, "%s: %s\n", options.strict ? "orrery" : "warning", report.target_missed.c_str());
  return options.strict ? base::exit_status(base::ErrorKind::kStopped) : 0;
}

void add_picture_options(CLI::App& command, RenderOptions& options) {
  add_display_options(command, options.job.display, options.job.bits);
  command.add_option("--type", options.type, "EXR channels: half, the default, or float")
      ->check(one_of({"half", "float"}))
      ->type_name("TYPE");
  command
      .add_option("--compression", options.job.exr.compression, "EXR compression, zips by default: zip, dwaa:45 ...")
      ->type_name("NAME");
  command
      .add_option("--deep", options.job.deep, "Write also an EXR of samples in depth, one for each sphere in a pixel")
      ->type_name("FILE");
  command.add_flag("--multipart", options.job.exr.multipart, "Give each layer of an EXR a part of its own");
  command.add_flag("--reproducible", options.job.reproducible, "Leave out of headers what changes between runs");
}

}  // namespace

void add_render(CLI::App& program, Action& action) {
  const auto options = std::make_shared<RenderOptions>();
  CLI::App& command = *program.add_subcommand("render", "Render a scene into one or more picture files");
  command.add_option("SCENE", options->job.scene, "Scene file")->required()->type_name("FILE");
  repeatable(*command
                  .add_option("-o,--output", options->job.outputs,
                              "File to write; its extension chooses EXR, HDR, PNG, TIFF, JPEG or PPM; can be repeated")
                  ->required()
                  ->type_name("FILE"));
  options->scene.add_to(command);
  command
      .add_option("--noise", options->job.noise,
                  "Sample until the picture is off by this much, relative to what a display shows, as 0.01")
      ->transform(real_number(1e-6, 1))
      ->type_name("X");
  command.add_option("--time", options->job.seconds, "Sample for so long, where it helps most: 90s, 5m, 1.5h")
      ->transform(duration())
      ->type_name("TIME");
  command.add_flag("--strict", options->strict, "Exit with 75 where --noise was not reached");
  command.add_option("-t,--threads", options->job.threads, "Threads; default: as many as this process may use")
      ->transform(whole_number(1, kMostThreads))
      ->type_name("N");
  command
      .add_option("--traversal", options->job.traversal,
                  "How rays go through the hierarchy: auto, the default, measures what is quicker; packet or single")
      ->check(one_of({"auto", "packet", "single"}))
      ->type_name("WAY");
  command.add_option("--isa", options->job.isa, "Use no better instruction set: sse4, avx2 or avx512")
      ->type_name("NAME");
  command
      .add_option("--memory-limit", options->job.memory_limit, "Refuse what needs more, as 8G; default: what is free")
      ->transform(byte_size())
      ->type_name("SIZE");
  add_picture_options(command, *options);
  command.add_option("--progress", options->progress, "auto, bar, alf, openjd, arnold, json or none")
      ->check(one_of(progress_style_names()))
      ->type_name("STYLE");
  command.add_option("--stats", options->job.statistics, "Write what the render did as JSON")->type_name("FILE");
  command.add_flag("-q,--quiet", options->quiet, "Say nothing but errors");
  command.add_flag("-v,--verbose", options->verbose, "Say what was done and how long it took");
  command.footer(
      "Examples:\n"
      "  orrery render scenes/book/final.toml -o final.exr -o final.png\n"
      "  orrery render scene.toml -o test.png --samples 20 --set camera.vfov=30\n"
      "  orrery render scene.toml -o final.exr --noise 0.01 --time 10m\n"
      "  orrery render scene.toml -o book.png --display \"Gamma 2.0 Rec.709\"");
  command.callback([options, &action] { action = [options] { return render(*options); }; });
}

}  // namespace orrery::cli
