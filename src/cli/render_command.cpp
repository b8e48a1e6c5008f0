// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "base/error.h"
#include "base/frames.h"
#include "base/stopwatch.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/messages.h"
#include "cli/progress.h"
#include "cli/render_options.h"
#include "cli/signals.h"
#include "display/settings.h"
#include "film/picture.h"
#include "film/sums.h"
#include "job/checkpoint.h"
#include "job/run_job.h"
#include "load/read_scene.h"
#include "preview/preview.h"
#include "render/settings.h"

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
  if (at == std::string::npos) return {};
  const auto first = base::number_of<Number>(text.substr(0, at)), second = base::number_of<Number>(text.substr(at + 1));
  if (!first || !second) return {};
  return std::pair{*first, *second};
}

void read_shard(const RenderOptions& options, job::Job& job) {
  if (const std::string& text = options.sample_range; !text.empty()) {
    const auto range = pair_of<std::uint32_t>(text, ':');
    constexpr std::uint32_t kMaxSamples = std::numeric_limits<std::int32_t>::max();
    if (!range || range->first >= range->second || range->second > kMaxSamples)
      base::refuse(
          fmt::format("--sample-range: `{}` is not a range of samples; write A:B, e.g. 0:100 and 100:200 for two "
                      "shards, with A below B and B up to {}",
                      text, kMaxSamples));
    job.settings.sample_begin = range->first;
    job.settings.sample_end = range->second;
  }
  if (options.shard.empty()) return;
  const auto shard = pair_of<int>(options.shard, '/');
  if (!shard || shard->first < 1 || shard->first > shard->second || shard->second > job::kMaxShards)
    base::refuse(
        fmt::format("--shard: `{}` is not a shard; write I/N, e.g. 1/2 and 2/2 for two shards, with I from 1 to "
                    "N and N up to {}",
                    options.shard, job::kMaxShards));
  job.settings.shard = {shard->first - 1, shard->second};
  job.as_shard = true;
}

/// Starts a preview and connects the hooks of jobs with it; null and no hooks without one.
///
/// `note`     prints whole lines from any thread
/// Domain     the result outlives the jobs; what `note` refers to outlives the result
std::unique_ptr<preview::Preview> start_preview(const std::filesystem::path& file, preview::OnNote note,
                                                job::Hooks& hooks) {
  if (file.empty()) return nullptr;
  auto out = std::make_unique<preview::Preview>(file, std::move(note));
  preview::Preview* const started = out.get();
  hooks.on_start = [started](const display::PictureInfo& picture, const auto&) { started->begin(picture); };
  hooks.on_pixels = [started](const film::Sums& state, const film::RenderedPixels& rendered) {
    started->write(state, rendered);
  };
  hooks.on_denoised = [started](const film::Picture& picture) { started->write(picture); };
  hooks.develops_pixels = true;
  return out;
}

void add_bad_values(std::string& out, const job::JobReport& report) {
  const auto warn = [&out](std::uint64_t count, const char* what) {
    if (count > 0) out += base::warning_line(fmt::format("{} {}", count, what));
  };
  warn(report.render.bad_samples, "samples were not finite and were excluded from their pixels");
  for (const auto& [layer, bad] : report.bad_layers) {
    const auto warn_of = [&, &name = layer](std::uint64_t count, const char* what) {
      if (count > 0) out += base::warning_line(fmt::format("{}: {} values are {}", name, count, what));
    };
    warn_of(bad.nan, "not a number");
    warn_of(bad.infinite, "infinite");
    warn_of(bad.negative, "negative");
  }
  if (!report.missing.empty()) out += base::warning_line(fmt::format("{} are missing", report.missing));
  warn(report.written.not_finite, "values that are not finite were written as 0");
  warn(report.written.clamped,
       "values exceed the range of their file and were clamped; EXR with --type float keeps them");
}

