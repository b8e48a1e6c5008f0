// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "annotation/legend.h"
#include "base/atomic_file.h"
#include "base/available_memory.h"
#include "base/error.h"
#include "base/file_name.h"
#include "base/file_set.h"
#include "base/frames.h"
#include "base/image_limits.h"
#include "base/stop_point.h"
#include "cli/commands.h"
#include "cli/film.h"
#include "cli/messages.h"
#include "cli/render_options.h"
#include "cli/signals.h"
#include "format/write_scene.h"
#include "image/library.h"
#include "job/check_job.h"
#include "job/job.h"
#include "job/statistics.h"
#include "load/load_scene.h"
#include "load/scene_files.h"
#include "plot/plot.h"
#include "preview/preview.h"
#include "scene/limits.h"

namespace orrery::cli {
namespace {

struct PlotArguments {
  RenderOptions render;
  plot::PlotOptions plot;
  DataArguments data;
  LookArguments look;
  std::filesystem::path save_scene, legend;
  bool force = false;
  FilmSettings film;
  bool keep_frames = false;
  std::vector<std::unique_ptr<Film>> films;
};

/// Replaces films among the outputs by their frames, and sets the frames of a turntable.
void prepare_films(PlotArguments& arguments) {
  RenderOptions& render = arguments.render;
  plot::PlotOptions& plot = arguments.plot;
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
void write_films(const PlotArguments& arguments) {
  for (const auto& film : arguments.films) {
    film->encode(arguments.render.batch.frames);
    if (!arguments.render.quiet)
      print_message(fmt::format("wrote {}: {} frames, {} frames per second\n", film->file().string(),
                                arguments.render.batch.frames.size(), arguments.film.fps));
  }
}

/// The files that plot writes in addition to those of a render.
std::vector<job::OutputFile> own_outputs(const PlotArguments& arguments) {
  std::vector<job::OutputFile> out;
  if (!arguments.save_scene.empty()) out.push_back({arguments.save_scene, "--save-scene"});
  if (!arguments.legend.empty()) out.push_back({arguments.legend, "--legend"});
  return out;
}

/// The PNG of --preview; empty: none.
std::filesystem::path preview_file(const PlotArguments& arguments) {
  return preview::parse_target(arguments.render.preview).file;
}

/// Checks early what would otherwise fail after all frames have been read: names and formats of outputs, layers, colour
/// names.
void check_request(const PlotArguments& arguments, const std::vector<int>& frames) {
  job::Batch batch = arguments.render.batch;
  batch.scenes = {arguments.plot.file};
  batch.frames = frames;
  batch.others = own_outputs(arguments);
  if (const auto file = preview_file(arguments); !file.empty()) batch.others.push_back({file, "--preview"});
  job::Job& job = batch.job;
  job.scene.text = std::make_shared<const std::string>();
  job.scene.has_file = false;
  for (const job::Job& one : job::jobs_of(batch)) job::check_request(one);
  job.scene.overrides = arguments.plot.overrides;
  job::check_layers(job, plot::settings_of(arguments.plot, job.outputs.has_display_format()).read.scene);
  image::load();
}

void print_choices(const plot::PlotScene& made, const PlotArguments& arguments) {
  if (arguments.render.quiet) return;
  std::string text;
  for (const std::string& choice : made.choices) text += fmt::format("plot: {}\n", choice);
  for (const std::string& warning : made.warnings) text += base::warning_line(warning);
  print_message(text);
}

/// The statistics file of the first frame; empty: none.
std::filesystem::path statistics_of(const PlotArguments& arguments) {
  const std::vector<int>& frames = arguments.plot.frames;
  return base::with_frame(arguments.render.batch.job.outputs.statistics.string(), frames.empty() ? 1 : frames.front());
}

/// Checks the names that are known before the data are read, which may take long. run_render() checks all names.
void check_outputs(const PlotArguments& arguments) {
  const plot::PlotOptions& plot = arguments.plot;
  base::FileSet files;
  for (const int frame : plot.frames.empty() ? std::vector<int>{1} : plot.frames)
    files.add_input(base::input_at_frame({}, plot.file.string(), frame), "data file");
  if (plot.points.color.has_map_file()) files.add_input(plot.points.color.map, "colour map");
  load::add_ocio_configs(plot::display_of(plot).config, files);
  for (const job::OutputFile& output : own_outputs(arguments)) {
    files.add_output(output.path, output.role);
    base::check_creatable(output.path);
  }
  if (!arguments.save_scene.empty() && !arguments.force) format::check_unedited(arguments.save_scene);
  if (const std::filesystem::path stats = statistics_of(arguments); !stats.empty()) {
    files.add_output(stats, "--stats");
    base::check_creatable(stats);
  }
  if (const auto file = preview_file(arguments); !file.empty()) files.add_output(file, "--preview");
  for (const job::ImageFile& image : arguments.render.batch.job.outputs.images) files.add_output(image.path, "-o");
}

/// Reads the data and makes a scene. If that fails or is stopped, writes the statistics.
plot::PlotScene prepare(const PlotArguments& arguments) {
  const auto begin = std::chrono::steady_clock::now();
  const base::StopScope scope(arguments.render.batch.job.hooks.cancel);
  try {
    return plot::make_plot(arguments.plot, [&](const std::vector<int>& frames) { check_request(arguments, frames); });
  } catch (const base::Error& error) {
    job::JobReport report;
    report.phases.prepare_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (error.kind() != base::ErrorKind::kUsage) job::write_failure(statistics_of(arguments), report, error);
    throw;
  }
}

int run_plot(PlotArguments& arguments) {
  begin_messages(arguments.render);
  arguments.render.batch.job.hooks.cancel = &stop_on_signals();
  if (base::extension(arguments.plot.file) == ".toml")
    base::refuse(fmt::format("{} is a scene; render it: orrery render {}", arguments.plot.file.string(),
                             arguments.plot.file.string()));
  RenderOptions& render = arguments.render;
  plot::PlotOptions& plot = arguments.plot;
  job::Job& job = render.batch.job;
  const bool saves = !arguments.save_scene.empty();
  read_data_options(arguments.data, plot);
  prepare_films(arguments);
  render.picture.finish(job);
  read_look_options(arguments.look, plot);
  plot.overrides = render.scene.overrides();
  plot.scene_file = saves ? arguments.save_scene : plot.file;
  plot.has_target = job.sampling.noise || job.sampling.seconds;
  plot.develops = job.outputs.has_display_format();
  plot.memory_limit =
      job.resources.memory_limit > 0 ? job.resources.memory_limit : base::available_memory().value_or(0);
  check_outputs(arguments);
  image::start_loading();
  const auto begin = std::chrono::steady_clock::now();
  plot::PlotScene made = prepare(arguments);
  job.prepare_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (made.noise) job.sampling.noise = *made.noise;
  job.denoise = job.denoise || (made.denoise && job.outputs.deep.empty());
  made.choices.push_back(
      fmt::format("prepared in {:.1f} s: read {} to fit the view and the colours", job.prepare_s,
                  made.frames.size() > 1 ? std::to_string(made.frames.size()) + " frames" : "the file"));
  print_choices(made, arguments);
  const auto text =
      std::make_shared<const std::string>(saves ? format::marked_text(plot::saved_text(plot, made)) : made.text);
  job.scene.text = text;
  job.scene.open_data = made.open_data;
  if (!saves) job.scene.typed_lines = 0;
  job.scene.has_file = false;
  render.batch.frames = made.frames;
  render.batch.scenes = {plot.scene_file};
  render.batch.others = own_outputs(arguments);
  render.before_files = [&] {
    if (!arguments.legend.empty()) {
      display::Settings display = plot::settings_of(plot, true).display;
      display.view = made.view;
      annotation::write_legend(arguments.legend, made.legend, display);
    }
    if (saves) base::write_text_file(arguments.save_scene, *text);
  };
  const int status = run_render(render);
  if (status == 0) write_films(arguments);
  return status;
}

}  // namespace

namespace {

/// Adds the options of the camera.
void add_view_options(Command& command, plot::PlotOptions& plot) {
  const OptionGroup group(command, kViewOptions);
  command
      .add_option("--look-from", plot.look_from, "VIEW",
                  "View: iso, +x, -x, +y, -y, +z, -z, or azimuth and elevation in degrees, e.g. 30,20; default: iso")
      ->details("iso: from 45 degrees to the right of the front and 35.26 degrees above.");
  command.add_option("--zoom", plot.zoom, "X", "Magnification, relative to the view that shows all; default: 1")
      ->check(real_number(1e-3, 1e6));
  command.add_option("--center", plot.center, "CONDITION",
                     "Look at the middle of the particles that match, e.g. 'residue == \"HEM\"'");
  command
      .add_option("--perspective", plot.vfov_deg, "VFOV",
                  "Perspective camera with this vertical field of view in degrees, e.g. 30; default: orthographic")
      ->check(real_number(0.1, 170));
  command.add_option("--up", plot.up, "AXIS", "Axis that points up in the image; default: z, y for PDB and mmCIF")
      ->choices({"x", "y", "z"});
}

}  // namespace

void add_look_options(Command& command, DataArguments& data, plot::PlotOptions& plot, LookArguments& look) {
  add_view_options(command, plot);
  const OptionGroup group(command, kLookOptions);
  command
      .add_option("--representation", look.representation, "KIND",
                  "Particles as spheres, ball-and-stick or sticks, the latter two with bonds; default: spheres")
      ->details(
          "ball-and-stick: a quarter of the van der Waals radii, or without elements half the default radius. sticks: "
          "spheres have the radius of the bonds.")
      ->choices(plot::representation_names());
  command
      .add_option(
          "--bonds", look.bonds, "SOURCE",
          "Draw bonds: auto, file, distance, both, a factor of the covalent radii such as 1.2, or length=X; none")
      ->details(
          "auto: those of the file; by distance if it has none; both for PDB and mmCIF, which leave out common bonds. "
          "A factor or a length: by distance. docs/data.md describes bonds.");
  command.add_option("--vectors", look.vectors, "X,Y,Z", "Draw arrows from three columns, e.g. vx,vy,vz")
      ->details("Their length is chosen from the data; --set 'points[0].vectors.scale=2' sets it.");
  command
      .add_option("--opacity", data.opacity, "X|COLUMN|CONDITION:X",
                  "Opacity, 0 to 1: of all, from a column, or of those that match, e.g. 'type == 2: 0.3'; can be "
                  "repeated")
      ->details("The last that matches a particle decides; particles that none matches are opaque.")
      ->repeatable();
  command.add_option("--style", look.style, "STYLE", "Light: studio, soft, flat, night or ambient; default: studio")
      ->details(
          "studio: a key light from the upper left of the camera, and white light from all directions. soft: more of "
          "the latter. flat: no shading. night: a lamp and a dark sky. ambient: white light from all directions alone.")
      ->choices(plot::style_names());
  command.add_option("--background", look.background, "COLOR",
                     "Colour behind the spheres: white, black, grey or #rrggbb; default: that of the style");
  command.add_flag("--transparent", plot.transparent, "Transparent background, in EXR, PNG and TIFF");
  command
      .add_option("--quality", look.quality, "NAME",
                  "draft (--samples 8 --denoise), good (--noise 0.1 --denoise) or final (--noise 0.02); default: good")
      ->choices(plot::quality_names());
  command
      .add_option("--material", plot.material, "MATERIAL",
                  "Material of the spheres: matte, plastic, metal or glass; default: matte")
      ->details("plastic: matte with a soft highlight. metal: brushed. glass: clear, without colours.")
      ->choices(plot::material_names());
  command.add_flag("--allow-empty", plot.allow_empty,
                   "Render the background alone if --select or --slice leaves nothing; default: an error");
  command.add_flag("--ground", plot.ground, "Add a ground that receives shadows");
  command.add_flag("--box", plot.box, "Draw the edges of the simulation box");
  command.add_flag("--axes", plot.axes, "Draw the directions of x (red), y (green) and z (blue)");
}

namespace {

/// Parses "auto", "20" or "20 nm".
void read_scale_bar(const std::string& text, scene::Annotation& annotation) {
  if (text.empty()) return;
  double length = 0;
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, length);
  if (text != "auto" && (error != std::errc() || !(length >= scene::kSmallestRadius) ||
                         !(length <= scene::kLargestLength) || (stopped != end && *stopped != ' ')))
    base::refuse(
        fmt::format("--scale-bar: `{}` is not a length; write auto, or a length above 0, with a space before "
                    "the unit, e.g. 20 or '20 nm'",
                    text));
  annotation.scale_bar = length;
  if (text != "auto" && stopped != end) annotation.unit = std::string(stopped + 1, end);
}

}  // namespace

void read_look_options(const LookArguments& look, plot::PlotOptions& plot) {
  plot.style = plot::style_of(look.style);
  plot.quality = plot::quality_of(look.quality);
  if (!look.background.empty()) plot.background = plot::color_of(look.background);
  if (!look.representation.empty()) {
    const std::vector<std::string>& names = plot::representation_names();
    plot.representation =
        static_cast<plot::Representation>(std::find(names.begin(), names.end(), look.representation) - names.begin());
  }
  std::istringstream columns(look.vectors);
  for (std::string column; std::getline(columns, column, ',');) plot.points.vectors.columns.push_back(column);
  read_scale_bar(look.scale_bar, plot.annotation);
  if (look.bonds.empty()) return;
  scene::PointsBonds& bonds = plot.points.bonds;
  plot.bonds = look.bonds != "none";
  if (look.bonds == "none" || look.bonds == "auto") return;
  if (look.bonds == "file" || look.bonds == "distance" || look.bonds == "both") {
    bonds.from = look.bonds;
    return;
  }
  constexpr std::string_view kLength = "length=";
  const bool is_length = look.bonds.starts_with(kLength);
  const std::string_view text = std::string_view(look.bonds).substr(is_length ? kLength.size() : 0);
  double number = 0;
  const auto [stopped, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const double largest = is_length ? scene::kLargestLength : scene::kLargestBondFactor;
  if (error != std::errc() || stopped != text.data() + text.size() || !(number >= scene::kSmallestRadius) ||
      !(number <= largest))
    base::refuse(
        fmt::format("--bonds: `{}` is not a source of bonds; write auto, file, distance, both, none, a factor "
                    "such as 1.2, or length=1.6",
                    look.bonds));
  (is_length ? bonds.length : bonds.factor) = number;
}

namespace {

/// Adds the options of films: -o names one.
void add_film_options(Command& command, PlotArguments& arguments) {
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

void add_annotation_options(Command& command, plot::PlotOptions& plot, LookArguments& look) {
  const OptionGroup group(command, kAnnotationOptions);
  scene::Annotation& annotation = plot.annotation;
  command.add_option("--title", annotation.title, "TEXT", "Text at the top left, e.g. 't = {step * 0.005:.1f} ps'")
      ->details(
          "{EXPRESSION} is the value of an expression of frame and step, the time step in the data file, with a format "
          "after a colon.");
  command.add_option("--scale-bar", look.scale_bar, "LENGTH",
                     "Scale bar: auto, or a length, with a unit to be shown, e.g. '20 nm'; not with --perspective");
  command.add_flag("--color-bar", annotation.color_bar, "Legend of the colours in the image");
  command
      .add_option("--label", plot.points.labels, "CONDITION: TEXT",
                  "Label the middle of the particles that match, e.g. 'id == 5: Fe'; can be repeated")
      ->repeatable();
  command.add_option("--outline", annotation.outline, "PX", "Width of the outlines of objects in pixels, e.g. 2")
      ->check(real_number(0, scene::kWidestOutline));
  command.add_option("--font", annotation.font, "FONT", "Name or file of the font; default: DejaVuSans");
}

void add_plot(Command& program) {
  const auto arguments = std::make_shared<PlotArguments>();
  Command& command = *program.add_subcommand("plot", "Render a particle data file");
  add_data_options(command, arguments->data, arguments->plot);
  command.add_option("--legend", arguments->legend, "FILE", "Write a legend of the colours: .svg or .png")
      ->details("Its colours have the display transform of the image. It has at most 500 names.");
  command.add_option("--save-scene", arguments->save_scene, "FILE", "Also write the scene file")
      ->details(
          "A file that was edited, or that orrery did not write, is not replaced. Rendering it with the same --noise, "
          "--time or --samples gives the same pixels.");
  command.add_flag("--force", arguments->force,
                   "Let --save-scene replace a file that was edited, or not written by orrery");
  add_look_options(command, arguments->data, arguments->plot, arguments->look);
  add_annotation_options(command, arguments->plot, arguments->look);
  add_film_options(command, *arguments);
  add_render_options(command, arguments->render);
  command.details(
      "Writes a scene for the data, and renders it. Settings that the options leave open are chosen from the data and "
      "printed: the radius is that of the file, else by chemical element, else half the median distance to the nearest "
      "neighbour in the first frame; the colour is that of the file, else by element, else by type, else light grey; "
      "an orthographic camera is fitted to the spheres of all frames; the view transform is Un-tone-mapped, or the "
      "default view if the OpenColorIO config has none of this name; --quality is good, unless --noise, --time "
      "or --samples is given. docs/data.md describes data files.");
  command.footer(
      "Settings without an option are chosen from the data and printed.\n"
      "\n"
      "Examples:\n"
      "  orrery plot melt.dump -o melt.png\n"
      "  orrery plot 1m4x.pdb -o virus.png --assembly 1\n"
      "  orrery plot caffeine.xyz -o caffeine.png --representation ball-and-stick\n"
      "  orrery plot grains.dump -o pour.mp4 --frames all --color-by vz --range -2:0 --color-bar\n"
      "  orrery plot 1m4x.pdb -o turn.mp4 --turntable 4s --scale-bar '20 nm'\n"
      "  orrery plot scan.las -o scan.exr --color-by rgb");
  command.action([arguments] { return run_plot(*arguments); });
}

}  // namespace orrery::cli
