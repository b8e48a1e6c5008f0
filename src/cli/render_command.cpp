// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "app/job.h"
#include "base/error.h"
#include "base/exit_status.h"
#include "cli/commands.h"
#include "cli/option_checks.h"
#include "cli/picture_options.h"
#include "cli/progress.h"
#include "cli/render_report.h"
#include "cli/scene_options.h"
#include "cli/signals.h"

namespace orrery::cli {
namespace {

/// A part of fewer pixels than this many parts leave is not worth a process.
constexpr int kMostParts = 65536;

struct RenderOptions {
  app::Job job;
  SceneOptions scene;
  PictureOptions picture;
  std::string progress = "auto", tiles;
  bool quiet = false, verbose = false, strict = false;
};

/// Quiet is about what people read; a farm manager that asked for its lines gets them.
ProgressStyle style_of(const RenderOptions& options) {
  const ProgressStyle style = progress_style(options.progress);
  return options.quiet && style == ProgressStyle::kAuto ? ProgressStyle::kNone : style;
}

[[noreturn]] void refuse(const std::string& text) { throw base::Error(base::ErrorKind::kUsage, text); }

/// Two whole numbers with something between them; nothing where they are not.
template <class Number>
std::optional<std::pair<Number, Number>> pair_of(const std::string& text, char between) {
  const std::size_t at = text.find(between);
  std::pair<Number, Number> out;
  const auto parse = [](const char* begin, const char* end, Number& number) {
    const auto [stopped, error] = std::from_chars(begin, end, number);
    return error == std::errc() && stopped == end && begin != end;
  };
  if (at == std::string::npos || !parse(text.data(), text.data() + at, out.first) ||
      !parse(text.data() + at + 1, text.data() + text.size(), out.second))
    return {};
  return out;
}

void read_part(const RenderOptions& options, app::Job& job) {
  if (const auto text = options.scene.sample_range()) {
    const auto range = pair_of<std::uint32_t>(*text, ':');
    if (!range || range->first >= range->second || range->second > std::numeric_limits<std::int32_t>::max())
      refuse("--samples: `" + *text + "` is no range of samples; 0:100 are the first hundred, 100:200 those after them");
    job.sample_begin = range->first;
    job.sample_end = range->second;
  }
  if (options.tiles.empty()) return;
  const auto tiles = pair_of<int>(options.tiles, '/');
  if (!tiles || tiles->first < 1 || tiles->first > tiles->second || tiles->second > kMostParts)
    refuse("--tiles: `" + options.tiles + "` is no part; 1/4, 2/4, 3/4 and 4/4 are the four quarters of a picture");
  job.share = {tiles->first - 1, tiles->second};
}

int render(RenderOptions& options) {
  app::Job& job = options.job;
  job.overrides = options.scene.overrides();
  options.picture.finish(job);
  read_part(options, job);
  job.cancel = &stop_on_signals();
  job.snapshot = &snapshot_on_signal();
  ProgressPrinter printer(style_of(options), stderr);
  job.on_progress = [&](const auto& p) { printer.update({p.samples_done, p.samples_total, p.seconds, p.goal}); };
  job.on_build = [&](double fraction) { printer.building(fraction); };
  job.on_warning = [&](const base::Finding& warning) {
    if (!options.quiet) std::fputs(base::formatted(warning).c_str(), stderr);
  };
  job.on_note = [&](const std::string& text) { printer.note(text); };
  const app::JobReport report = app::run_job(job);
  printer.finish();
  if (!options.quiet) print_report(job, report, options.verbose);
  if (report.target_missed.empty()) return 0;
  if (!options.quiet || options.strict)
    std::fprintf(stderr, "%s: %s\n", options.strict ? "orrery" : "warning", report.target_missed.c_str());
  return options.strict ? base::exit_status(base::ErrorKind::kStopped) : 0;
}

}  // namespace

void add_render(CLI::App& program, Action& action) {
  const auto options = std::make_shared<RenderOptions>();
  CLI::App& command = *program.add_subcommand("render", "Render a scene into one or more picture files");
  command.add_option("SCENE", options->job.scene, "Scene file")->required()->type_name("FILE");
  options->picture.add_to(command, options->job);
  options->scene.add_to(command, true);
  command.add_option("--tiles", options->tiles, "Render only the I-th of N parts of the pixels, as a part")
      ->type_name("I/N");
  command.add_flag("--resume", options->job.resume, "Go on from the checkpoint that a stopped render has left");
  command
      .add_option("--checkpoint", options->job.checkpoint_s,
                  "Write a checkpoint so often, as 5m; one is written anyway when INT or TERM stops the render")
      ->transform(duration())
      ->type_name("TIME");
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