void add_summary(std::string& out, const job::Job& job, const job::JobReport& report, ReportDetail detail) {
  std::string files;
  for (const job::ImageFile& output : job.outputs.images) files += (files.empty() ? "" : ", ") + output.path.string();
  const render::Statistics& r = report.render;
  const double per_pixel = static_cast<double>(r.paths) / (static_cast<double>(report.width) * report.height);
  out += fmt::format("wrote {}: {} x {}, {:.5g} {} per pixel in {:.1f} s, {:.2f} M samples/s", files, report.width,
                     report.height, per_pixel, per_pixel == 1 ? "sample" : "samples", r.render_s,
                     r.render_s > 0 ? static_cast<double>(r.paths) / r.render_s / 1e6 : 0.0);
  if (r.noise) out += fmt::format("; noise {:.3g}, {} to {} samples", *r.noise, r.min_samples, r.max_samples);
  if (detail.has_total) out += fmt::format("; {:.1f} s in all", report.phases.total_s());
  out += '\n';
  if (!detail.is_verbose) return;
  if (r.accelerator.empty()) return;  // a merge
  const std::string rods = report.rods > 0 ? ", " + base::counted(report.rods, "rod") : "";
  out += fmt::format("{} spheres{}, {}, {}, traversal {}, {}, {} rays; scene {}\n", report.spheres, rods, r.accelerator,
                     r.isa, r.traversal, base::counted(static_cast<std::uint64_t>(r.threads), "thread"), r.rays,
                     report.scene_hash);
  const job::Phases& p = report.phases;
  if (p.prepare_s > 0) out += fmt::format("prepare {:.3f} s\n", p.prepare_s);
  if (p.denoise_s > 0) out += fmt::format("denoise {:.3f} s\n", p.denoise_s);
  out +=
      fmt::format("read {:.3f} s, compile {:.3f} s, build {:.3f} s, render {:.3f} s, finish {:.3f} s, write {:.3f} s\n",
                  p.read_s, p.compile_s, p.build_s, p.render_s, p.finish_s, p.write_s);
  const display::Choice& display = report.display;
  if (!display.display.empty())
    out += fmt::format("display {}, view {}, OCIO config {}\n", display.display, display.view, display.config);
}

/// Runs the jobs one after another. If one of several fails, prints the error and continues.
///
/// `index`    receives the index of the job that runs
/// Result     the exit status: that of the first failure, or 0
/// Errors     kStopped if a job was stopped; that of a single job
int run_jobs(const std::vector<job::Job>& jobs, const RenderOptions& options, ProgressPrinter& printer,
             std::size_t& index) {
  const bool is_many = jobs.size() > 1;
  const auto name_of = [&](const job::Job& job) {
    const std::string scene = job.scene.file.string();
    return options.batch.frames.empty() ? scene : fmt::format("frame {} of {}", job.scene.frame, scene);
  };
  std::size_t rendered = 0, skipped = 0;
  int status = 0;
  std::string failures;
  for (index = 0; index < jobs.size(); ++index) {
    const job::Job& job = jobs[index];
    try {
      const job::JobReport report = job::run_job(job);
      ++(report.was_skipped ? skipped : rendered);
      if (!is_many) printer.finish();
      const bool misses = report.exit_status != 0;
      if (misses) {
        printer.note(fmt::format("orrery: {}\n", report.target_missed));
        if (status == 0) status = report.exit_status;
      }
      if (options.quiet) continue;
      printer.note(report.was_skipped ? fmt::format("skipped {}: its files are up to date\n", name_of(job))
                                      : report_text(job, report, {options.verbose, is_many}));
      if (!report.target_missed.empty() && !misses) printer.note(base::warning_line(report.target_missed));
    } catch (const base::Error& error) {
      if (!is_many || error.kind() == base::ErrorKind::kStopped) throw;
      printer.note(error_text(error));
      failures += fmt::format("failed: {}: {}\n", name_of(job), error.what());
      if (status == 0) status = base::exit_status(error.kind());
    }
  }
  printer.finish();
  if (is_many && (!options.quiet || status != 0))
    print_message(fmt::format("{} of {} rendered, {} skipped, {} failed\n{}", rendered, jobs.size(), skipped,
                              jobs.size() - rendered - skipped, failures));
  return status;
}

}  // namespace

std::string report_text(const job::Job& job, const job::JobReport& report, ReportDetail detail) {
  std::string out;
  add_bad_values(out, report);
  add_summary(out, job, report, detail);
  return out;
}

