// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "annotation/legend.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_set.h"
#include "base/frames.h"
#include "base/stop_point.h"
#include "base/stopwatch.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/film.h"
#include "cli/messages.h"
#include "cli/plot_options.h"
#include "cli/render_options.h"
#include "cli/signals.h"
#include "job/batch.h"
#include "job/check_job.h"
#include "job/statistics.h"
#include "load/load_scene.h"
#include "load/read_scene.h"
#include "load/write_scene.h"
#include "plot/plot.h"
#include "plot/settings.h"
#include "preview/preview.h"

namespace orrery::cli {
namespace {

struct PlotCommand {
  RenderOptions render;
  PlotArguments shown;
  std::filesystem::path save_scene, legend;
  bool force = false;
  FilmSettings film;
  bool keep_frames = false;
  std::vector<std::unique_ptr<Film>> films;
};

/// Replaces films among the outputs by their frames, and sets the frames of a turntable.
void prepare_films(PlotCommand& arguments) {
  RenderOptions& render = arguments.render;
  plot::PlotOptions& plot = arguments.shown.options;
  render.picture.rename([&](const std::filesystem::path& file) {
    if (!Film::is_film(file)) return file;
    arguments.films.push_back(std::make_unique<Film>(file, arguments.film.fps, arguments.keep_frames));
    return arguments.films.back()->frame_pattern();
  });
  arguments.film.apply(render.scene, plot);
  if (arguments.films.empty()) return;
  const std::string film = arguments.films.front()->file().string();
  if (plot.frames.empty() && !plot.all_frames)
    base::refuse(
        fmt::format("{} is a film; select its frames with --frames, e.g. --frames all, or --turntable 4s", film));
  if (plot.transparent) base::refuse(fmt::format("--transparent: {} is a film, which is opaque", film));
  render.batch.job.skip_existing = true;  // frames of a stopped command
}

/// Writes the films from their frames.
void write_films(const PlotCommand& arguments) {
  for (const auto& film : arguments.films) {
    film->encode(arguments.render.batch.frames);
    if (!arguments.render.quiet)
      print_message(fmt::format("wrote {}: {} frames, {} frames per second\n", film->file().string(),
                                arguments.render.batch.frames.size(), arguments.film.fps));
  }
}

/// The files that plot writes in addition to those of a render.
std::vector<job::NamedOutput> own_outputs(const PlotCommand& arguments) {
  std::vector<job::NamedOutput> out;
  for (const auto& film : arguments.films) out.push_back({film->file(), "-o"});
  if (!arguments.save_scene.empty()) out.push_back({arguments.save_scene, "--save-scene"});
  if (!arguments.legend.empty()) out.push_back({arguments.legend, "--legend"});
  return out;
}

/// The jobs of these frames, before the data have been read. Checks the names of all files.
std::vector<job::Job> expected_jobs(const PlotCommand& arguments, const std::vector<int>& frames) {
  const plot::PlotOptions& plot = arguments.shown.options;
  job::Batch batch = arguments.render.batch;
  batch.scenes = {plot.file};
  batch.frames = frames;
  batch.others = own_outputs(arguments);
  if (const auto file = preview::preview_file(arguments.render.preview); !file.empty())
    batch.others.push_back({file, "--preview"});
  job::Job& job = batch.job;
  job.scene.text = std::make_shared<const std::string>();
  job.scene.has_file = false;
  job.outputs.display.config = plot::display_of(plot).config;
  job.files = std::make_shared<base::FileSet>();
  for (const int frame : frames.empty() ? std::vector<int>{1} : frames)
    job.files->add_input(base::input_at_frame({}, plot.file.string(), frame), "data file");
  if (plot.points.color.has_map_file()) job.files->add_input(plot.points.color.map, "colour map");
  return job::jobs_of(batch);
}

/// Checks early what would otherwise fail after all frames have been read: names, formats and sizes of outputs, layers,
/// colour names.
void check_request(const PlotCommand& arguments, const std::vector<int>& frames) {
  for (const job::Job& one : expected_jobs(arguments, frames)) job::check_request(one);
  job::Job job = arguments.render.batch.job;
  job.scene.overrides = arguments.shown.options.overrides;
  const scene::Scene settings =
      plot::settings_scene(arguments.shown.options, job.outputs.has_display_format()).read.scene;
  job::check_layers(job, settings);
  const scene::Window window = settings.image.data_window();
  for (const auto& film : arguments.films) film->check_size(window.width, window.height);
}

void print_choices(const plot::PlotScene& made, const PlotCommand& arguments) {
  if (arguments.render.quiet) return;
  std::string text;
  for (const std::string& choice : made.choices) text += fmt::format("plot: {}\n", choice);
  for (const std::string& warning : made.warnings) text += base::warning_line(warning);
  print_message(text);
}

/// The statistics file of the first frame; empty: none.
std::filesystem::path statistics_of(const PlotCommand& arguments) {
  const std::vector<int>& frames = arguments.shown.options.frames;
  return base::with_frame(arguments.render.batch.job.outputs.statistics.string(), frames.empty() ? 1 : frames.front());
}

/// Checks what is known before the data are read, which may take long: the files of the first frame.
void check_outputs(const PlotCommand& arguments) {
  const plot::PlotOptions& plot = arguments.shown.options;
  const bool needs_numbers = plot.all_frames && plot.frames.empty();
  const std::vector<job::Job> jobs =
      expected_jobs(arguments, needs_numbers ? std::vector<int>{load::kFirstFrame} : plot.frames);
  for (const auto& film : arguments.films) film->open_folder();
  job::check_request(jobs.front());
  if (!arguments.save_scene.empty() && !arguments.force) load::check_unedited(arguments.save_scene);
}

/// Reads the data and makes a scene. If that fails or is stopped, writes the statistics.
plot::PlotScene prepare(PlotCommand& arguments) {
  const base::Stopwatch watch;
  job::Job& job = arguments.render.batch.job;
  const base::StopScope scope(job.hooks.cancel);
  try {
    plot::PlotScene made = plot::make_plot(arguments.shown.options,
                                           [&](const std::vector<int>& frames) { check_request(arguments, frames); });
    job.prepare_s = watch.seconds();
    made.choices.push_back(
        fmt::format("prepared in {:.1f} s: read {} to fit the view and the colours", job.prepare_s,
                    made.frames.size() > 1 ? std::to_string(made.frames.size()) + " frames" : "the file"));
    return made;
  } catch (const base::Error& error) {
    job::JobReport report;
    report.phases.prepare_s = watch.seconds();
    if (error.kind() != base::ErrorKind::kUsage) job::write_failure(statistics_of(arguments), report, error);
    throw;
  }
}

int run_plot(PlotCommand& arguments) {
  RenderOptions& render = arguments.render;
  plot::PlotOptions& plot = arguments.shown.options;
  job::Job& job = render.batch.job;
  const bool saves = !arguments.save_scene.empty();
  job.hooks.cancel = &stop_on_signals();
  if (load::is_scene_file(plot.file))
    base::refuse(fmt::format("{0} is a scene; render it: orrery render {0}", base::shell_quoted(plot.file.string())));
  arguments.shown.data.read(plot);
  prepare_films(arguments);
  render.picture.finish(job);
  arguments.shown.read(render.scene, job);
  plot.scene_file = saves ? arguments.save_scene : plot.file;
  plot.develops = job.outputs.has_display_format();
  check_outputs(arguments);
  const plot::PlotScene made = prepare(arguments);
  print_choices(made, arguments);
  const auto text =
      std::make_shared<const std::string>(saves ? load::marked_text(plot::saved_text(plot, made)) : made.text);
  show(made, text, job);
  job.scene.open_data = made.open_data;
  if (!saves) job.scene.typed_lines = 0;
  render.batch.frames = made.frames;
  render.batch.scenes = {plot.scene_file};
  render.batch.others = own_outputs(arguments);
  render.before_files = [&] {
    if (!arguments.legend.empty())
      annotation::write_legend(arguments.legend, made.legend, plot::legend_display(plot, made));
    if (saves) base::write_text_file(arguments.save_scene, *text);
  };
  const int status = run_render(render);
  const base::StopScope scope(job.hooks.cancel);
  if (status == 0) write_films(arguments);
  return status;
}

/// Adds the options of films: -o names one.
void add_film_options(Command& command, PlotCommand& arguments) {
  const OptionGroup group(command, "Film options, for -o FILE.mp4 and FILE.gif");
  command
      .add_option("--turntable", arguments.film.turntable_s, "TIME",
                  "Orbit of the camera in this time, e.g. 4s; alone, of one frame of the file")
      ->transform(duration());
  command.add_option("--fps", arguments.film.fps, "X", "Frames per second; default: 24")->check(real_number(0.1, 1000));
  command.add_flag("--keep-frames", arguments.keep_frames, "Keep the frames, in the folder FILE.frames")
      ->details("They are removed otherwise when the film is complete. A stopped command continues from them.");
}

}  // namespace

void add_plot(Command& program) {
  const auto arguments = std::make_shared<PlotCommand>();
  Command& command = *program.add_subcommand("plot", "Render a particle data file");
  arguments->shown.data.add_to(command, arguments->shown.options);
  arguments->shown.data.add_frames_to(command);
  command.add_option("--legend", arguments->legend, "FILE", "Write a legend of the colours: .svg or .png")
      ->details("Its colours have the display transform of the image. It has at most 500 names.");
  command.add_option("--save-scene", arguments->save_scene, "FILE", "Also write the scene file")
      ->details(
          "A file that was edited, or that orrery did not write, is not replaced. Rendering it with the same --noise, "
          "--time or --samples gives the same pixels.");
  command.add_flag("--force", arguments->force,
                   "Let --save-scene replace a file that was edited, or not written by orrery");
  arguments->shown.add_look_to(command);
  arguments->shown.add_annotations_to(command);
  add_film_options(command, *arguments);
  add_render_options(command, arguments->render);
  command.details(
      "Writes a scene for the data, and renders it. Settings that the options leave open are chosen from the data and "
      "printed: the radius is that of the file, else by chemical element, else half the median distance to the nearest "
      "neighbour in the first frame; the colour is that of the file, else by chain for an assembly, for many atoms and "
      "for atoms of one element, else by element, else by type, else light grey; an orthographic camera is fitted to "
      "the spheres of all frames; the view transform is Neutral, with exact colours Un-tone-mapped, or the "
      "default view if the OpenColorIO config has none of these names; --quality is good, unless --noise, --time "
      "or --samples is given. docs/data.md describes data files.");
  command.footer(
      "Settings without an option are chosen from the data and printed.\n"
      "\n"
      "Examples:\n"
      "  orrery plot melt.dump -o melt.png\n"
      "  orrery plot 1M4X.pdb -o virus.png --assembly 1\n"
      "  orrery plot caffeine.xyz -o caffeine.png --representation ball-and-stick\n"
      "  orrery plot grains.dump -o pour.mp4 --frames all --color-by vz --range -2:0 --color-bar\n"
      "  orrery plot 1M4X.pdb -o turn.mp4 --turntable 4s --scale-bar '20 nm'\n"
      "  orrery plot scan.las -o scan.exr --color-by rgb");
  command.action([arguments] { return run_plot(*arguments); });
}

}  // namespace orrery::cli
