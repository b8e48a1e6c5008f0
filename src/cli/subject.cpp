// SPDX-License-Identifier: Apache-2.0
#include "cli/subject.h"

#include <functional>
#include <memory>

#include <fmt/core.h>

#include "annotation/legend.h"
#include "base/error.h"
#include "base/text.h"
#include "cli/film.h"
#include "cli/render_options.h"
#include "cli/run.h"
#include "load/file_settings.h"
#include "load/read_scene.h"
#include "plot/appearance.h"
#include "plot/plot.h"
#include "plot/settings.h"

namespace orrery::cli {
namespace {

view::Subject scene_subject(const ShownOptions& shown) {
  for (const Option& option : shown.command->options())
    if (option.count() > 0 &&
        base::contains({kDataOptions, kViewOptions, kLookOptions, kAnnotationOptions}, option.heading()))
      base::refuse(fmt::format("{} is an option for data files; a scene has its keys: --set KEY=VALUE", option.name()));
  view::Subject out;
  out.job = shown.job;
  out.job.scene.file = shown.plot.options.file;
  out.job.scene.overrides = shown.scene.overrides();
  return out;
}

view::Subject data_subject(ShownOptions& shown, const FilmSettings* film) {
  plot::PlotOptions& plot = shown.plot.options;
  shown.plot.data.read(plot);
  if (film) film->apply(shown.scene, plot);
  shown.plot.read(shown.scene, shown.job);
  plot.scene_file = plot.file;
  plot.develops = true;
  const plot::PlotScene made = plot::make_plot(plot);
  view::Subject out;
  out.job = shown.job;
  out.job.scene.file = plot.file;
  show(made, std::make_shared<const std::string>(made.text), out.job);
  out.job.scene.typed_lines = 0;
  out.job.scene.overrides = plot.overrides;
  out.notes = made.choices;
  for (const std::string& warning : made.warnings) out.notes.push_back("warning: " + warning);
  out.data = made.data;
  out.frame_count = made.frame_count;
  out.frames = made.frames;
  out.up = made.up;
  const scene::PointsColor& color = made.points.color;
  if (!color.column.empty() || !color.carbon.empty()) out.chosen["--map"] = color.map;
  if (color.range)
    out.chosen["--range"] = fmt::format("{}{}:{}", color.log ? "log," : "", color.range->low, color.range->high);
  out.chosen["--representation"] = plot::representation_names()[static_cast<std::size_t>(plot.representation.value_or(
      plot::shows_cell(plot, made.data)                     ? plot::Representation::kBallAndStick
      : base::contains(made.points.representation, "trace") ? plot::Representation::kTrace
                                                            : plot::Representation::kSpheres))];
  out.chosen["--bonds"] = made.points.bonds.are_drawn ? "auto" : "none";
  out.chosen["--style"] = plot::style_names()[static_cast<std::size_t>(plot.style.value_or(plot::Style::kStudio))];
  out.chosen["--material"] = made.material;
  if (plot.quality || made.noise)
    out.chosen["--quality"] =
        plot::quality_names()[static_cast<std::size_t>(plot.quality.value_or(plot::Quality::kGood))];
  out.legend = annotation::shown_colors(made.legend, plot::legend_display(plot, made));
  return out;
}

/// Parses words, and calls `use` with the options.
void parse_shown(const std::string& file, std::vector<std::string> words,
                 const std::function<void(ShownOptions& shown)>& use) {
  ShownOptions shown;
  words.insert(words.begin(), file);
  const auto add = [&](Command& parsed) {
    shown.add_to(parsed);
    shown.plot.data.add_frames_to(parsed);
  };
  parse_words(words, add, [&] { use(shown); });
}

/// The page may name no files but those given on the command line.
void require_allowed(const ShownOptions& shown, const std::set<std::string>& allowed) {
  for (const std::string& name : files_of(shown))
    if (allowed.count(name) == 0)
      base::refuse(fmt::format("`{}` names a file; start orrery view with this option", name));
}

}  // namespace

void ShownOptions::add_to(Command& parsed) {
  command = &parsed;
  plot.data.add_to(parsed, plot.options, "Scene file, or data file");
  plot.add_look_to(parsed);
  plot.add_annotations_to(parsed);
  scene.add_to(parsed);
  add_sampling_options(parsed, job);
  add_denoise_option(parsed, job);
}

std::set<std::string> files_of(const ShownOptions& shown) {
  std::set<std::string> out = load::named_files(shown.scene.overrides());
  if (shown.plot.options.points.color.has_map_file()) out.insert(shown.plot.options.points.color.map);
  return out;
}

void check_film(const std::string& file, const std::vector<std::string>& words, const std::set<std::string>& allowed) {
  std::vector<std::string> shown;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "--turntable" || words[i] == "--fps")
      ++i;
    else
      shown.push_back(words[i]);
  }
  parse_shown(file, shown, [&](const ShownOptions& parsed) { require_allowed(parsed, allowed); });
}

view::Subject subject_of(const std::filesystem::path& file, const std::vector<std::string>& words,
                         const std::set<std::string>& allowed) {
  view::Subject out;
  parse_shown(file.string(), words, [&](ShownOptions& shown) {
    require_allowed(shown, allowed);
    out = load::is_scene_file(file) ? scene_subject(shown) : data_subject(shown, nullptr);
  });
  return out;
}

view::Subject data_subject(const std::string& file, const std::vector<std::string>& words,
                           const job::Resources& resources, const points::OpenData& open, const FilmSettings* film) {
  view::Subject out;
  parse_shown(file, words, [&](ShownOptions& shown) {
    shown.job.resources = resources;
    shown.plot.options.open = open;
    out = data_subject(shown, film);
    out.job.scene.open_data = open;
  });
  return out;
}

}  // namespace orrery::cli
