// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_set.h"
#include "base/frames.h"
#include "cli/commands.h"
#include "cli/messages.h"
#include "cli/option_checks.h"
#include "cli/render_options.h"
#include "job/memory.h"
#include "plot/plot.h"
#include "plot/write_legend.h"

namespace orrery::cli {
namespace {

/// Noise of a plot unless the command line says otherwise.
constexpr double kNoise = 0.02;

struct PlotArguments {
  RenderOptions render;
  plot::PlotOptions plot;
  std::string frame, frames, radius, range, slice, replicate, style = "studio", component;
  std::filesystem::path save_scene, legend;
  const Option* map = nullptr;
};

[[noreturn]] void refuse(const std::string& text) { throw base::Error(base::ErrorKind::kUsage, text); }

/// Parses numbers with a separator: "0:12", "2,2,1".
std::vector<double> numbers_of(const std::string& text, char separator, std::size_t count, const std::string& usage) {
  std::vector<double> out;
  const char *at = text.data(), *const end = at + text.size();
  while (out.size() < count) {
    double value = 0;
    const auto [stop, error] = std::from_chars(at, end, value);
    const bool is_last = out.size() + 1 == count;
    if (error != std::errc() || !std::isfinite(value) || (is_last ? stop != end : stop == end || *stop != separator))
      refuse(usage);
    out.push_back(value);
    at = is_last ? end : stop + 1;
  }
  return out;
}

int integer_of(const std::string& text) {
  int out = 0;
  std::from_chars(text.data(), text.data() + text.size(), out);
  return out;
}

/// The value of an override, such as --width, which the camera must know.
void take_override(const std::vector<format::Override>& overrides, const std::string& key, int& value) {
  for (const format::Override& override : overrides)
    if (override.text.starts_with(key + "=")) value = std::max(1, integer_of(override.text.substr(key.size() + 1)));
}

void read_points(const PlotArguments& arguments, scene::Points& points) {
  if (!arguments.frame.empty()) points.frame = integer_of(arguments.frame);
  if (!arguments.component.empty()) points.component = integer_of(arguments.component);
  if (!arguments.radius.empty()) {
    double value = 0;
    const char* const end = arguments.radius.data() + arguments.radius.size();
    const auto [stop, error] = std::from_chars(arguments.radius.data(), end, value);
    if (error == std::errc() && stop == end) {
      if (!(value > 0) || !std::isfinite(value)) refuse("--radius: must be above 0");
      points.radius.value = value;
    } else {
      points.radius.column = arguments.radius;
    }
  }
  if (!arguments.range.empty()) {
    const auto ends = numbers_of(arguments.range, ':', 2,
                                 "--range: `" + arguments.range + "` is not a range; write LOW:HIGH, e.g. 0:12");
    if (!(ends[0] < ends[1])) refuse("--range: the first number must be less than the second");
    points.color.range = scene::Interval{ends[0], ends[1]};
  }
  if (!arguments.replicate.empty()) {
    const auto counts =
        numbers_of(arguments.replicate, ',', 3,
                   "--replicate: `" + arguments.replicate + "` must be three numbers of copies, e.g. 2,2,1");
    points.replicate = {counts[0], counts[1], counts[2]};
  }
}

void read_slice(const std::string& text, plot::PlotOptions& plot) {
  if (text.empty()) return;
  const std::string usage = "--slice: `" + text + "` is not a plane; write AXIS=PLACE, e.g. z=10";
  if (text.size() < 3 || text[0] < 'x' || text[0] > 'z' || text[1] != '=') refuse(usage);
  plot.slice = std::pair{text[0] - 'x', numbers_of(text.substr(2), '=', 1, usage)[0]};
}

void print_choices(const plot::PlotScene& made, const PlotArguments& arguments) {
  if (arguments.render.quiet) return;
  std::string text;
  for (const std::string& choice : made.choices) text += "plot: " + choice + "\n";
  print_message(text);
}

/// Checks the files that plot itself writes, before anything is read.
void check_own_outputs(const PlotArguments& arguments) {
  base::FileSet files;
  files.add_input(arguments.plot.file, "data file");
  const auto add = [&](const std::filesystem::path& file, const char* option) {
    if (file.empty()) return;
    files.add_output(file, option);
    base::check_creatable(file);
  };
  add(arguments.save_scene, "--save-scene");
  add(arguments.legend, "--legend");
  for (const job::ImageFile& image : arguments.render.batch.job.outputs.images) files.add_output(image.path, "-o");
}

int run_plot(PlotArguments& arguments) {
  RenderOptions& render = arguments.render;
  plot::PlotOptions& plot = arguments.plot;
  const std::vector<format::Override> overrides = render.scene.overrides();
  take_override(overrides, "image.width", plot.width);
  take_override(overrides, "image.height", plot.height);
  plot.all_frames = arguments.frames == "all";
  if (!arguments.frames.empty() && !plot.all_frames) plot.frames = base::parse_frames(arguments.frames);
  if (!arguments.frames.empty() && !arguments.frame.empty()) refuse("--frame and --frames exclude each other");
  plot.style = arguments.style == "flat"    ? plot::Style::kFlat
               : arguments.style == "night" ? plot::Style::kNight
                                            : plot::Style::kStudio;
  plot.has_map = arguments.map->count() > 0;
  plot.memory_limit = render.batch.job.resources.memory_limit > 0 ? render.batch.job.resources.memory_limit
                                                                  : job::available_memory().value_or(0);
  read_points(arguments, plot.points);
  read_slice(arguments.slice, plot);
  const bool saves = !arguments.save_scene.empty();
  render.picture.finish(render.batch.job);
  check_own_outputs(arguments);
  const plot::PlotScene made =
      plot::make_plot(plot, saves ? arguments.save_scene.parent_path() : plot.file.parent_path());
  render.batch.frames = made.frames;
  job::Job& job = render.batch.job;
  const bool has_samples = std::any_of(overrides.begin(), overrides.end(),
                                       [](const auto& o) { return o.text.starts_with("render.samples="); });
  if (!job.sampling.noise && !job.sampling.seconds && !has_samples && plot.style != plot::Style::kFlat)
    job.sampling.noise = kNoise;
  print_choices(made, arguments);
  if (!arguments.legend.empty()) {
    display::Settings display = job.outputs.display;
    if (display.view.empty()) display.view = "Un-tone-mapped";
    plot::write_legend(arguments.legend, made.points, display);
  }
  if (saves) {
    base::write_text_file(arguments.save_scene, made.text);
    render.batch.scenes = {arguments.save_scene};
  } else {
    job.scene.text = std::make_shared<const std::string>(made.text);
    render.batch.scenes = {plot.file};
  }
  return run_render(render);
}

void add_data_options(Command& command, const std::shared_ptr<PlotArguments>& arguments) {
  const OptionGroup group(command, "Data options");
  scene::Points& points = arguments->plot.points;
  command.add_option("--frame", arguments->frame, "Frame of the file, from 1; default: 1")
      ->check(whole_number(1, 2'000'000'000))
      ->type_name("N");
  command
      .add_option("--frames", arguments->frames, "Frames to render: all, or e.g. 1-48; name outputs like pour.####.png")
      ->type_name("RANGE");
  command.add_option("--select", points.select, "Plot only rows that match, e.g. 'type == 2 && z > 0'")
      ->type_name("CONDITION");
  command.add_option("--slice", arguments->slice, "Cut open at a plane: remove the spheres before it, e.g. z=10")
      ->type_name("AXIS=PLACE");
  command.add_option("--component", arguments->component, "HDF5: particle type, N of PartTypeN")
      ->check(whole_number(0, 1000))
      ->type_name("N");
  command.add_option("--assembly", points.assembly, "PDB, mmCIF: plot a biological assembly, e.g. 1")
      ->type_name("NAME");
  command.add_option("--replicate", arguments->replicate, "Copies of the periodic box along its edges, e.g. 2,2,1")
      ->type_name("A,B,C");
  command.add_flag("--unwrap", points.unwrap, "Undo periodic wrapping by the file's image counts");
  command.add_flag("--skip-bad", points.skip_bad, "Leave out rows whose coordinates are not finite numbers");
}

void add_look_options(Command& command, const std::shared_ptr<PlotArguments>& arguments) {
  const OptionGroup group(command, "Look options");
  scene::Points& points = arguments->plot.points;
  command.add_option("--radius", arguments->radius, "Radius: a number, or a column of radii; default: from the file")
      ->type_name("X|COLUMN");
  command
      .add_option("--radius-scale", points.radius.scale,
                  "Factor for radii by column or element, e.g. 0.5 for diameters")
      ->check(real_number(1e-30, 1e30))
      ->type_name("X");
  command.add_option("--element-radii", points.radius.element, "Radii of the chemical elements: vdw, covalent or ball")
      ->check(one_of({"vdw", "covalent", "ball"}))
      ->type_name("TABLE");
  command
      .add_option("--color-by", arguments->plot.color_by,
                  "Colour by a column, or by element, type or rgb; none: one colour; default: from the file")
      ->type_name("COLUMN");
  arguments->map = command.add_option("--map", points.color.map, "Colour map, e.g. viridis, fast, coolwarm, or a file")
                       ->type_name("MAP");
  command.add_option("--range", arguments->range, "Values at both ends of the colour map; default: all values")
      ->type_name("LOW:HIGH");
  command
      .add_option("--look-from", arguments->plot.look_from,
                  "View: iso, +x, -x, +y, -y, +z, -z, or azimuth and elevation in degrees, e.g. 30,20; default: iso")
      ->type_name("VIEW");
  command.add_option("--up", arguments->plot.up, "Axis that points up in the image; default: z, for molecules y")
      ->check(one_of({"x", "y", "z"}))
      ->type_name("AXIS");
  command.add_option("--style", arguments->style, "Look: studio, flat (no shading) or night; default: studio")
      ->check(one_of({"studio", "flat", "night"}))
      ->type_name("STYLE");
  command.add_flag("--ground", arguments->plot.ground, "Add a ground that receives shadows");
}

}  // namespace

void add_plot(Command& program, Action& action) {
  const auto arguments = std::make_shared<PlotArguments>();
  Command& command = *program.add_subcommand("plot", "Render a particle data file");
  command
      .add_option("FILE", arguments->plot.file,
                  "Data file: LAMMPS, XYZ, PDB, mmCIF, PLY, CSV, NPY, LAS, GSD, HDF5, VTK")
      ->required()
      ->type_name("FILE");
  command.add_option("--legend", arguments->legend, "Write a legend of the colours: .svg, or .png for the bar alone")
      ->type_name("FILE");
  command.add_option("--save-scene", arguments->save_scene, "Also write the scene file")->type_name("FILE");
  add_data_options(command, arguments);
  add_look_options(command, arguments);
  add_render_options(command, arguments->render, false);
  command.footer(
      "What is not given is chosen from the data, and printed.\n"
      "\n"
      "Examples:\n"
      "  orrery plot melt.dump -o melt.png\n"
      "  orrery plot 1m4x.pdb -o virus.png --assembly 1\n"
      "  orrery plot grains.dump -o pour.####.png --frames all --color-by vz --range -2:0\n"
      "  orrery plot scan.las -o scan.exr --color-by rgb");
  command.callback([arguments, &action] { action = [arguments] { return run_plot(*arguments); }; });
}

}  // namespace orrery::cli
