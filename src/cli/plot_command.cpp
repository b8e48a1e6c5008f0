// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/file_set.h"
#include "base/output_file.h"
#include "cli/commands.h"
#include "cli/data_options.h"
#include "cli/messages.h"
#include "cli/option_checks.h"
#include "cli/render_options.h"
#include "format/write_tree.h"
#include "job/memory.h"
#include "plot/plot.h"
#include "plot/write_legend.h"
#include "preview/target.h"
#include "scene/value_text.h"

namespace orrery::cli {
namespace {

/// Noise of a plot unless the command line says otherwise.
constexpr double kNoise = 0.02;

struct PlotArguments {
  RenderOptions render;
  plot::PlotOptions plot;
  DataArguments data;
  std::string style = "studio";
  std::filesystem::path save_scene, legend;
};

/// The value of an override, such as --width, which the camera must know.
void take_override(const std::vector<format::Override>& overrides, const std::string& key, int& value) {
  for (const format::Override& override : overrides)
    if (override.text.starts_with(key + "=")) value = std::max(1, integer_of(override.text.substr(key.size() + 1)));
}

void print_choices(const plot::PlotScene& made, const PlotArguments& arguments) {
  if (arguments.render.quiet) return;
  std::string text;
  for (const std::string& choice : made.choices) text += "plot: " + choice + "\n";
  for (const std::string& warning : made.warnings) text += "warning: " + warning + "\n";
  print_message(text);
}

/// The scene with the settings of the command line, so that rendering it needs none of them again.
std::string saved_text(const std::string& text, std::vector<format::Override> settings,
                       const display::Settings& display) {
  // make_plot() has these two.
  std::erase_if(settings, [](const format::Override& setting) {
    return setting.text.starts_with("image.width=") || setting.text.starts_with("image.height=");
  });
  const auto set = [&](const char* key, const std::string& value) {
    if (!value.empty()) settings.push_back({std::string("color.") + key + "=" + scene::string_text(value)});
  };
  if (!display.config.empty()) set("config", std::filesystem::absolute(display.config).string());
  set("display", display.display);
  set("view", display.view);
  set("look", display.look);
  if (display.exposure) settings.push_back({"color.exposure=" + scene::number_text(*display.exposure)});
  if (settings.empty()) return text;
  const auto same = [](const std::string& file) { return file; };
  return text.substr(0, text.find('\n')) + "\n\n" + format::merged_text("plot", text, settings, same);
}

/// Checks the files that plot itself writes, before anything is read.
void check_own_outputs(const PlotArguments& arguments) {
  base::FileSet files;
  files.add_input(arguments.plot.file, "data file");
  const scene::PointsColor& color = arguments.plot.points.color;
  if (color.has_map_file()) files.add_input(color.map, "colour map");
  const auto add = [&](const std::filesystem::path& file, const char* option) {
    if (file.empty()) return;
    files.add_output(file, option);
    base::check_creatable(file);
  };
  add(arguments.save_scene, "--save-scene");
  add(arguments.legend, "--legend");
  if (!arguments.render.preview.empty()) add(preview::parse_target(arguments.render.preview).file, "--preview");
  for (const job::ImageFile& image : arguments.render.batch.job.outputs.images) files.add_output(image.path, "-o");
}

int run_plot(PlotArguments& arguments) {
  RenderOptions& render = arguments.render;
  plot::PlotOptions& plot = arguments.plot;
  const std::vector<format::Override> overrides = render.scene.overrides();
  take_override(overrides, "image.width", plot.width);
  take_override(overrides, "image.height", plot.height);
  read_data_options(arguments.data, plot);
  plot.style = arguments.style == "flat"    ? plot::Style::kFlat
               : arguments.style == "night" ? plot::Style::kNight
                                            : plot::Style::kStudio;
  plot.memory_limit = render.batch.job.resources.memory_limit > 0 ? render.batch.job.resources.memory_limit
                                                                  : job::available_memory().value_or(0);
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
  render.shows_display = !arguments.legend.empty() || saves;
  if (!arguments.legend.empty()) {
    display::Settings display = job.outputs.display;
    if (display.view.empty()) display.view = "Un-tone-mapped";
    plot::write_legend(arguments.legend, made.legend, display);
  }
  if (saves) {
    base::write_text_file(arguments.save_scene, saved_text(made.text, overrides, job.outputs.display));
    render.batch.scenes = {arguments.save_scene};
  } else {
    job.scene.text = std::make_shared<const std::string>(made.text);
    job.scene.is_generated = true;
    job.scene.has_file = false;
    render.batch.scenes = {plot.file};
  }
  return run_render(render);
}

void add_view_options(Command& command, const std::shared_ptr<PlotArguments>& arguments) {
  const OptionGroup group(command, "Look options");
  command
      .add_option("--look-from", arguments->plot.look_from,
                  "View: iso, +x, -x, +y, -y, +z, -z, or azimuth and elevation in degrees, e.g. 30,20; default: iso")
      ->type_name("VIEW");
  command.add_option("--up", arguments->plot.up, "Axis that points up in the image; default: z, y for PDB and mmCIF")
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
  add_data_file(command, arguments->plot);
  command.add_option("--legend", arguments->legend, "Write a legend of the colours: .svg, or .png for the bar alone")
      ->type_name("FILE");
  command.add_option("--save-scene", arguments->save_scene, "Also write the scene file")->type_name("FILE");
  add_data_options(command, arguments->data, arguments->plot);
  add_look_options(command, arguments->data, arguments->plot);
  add_view_options(command, arguments);
  add_render_options(command, arguments->render, false);
  command.footer(
      "Settings without an option are chosen from the data and printed.\n"
      "\n"
      "Examples:\n"
      "  orrery plot melt.dump -o melt.png\n"
      "  orrery plot 1m4x.pdb -o virus.png --assembly 1\n"
      "  orrery plot grains.dump -o pour.####.png --frames all --color-by vz --range -2:0\n"
      "  orrery plot scan.las -o scan.exr --color-by rgb");
  command.callback([arguments, &action] { action = [arguments] { return run_plot(*arguments); }; });
}

}  // namespace orrery::cli