int run_render(RenderOptions& options) {
  job::Batch& batch = options.batch;
  job::Job& job = batch.job;
  for (std::size_t i = 1; i < batch.scenes.size(); ++i)
    if (!load::is_scene_file(batch.scenes[i]))
      base::refuse(fmt::format("unexpected argument `{}`; name output files with -o", batch.scenes[i].string()));
  job.scene.overrides = options.scene.overrides();
  options.picture.finish(job);
  read_shard(options, job);
  if (!options.frames.empty()) batch.frames = base::parse_frames(options.frames);
  job.hooks.cancel = &stop_on_signals();
  job.hooks.checkpoint_request = &checkpoint_request();
  const std::filesystem::path shown = preview::preview_file(options.preview);
  if (!shown.empty()) batch.others.push_back({shown, "--preview"});
  ProgressPrinter printer(style_of(options), stderr);
  std::vector<job::Job> jobs;
  std::size_t index = 0;
  const base::Stopwatch watch;
  job.hooks.on_progress = [&](const render::Progress& p) {
    if (jobs.size() <= 1) return printer.update({p.samples_done, p.samples_total, p.seconds, p.goal});
    // A batch is shown as one render, as if all jobs had the same number of samples.
    printer.update({index * p.samples_total + p.samples_done, jobs.size() * p.samples_total, watch.seconds(),
                    fmt::format("{} of {}", index + 1, jobs.size())});
  };
  job.hooks.on_preparation = [&](const char* phase, double fraction) { printer.prepare(phase, fraction); };
  const auto note = [&](const std::string& text) {
    if (!options.quiet) printer.note(text);
  };
  job.hooks.on_warning = [&](const base::Diagnostic& warning) { note(base::formatted(warning)); };
  if (const std::string unused = options.picture.unused_options(job); !unused.empty()) note(unused);
  job.hooks.on_note = [&](const std::string& text) { note(text + "\n"); };
  const auto preview = start_preview(shown, note, job.hooks);
  jobs = job::jobs_of(batch);
  // Only now is it known that no output is an input.
  if (options.before_files) options.before_files();
  return run_jobs(jobs, options, printer, index);
}

void add_sampling_options(Command& command, job::Job& job) {
  command.add_option("--noise", job.settings.noise, "X", "Target noise (relative display error), e.g. 0.01")
      ->details(
          "The root mean square over the pixels of the standard error of the displayed value, relative to that value. "
          "The render ends when an upper estimate of it reaches the target and enough paths have found light "
          "everywhere. Samples go to the pixels where they reduce the noise most. A target that is missed is a "
          "warning, and stated in --stats.")
      ->transform(real_number(1e-6, 1));
  command
      .add_option("--time", job.settings.time_budget_s, "TIME",
                  "Time budget for adaptive sampling, e.g. 90s, 5m or 1.5h")
      ->details(
          "At least 0.01s. It includes reading the scene and building the BVH, but not writing files. The first of "
          "--samples, --noise and --time to be reached ends the render. With --noise or --time, the samples of the "
          "scene file are no limit; those of --samples or --set are.")
      ->transform(duration());
  add_threads_option(command, job.resources.threads);
  command
      .add_option("--memory-limit", job.resources.memory_limit, "SIZE",
                  "Refuse to render if the estimated memory exceeds SIZE, e.g. 8G; default: free memory")
      ->details(
          "The check runs before anything is built; orrery info prints the estimate. Free memory is that of the "
          "machine and of the control group.")
      ->transform(byte_size());
}

