// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "base/atomic_file.h"
#include "base/file_set.h"
#include "base/output_file.h"
#include "cli/commands.h"
#include "cli/data_options.h"
#include "cli/messages.h"
#include "cli/option_checks.h"
#include "cli/render_options.h"
#include "format/write_tree.h"
#include "job/check_job.h"
#include "job/load_scene.h"
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
  std::string style;  ///< empty: not set
  std::filesystem::path save_scene, legend;
};

bool is_set(const std::vector<format::Override>& overrides, std::string_view key) {
  return std::any_of(overrides.begin(), overrides.end(), [&](const auto& o) { return o.sets(key); });
}

/// The value of an override, such as --width, which the camera must know.
void take_override(const std::vector<format::Override>& overrides, const std::string& key, int& value) {
  for (const format::Override& override : overrides)
    if (override.text.starts_with(key + "=")) value = std::max(1, integer_of(override.text.substr(key.size() + 1)));
}

/// The scene of a plot before there is one: what the overrides of tables that every scene has make of it, checked.
///
/// `develops` see job::SceneRequest
job::LoadedScene settings_of(const job::Job& job, const PlotArguments& arguments,
                             const std::vector<format::Override>& overrides, bool develops) {
  job::SceneRequest request{job.scene, job.outputs.display, develops};
  request.source.file = arguments.save_scene.empty() ? arguments.plot.file : arguments.save_scene;
  request.source.text = std::make_shared<const std::string>();
  request.source.is_generated = true;
  request.source.overrides.clear();
  for (const format::Override& override : overrides)
    for (const char* table : {"color.", "image.", "output.", "render."})
      if (override.text.starts_with(table)) request.source.overrides.push_back(override);
  return job::load_scene(request);
}

/// Refuses what would fail after all frames were read: names and formats of outputs, layers, colour names.
void check_request(const PlotArguments& arguments, const std::vector<format::Override>& overrides,
                   const std::vector<int>& frames) {
  farm::Batch batch = arguments.render.batch;
  batch.scenes = {arguments.plot.file};
  batch.frames = frames;
  if (!arguments.render.preview.empty()) batch.preview = preview::parse_target(arguments.render.preview).file;
  job::Job& job = batch.job;
  job.scene.text = std::make_shared<const std::string>();
  job.scene.has_file = false;
  for (const job::Job& one : farm::jobs_of(batch)) job::check_request(one);
  job.scene.overrides = overrides;
  job::check_layers(job, settings_of(job, arguments, overrides, job.outputs.has_display_format()).read.scene);
}

/// The choices that are not those of plot::make_plot().
void add_choices(const job::Job& job, const plot::PlotOptions& plot, const std::vector<format::Override>& overrides,
                 std::vector<std::string>& choices) {
  if (plot.style == plot::Style::kFlat && !job.sampling.noise && !job.sampling.seconds &&
      !is_set(overrides, "render.samples"))
    choices.emplace_back("samples 100: without shading there is hardly any noise");
  if (job.outputs.has_display_format() && job.outputs.display.view.empty() && !is_set(overrides, "color.view"))
    choices.emplace_back("view transform Un-tone-mapped: colours stay those of the map");
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
  if (arguments.plot.file.extension() == ".toml")
    refuse(arguments.plot.file.string() + " is a scene; render it: orrery render " + arguments.plot.file.string());
  RenderOptions& render = arguments.render;
  plot::PlotOptions& plot = arguments.plot;
  const std::vector<format::Override> overrides = render.scene.overrides();
  take_override(overrides, "image.width", plot.width);
  take_override(overrides, "image.height", plot.height);
  read_data_options(arguments.data, plot);
  plot.has_size = is_set(overrides, "image.width") || is_set(overrides, "image.height");
  plot.has_style = !arguments.style.empty();
  plot.style = arguments.style == "flat"    ? plot::Style::kFlat
               : arguments.style == "night" ? plot::Style::kNight
                                            : plot::Style::kStudio;
  plot.memory_limit = render.batch.job.resources.memory_limit > 0 ? render.batch.job.resources.memory_limit
                                                                  : job::available_memory().value_or(0);
  const bool saves = !arguments.save_scene.empty();
  render.picture.finish(render.batch.job);
  check_own_outputs(arguments);
  const auto begin = std::chrono::steady_clock::now();
  plot::PlotScene made =
      plot::make_plot(plot, saves ? arguments.save_scene.parent_path() : plot.file.parent_path(),
                      [&](const std::vector<int>& frames) { check_request(arguments, overrides, frames); });
  render.batch.frames = made.frames;
  job::Job& job = render.batch.job;
  job.prepare_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  add_choices(job, plot, overrides, made.choices);
  if (!job.sampling.noise && !job.sampling.seconds && !is_set(overrides, "render.samples") &&
      plot.style != plot::Style::kFlat) {
    job.sampling.noise = kNoise;
    made.choices.push_back(fmt::format("noise {}: --noise, --time or --samples change it", kNoise));
  }
  made.choices.push_back(
      fmt::format("prepared in {:.1f} s: read {} to fit the view and the colours", job.prepare_s,
                  made.frames.size() > 1 ? std::to_string(made.frames.size()) + " frames" : "the file"));
  print_choices(made, arguments);
  render.shows_display = !arguments.legend.empty() || saves;
  if (!arguments.legend.empty()) {
    display::Settings display = settings_of(job, arguments, overrides, true).display;
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
  add_data_file(command, arguments->plot);
  command.add_option("--legend", arguments->legend, "Write a legend of the colours: .svg or .png")->type_name("FILE");
  command.add_option("--save-scene", arguments->save_scene, "Also write the scene file")->type_name("FILE");
  add_data_options(command, arguments->data, arguments->plot);
  add_look_options(command, arguments->data, arguments->plot);
  add_view_options(command, arguments);
  add_render_options(command, arguments->render, false);
  command.footer(
      "Settings that are not given are chosen from the data and printed.\n"
      "\n"
      "Examples:\n"
      "  orrery plot melt.dump -o melt.png\n"
      "  orrery plot 1m4x.pdb -o virus.png --assembly 1\n"
      "  orrery plot grains.dump -o pour.####.png --frames all --color-by vz --range -2:0\n"
      "  orrery plot scan.las -o scan.exr --color-by rgb");
  command.callback([arguments, &action] { action = [arguments] { return run_plot(*arguments); }; });
}

}  // namespace orrery::cli
