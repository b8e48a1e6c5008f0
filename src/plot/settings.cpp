// SPDX-License-Identifier: Apache-2.0
#include "plot/settings.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "base/image_limits.h"
#include "load/load_images.h"
#include "load/write_scene.h"
#include "plot/plot.h"

namespace orrery::plot {

int side_of(const load::Overrides& overrides, const char* key, int otherwise) {
  return static_cast<int>(std::clamp<std::int64_t>(overrides.integer(key).value_or(otherwise), 1, base::kLargestSide));
}

std::optional<double> vfov_of(const PlotOptions& options) {
  const load::Overrides& overrides = options.overrides;
  const std::optional<std::string> projection = overrides.string("camera.projection");
  const std::optional<double> vfov = overrides.number("camera.vfov");
  if (projection != "perspective" && (projection || !vfov)) return projection ? std::nullopt : options.vfov_deg;
  return vfov && *vfov > 0 && *vfov < 180 ? *vfov : scene::Camera().vfov;
}

display::Settings display_of(const PlotOptions& options) {
  const load::Overrides& overrides = options.overrides;
  display::Settings out;
  scene::Color color;
  color.config = overrides.string("color.config").value_or("");
  out.config = load::config_of(options.scene_file, color);
  out.display = overrides.string("color.display").value_or("");
  out.view = overrides.string("color.view").value_or("");
  out.look = overrides.string("color.look").value_or("");
  return out;
}

load::LoadedScene settings_scene(const PlotOptions& options, bool develops) {
  load::SceneRequest request;
  request.develops = develops;
  request.source.file = options.scene_file;
  request.source.text = std::make_shared<const std::string>();
  request.source.typed_lines = 0;
  request.source.has_file = false;
  for (const load::Override& override : options.overrides) {
    const std::string table = override.values.empty() ? "" : override.values.front().key;  // all keys are of one table
    const std::string name = table.substr(0, table.find('.'));
    if (override.fault || name == "color" || name == "image" || name == "output" || name == "render")
      request.source.overrides.add(override);
  }
  return load::load_scene(request);
}

display::Settings legend_display(const PlotOptions& options, const PlotScene& made) {
  display::Settings out = settings_scene(options, true).display;
  out.view = made.view;
  return out;
}

std::string saved_text(const PlotOptions& options, const PlotScene& made) {
  load::Overrides settings;
  for (const load::Override& override : options.overrides) {
    const auto is_of_plot = [](const load::KeyValue& set) {  // make_plot() handles these two
      return set.key == "image.width" || set.key == "image.height";
    };
    if (!std::all_of(override.values.begin(), override.values.end(), is_of_plot)) settings.add(override);
  }
  if (settings.empty()) return made.text;
  const load::SceneSource source{
      .file = "plot", .overrides = settings, .text = std::make_shared<const std::string>(made.text)};
  load::SceneReader reader(source, load::Pose::kAuthored);
  if (reader.has_errors()) return made.text;  // reported when the scene is rendered
  return load::scene_text(reader.scene(), made.text.substr(2, made.text.find('\n') - 2));
}

}  // namespace orrery::plot
