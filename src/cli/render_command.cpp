// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "base/atomic_file.h"
#include "base/diagnostic.h"
#include "base/error.h"
#include "base/file_name.h"
#include "base/frames.h"
#include "cli/commands.h"
#include "cli/messages.h"
#include "cli/option_checks.h"
#include "cli/output.h"
#include "cli/progress.h"
#include "cli/render_options.h"
#include "cli/render_report.h"
#include "cli/signals.h"
#include "display/picture_info.h"
#include "film/partial.h"
#include "film/picture.h"
#include "film/rendered_pixels.h"
#include "job/job_report.h"
#include "job/provenance.h"
#include "preview/preview.h"
#include "preview/target.h"
#include "render/progress.h"

namespace orrery::cli {
namespace {

/// --quiet does not suppress progress in an explicit style, which a farm manager parses.
ProgressStyle style_of(const RenderOptions& options) {
  const ProgressStyle style = progress_style(options.progress);
  return options.quiet && style == ProgressStyle::kAuto ? ProgressStyle::kNone : style;
}

/// Parses two integers with a separator.
template <class Number>
std::optional<std::pair<Number, Number>> pair_of(const std::string& text, char separator) {
  const std::size_t at = text.find(separator);
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

void read_shard(const RenderOptions& options, job::Job& job) {
  if (const std::string& text = options.sample_range; !text.empty()) {
    const auto range = pair_of<std::uint32_t>(text, ':');
    if (!range || range->first >= range->second || range->second > std::numeric_limits<std::int32_t>::max())
      base::refuse(fmt::format(
          "--sample-range: `{}` is not a range of samples; write A:B, e.g. 0:100 and 100:200 for two shards", text));
    job.sampling.sample_begin = range->first;
    job.sampling.sample_end = range->second;
  }
  if (options.shard.empty()) return;
  const auto shard = pair_of<int>(options.shard, '/');
  if (!shard || shard->first < 1 || shard->first > shard->second || shard->second > job::kMaxShards)
    base::refuse(
        fmt::format("--shard: `{}` is not a shard; write I/N, e.g. 1/2 and 2/2 for two shards", options.shard));
  job.sampling.shard = {shard->first - 1, shard->second};
  job.as_shard = true;
}

/// Progress of a batch as one render: the samples of all jobs, as if each had the same number.
class BatchProgress {
 public:
  explicit BatchProgress(ProgressPrinter& printer) : printer_(printer) {}

  void begin(std::size_t index, std::size_t count) {
    index_ = index;
    count_ = count;
  }
  void update(const render::Progress& p) {
    if (count_ <= 1) return printer_.update({p.samples_done, p.samples_total, p.seconds, p.goal});
    const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    printer_.update({index_ * p.samples_total + p.samples_done, count_ * p.samples_total, seconds,
                     fmt::format("{} of {}", index_ + 1, count_)});
  }

 private:
  using Clock = std::chrono::steady_clock;
  ProgressPrinter& printer_;
  std::size_t index_ = 0, count_ = 1;
  Clock::time_point start_ = Clock::now();
};

/// Starts a preview and connects the hooks of jobs with it; null and no hooks without one.
///
/// `note`     prints whole lines from any thread
/// Domain     the result outlives the jobs; what `note` refers to outlives the result
std::unique_ptr<preview::Preview> start_preview(const preview::Target& target, preview::OnNote note,
                                                job::Hooks& hooks) {
  std::unique_ptr<preview::Sink> sink = preview::make_sink(target, note);
  if (!sink) return nullptr;
  auto out = std::make_unique<preview::Preview>(std::move(sink), std::move(note));
  preview::Preview* const started = out.get();
  hooks.on_start = [started](const display::PictureInfo& picture) { started->begin(picture); };
  hooks.on_pixels = [started](const film::Partial& state, const film::RenderedPixels& rendered) {
    started->write(state, rendered);
  };
  hooks.on_denoised = [started](const film::Picture& picture) { started->write(picture); };
  hooks.develops_pixels = !target.file.empty();
  return out;
}

/// Prints the summary of a batch. Returns the exit status of the first failure, or 0.
int print_summary(const farm::BatchReport& report, bool quiet) {
  std::string text = fmt::format("{} of {} rendered, {} skipped, {} failed\n", report.rendered, report.jobs,
                                 report.skipped, report.failures.size());
  for (const farm::BatchReport::Failure& failure : report.failures)
    text += fmt::format("failed: {}: {}\n", failure.name, failure.error.what());
  if (!quiet || !report.failures.empty()) print_message(text);
  return report.failures.empty() ? 0 : base::exit_status(report.failures.front().error.kind());
}

}  // namespace

void begin_messages(const RenderOptions& options) {
  if (progress_style(options.progress) == ProgressStyle::kJson) use_json_messages();
}

int run_render(RenderOptions& options) {
  begin_messages(options);
  farm::Batch& batch = options.batch;
  job::Job& job = batch.job;
  for (std::size_t i = 1; i < batch.scenes.size(); ++i)
    if (base::extension(batch.scenes[i]) != ".toml")
      base::refuse(fmt::format("unexpected argument `{}`; name output files with -o", batch.scenes[i].string()));
  job.scene.overrides = options.scene.overrides();
  options.picture.finish(job);
  read_shard(options, job);
  if (!options.frames.empty()) batch.frames = base::parse_frames(options.frames);
  const bool is_many = batch.scenes.size() * std::max<std::size_t>(batch.frames.size(), 1) > 1;
  batch.keep_going = is_many && !options.fail_fast;
  job.hooks.cancel = &stop_on_signals();
  job.hooks.snapshot = &snapshot_request();
  const preview::Target target = options.preview.empty() ? preview::Target() : preview::parse_target(options.preview);
  batch.preview = target.file;
  if (!target.file.empty()) base::check_creatable(target.file);
  ProgressPrinter printer(style_of(options), stderr);
  BatchProgress progress(printer);
  int status = 0;
  job.hooks.on_progress = [&](const render::Progress& p) { progress.update(p); };
  job.hooks.on_build = [&](double fraction) { printer.building(fraction); };
  const auto note = [&](const std::string& text) {  // --quiet messages still go to the log
    options.quiet ? log_message(text) : printer.note(text);
  };
  job.hooks.on_warning = [&](const base::Diagnostic& warning) { note(base::formatted(warning)); };
  if (const std::string unused = options.picture.unused_options(job, options.shows_display || !options.preview.empty());
      !unused.empty())
    note(unused);
  job.hooks.on_note = [&](const std::string& text) { note(text + "\n"); };
  const auto preview = start_preview(target, note, job.hooks);
  batch.on_begin = [&](const job::Job& one, std::size_t index, std::size_t count) {
    progress.begin(index, count);
    log_message(fmt::format("rendering {}\n", farm::job_name(batch, one)));
  };
  batch.on_end = [&](const job::Job& one, const job::JobReport& report) {
    if (!is_many) printer.finish();
    const std::string text = report.was_skipped
                                 ? fmt::format("skipped {}: its files are up to date\n", farm::job_name(batch, one))
                                 : report_text(one, report, {options.verbose, is_many});
    note(text);
    if (report.target_missed.empty()) return;
    if (!options.quiet || options.strict)
      printer.note(options.strict ? fmt::format("orrery: {}\n", report.target_missed)
                                  : base::warning_line(report.target_missed));
    if (options.strict) status = base::exit_status(base::ErrorKind::kStopped);
  };
  batch.on_failure = [&](const job::Job&, const base::Error& error) { printer.note(error_text(error)); };
  const std::vector<job::Job> jobs = farm::jobs_of(batch);
  // Only now is it known that no output is an input.
  if (options.before_files) options.before_files();
  if (!batch.log.empty()) open_log(batch.log);
  const farm::BatchReport report = farm::run_batch(batch, jobs);
  if (preview) preview->end();
  printer.finish();
  if (!is_many) return status;
  const int failed = print_summary(report, options.quiet);
  return failed != 0 ? failed : status;
}

void add_render_options(Command& command, RenderOptions& options) {
  options.picture.add_to(command, options.batch.job);
  options.scene.add_to(command);
  command.add_flag("--skip-existing", options.batch.job.skip_existing,
                   "Skip images that exist, are intact, and match this scene and these settings");
  command.add_flag("--fail-fast", options.fail_fast, "Stop at the first frame or scene that fails");
  command.add_flag("--resume", options.batch.job.checkpoint.resume, "Resume from the checkpoint, if it exists");
  command
      .add_option("--checkpoint", options.batch.job.checkpoint.interval_s,
                  "Checkpoint interval, e.g. 5m; default: only when a signal stops the render")
      ->transform(duration())
      ->type_name("TIME");
  command.add_flag("--keep-checkpoint", options.batch.job.checkpoint.keep,
                   "Keep a checkpoint of the finished render; with --resume, one with more samples continues from it");
  command.add_option("--noise", options.batch.job.sampling.noise, "Target noise (relative display error), e.g. 0.01")
      ->transform(real_number(1e-6, 1))
      ->type_name("X");
  command
      .add_option("--time", options.batch.job.sampling.seconds,
                  "Time budget for adaptive sampling, e.g. 90s, 5m or 1.5h")
      ->transform(duration())
      ->type_name("TIME");
  command.add_flag("--strict", options.strict,
                   "Exit with status 75 if the target noise was not reached or could not be estimated");
  command
      .add_option("-t,--threads", options.batch.job.resources.threads,
                  "Number of threads; default: all CPUs available to the process")
      ->transform(whole_number(1, kMaxThreads))
      ->type_name("N");
  command
      .add_option("--memory-limit", options.batch.job.resources.memory_limit,
                  "Refuse to render if the estimated memory exceeds SIZE, e.g. 8G; default: free memory")
      ->transform(byte_size())
      ->type_name("SIZE");
  command
      .add_option("--progress", options.progress,
                  "Progress format: auto, bar, alf, openjd, arnold, json or none; default: auto")
      ->check(one_of(progress_style_names()))
      ->type_name("STYLE");
  command
      .add_option("--preview", options.preview,
                  "Show the image while it is rendered: tev, tev:HOST:PORT, or a .png file to rewrite")
      ->check([](std::string& text) { return std::string(text.empty() ? "must not be empty" : ""); })
      ->type_name("WHERE");
  command.add_option("--stats", options.batch.job.outputs.statistics, "Write statistics of the render as JSON")
      ->type_name("FILE");
  command.add_option("--log", options.batch.log, "Append all messages to a log file, with timestamps")
      ->type_name("FILE");
  command.add_flag("-q,--quiet", options.quiet, "Print only errors");
  command.add_flag("-v,--verbose", options.verbose, "Also print the time of each phase");
}

void add_render(Command& program, Action& action) {
  const auto options = std::make_shared<RenderOptions>();
  Command& command = *program.add_subcommand("render", "Render a scene to image files");
  command.add_option("SCENE", options->batch.scenes, "Scene file; with several, use {scene} in the names of outputs")
      ->required()
      ->type_name("FILE");
  add_render_options(command, *options);
  command
      .add_option("--sample-range", options->sample_range,
                  "Render a shard: samples A to B-1 of each pixel; combine the shards with orrery merge")
      ->type_name("A:B");
  command
      .add_option("--shard", options->shard,
                  "Render shard I of N (I from 1): every N-th 16 x 16 tile; combine the shards with orrery merge")
      ->type_name("I/N");
  command
      .add_option("--frames", options->frames,
                  "Frames to render, e.g. 1-48, 1-48x2 or 1,3,7-9; name outputs like shot.####.exr")
      ->type_name("RANGE");
  command.footer(
      "Examples:\n"
      "  orrery render scenes/book/final.toml -o final.exr -o final.png\n"
      "  orrery render scene.toml -o test.png --samples 20 --set camera.vfov=30\n"
      "  orrery render scene.toml -o final.exr --noise 0.01 --time 10m\n"
      "  orrery render scene.toml -o final.exr --preview preview.png\n"
      "  orrery render shot.toml -o shot.####.exr --frames 1-240 --resume --skip-existing\n"
      "  orrery render shot.toml -o shard.2.exr --sample-range 100:200\n"
      "  orrery render scene.toml -o book.png --display \"Gamma 2.0 Rec.709\"");
  command.callback([options, &action] { action = [options] { return run_render(*options); }; });
}

}  // namespace orrery::cli