void add_render_options(Command& command, RenderOptions& options) {
  options.picture.add_to(command, options.batch.job);
  command.add_option("--deep", options.batch.job.outputs.deep, "FILE",
                     "Also write a deep EXR, with one sample for each sphere in a pixel");
  options.scene.add_to(command);
  command.add_flag("--skip-existing", options.batch.job.skip_existing,
                   "Skip images that exist, are intact, and match this scene and these settings");
  command.add_flag("--resume", options.batch.job.checkpoint.resume, "Resume from the checkpoint, if it exists")
      ->details(
          "The image has the same bits as without the interruption. It can have more samples than the interrupted "
          "render, except with --noise, --time, --denoise, the layer halves and the sampler blue-noise.");
  command
      .add_option("--checkpoint", options.batch.job.checkpoint.interval_s, "TIME",
                  "Checkpoint interval, e.g. 5m; default: only when a signal stops the render")
      ->transform(duration());
  command.add_flag("--keep-checkpoint", options.batch.job.checkpoint.keep,
                   "Keep a checkpoint of the finished render; with --resume, one with more samples continues from it");
  add_sampling_options(command, options.batch.job);
  command.add_flag("--strict", options.batch.job.is_strict,
                   "Exit with status 76 if the target noise was not reached or could not be estimated");
  command
      .add_option("--progress", options.progress, "STYLE",
                  "Progress format: auto, bar, alf, openjd, arnold, json or none; default: auto")
      ->details(
          "auto: bar on a terminal, otherwise arnold with a line for every tenth. bar: one line with a bar, samples "
          "per second and time left. alf: "
          "ALF_PROGRESS 42%. openjd: openjd_progress: 42. arnold: 42% done. json: one object per line; messages are "
          "objects with the key message. A line is printed whenever the whole percent changes, and at least once a "
          "minute.")
      ->choices(progress_style_names());
  command
      .add_option("--preview", options.preview, "FILE",
                  "Show the image while it is rendered, in a .png file that is rewritten every second")
      ->details(
          "The PNG has the display transform of the image. Updates take at most 0.3 % of the processor time of a "
          "render that is not very short, and the image has the same bits. docs/output.md describes what is shown.");
  command.add_option("--stats", options.batch.job.outputs.statistics, "FILE", "Write statistics of the render as JSON")
      ->details("docs/statistics.md lists the keys.");
  command.add_flag("-q,--quiet", options.quiet, "Print only errors");
  command.add_flag("-v,--verbose", options.verbose, "Also print the time of each phase");
}

void add_render(Command& program) {
  const auto options = std::make_shared<RenderOptions>();
  Command& command = *program.add_subcommand("render", "Render a scene to image files");
  command
      .add_option("SCENE", options->batch.scenes, "FILE",
                  "Scene file; with several, use {scene} in the names of outputs")
      ->details("If one of several fails, the error is printed and the others continue.")
      ->required();
  add_render_options(command, *options);
  command.add_option("--sample-range", options->sample_range, "A:B",
                     "Render a shard: samples A to B-1 of each pixel; combine the shards with orrery merge");
  command
      .add_option("--shard", options->shard, "I/N",
                  "Render shard I of N (I from 1): every N-th 16 x 16 tile; combine the shards with orrery merge")
      ->details(
          "It can be combined with --sample-range. The output of a shard is one EXR, which with --denoise also holds "
          "what merge --denoise needs.");
  command
      .add_option("--frames", options->frames, "RANGE",
                  "Frames to render, e.g. 1-48, 1-48x2 or 1,3,7-9; name outputs like shot.####.exr")
      ->details(
          "At most 100000 frames, each from -9999999 to 9999999. The pattern in the names of outputs is #### (one # "
          "per digit, at least two) or %04d. If a frame fails, the error is printed and the others continue.");
  command.details(
      "Before rendering starts, it is checked that the files can be created, that their formats hold an image of that "
      "size, that display and view exist, and that no output is an input or another output; see FILES.");
  command.footer(
      "Examples:\n"
      "  orrery render scenes/book/final.toml -o final.exr -o final.png\n"
      "  orrery render scene.toml -o test.png --samples 20 --set camera.vfov=30\n"
      "  orrery render scene.toml -o final.exr --noise 0.01 --time 10m\n"
      "  orrery render scene.toml -o final.exr --preview preview.png\n"
      "  orrery render shot.toml -o shot.####.exr --frames 1-240 --resume --skip-existing\n"
      "  orrery render shot.toml -o shard.2.exr --sample-range 100:200\n"
      "  orrery render scene.toml -o book.png --set color.display=\"Gamma 2.0 Rec.709\"");
  command.action([options] { return run_render(*options); });
}

}  // namespace orrery::cli
