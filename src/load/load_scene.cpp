// SPDX-License-Identifier: Apache-2.0
#include "load/load_scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include "base/available_memory.h"
#include "base/error.h"
#include "base/input_file.h"
#include "base/text.h"
#include "display/settings.h"
#include "load/load_images.h"
#include "scene/layers.h"
#include "scene/validate.h"

namespace orrery::load {
namespace {

/// The display transform of a scene's images.
display::Settings settings_of(const SceneSource& source, const scene::Color& color) {
  return {config_of(source.file, color), color.working_space(), color.display, color.view, color.look, color.exposure};
}

/// What to read for a table of the scene that names a data file.
points::LoadRequest request_for(const SceneSource& source, const std::filesystem::path& file, std::string key) {
  points::LoadRequest out;
  out.folder = source.file.parent_path();
  out.file = out.folder / file;
  out.key = std::move(key);
  return out;
}

points::LoadRequest points_request(const SceneSource& source, const scene::Scene& scene, std::size_t table) {
  points::LoadRequest out = request_for(source, scene.points[table].file, fmt::format("points[{}]", table));
  out.frame = source.frame;
  if (const auto& topology = scene.points[table].topology; !topology.empty()) out.topology = out.folder / topology;
  out.materials = &scene.materials;
  out.open = source.open_data;
  out.loaded = source.loaded;
  return out;
}

bool names_anything(const display::Settings& settings, const scene::Color& color) {
  const scene::Color defaults;
  return color.space != defaults.space || settings.working_space != color.space || !settings.config.empty() ||
         !settings.display.empty() || !settings.view.empty() || !settings.look.empty();
}

/// Errors where a light whose brightness depends on an image or a sky is too bright for its exposure.
std::vector<scene::SceneDiagnostic> check_exposures(const scene::Scene& scene, const LoadedScene& loaded) {
  scene::KeyFaults faults;
  const auto check = [&](const std::string& table, const LoadedMap& map, double exposure) {
    faults.error_if_any(table + ".exposure", scene::exposure_fault(static_cast<double>(map.brightest), exposure));
  };
  for (const scene::Material& material : scene.materials) {
    const auto* const emitter = std::get_if<scene::Emitter>(&material.model);
    if (emitter == nullptr || !emitter->radiance_texture) continue;
    const std::string table = "material." + material.name;
    const std::string key = table + ".radiance";
    for (const LoadedTexture& texture : loaded.textures)
      if (texture.key == key) check(table, texture.map, emitter->exposure);
  }
  if (loaded.background) check("background", *loaded.background, scene.background.exposure);
  return faults.take();
}

/// A pointer to the scene at shutter close; null without motion blur.
const scene::Scene* pointer_to(const std::optional<scene::Scene>& closing) { return closing ? &*closing : nullptr; }

/// One load of a scene.
class SceneLoader {
 public:
  SceneLoader(const SceneRequest& request, std::optional<LoadedScene> previous)
      : request_(request), previous_(std::move(previous)), reader_(request.source), scene_(reader_.scene()) {}

  ReadResult read_with_data() {
    load_data();
    return reader_.finish();
  }

  LoadedScene run() {
    if (request_.keeps_authored) {
      out_.authored = scene_;
      out_.authored_closing = reader_.closing();
    }
    compare();
    load_data();
    if (reader_.is_read("color.")) load_images();
    out_.read = reader_.finish();
    if (name_error_) throw base::Error(*name_error_);
    finish(out_.read.scene);
    return std::move(out_);
  }

 private:
  /// Determines what has changed since the previous load.
  void compare() {
    if (request_.keeps_authored) out_.data_version = data_version();
    if (!previous_ || reader_.has_errors()) return;
    out_.changed = scene::changed_parts(*previous_->authored, pointer_to(previous_->authored_closing), scene_,
                                        pointer_to(reader_.closing()));
    // Displacements are released with the spheres.
    const auto moves = [](const scene::Points& points) { return points.motion.is_set(); };
    const bool needs_displacements = has_vectors() && std::any_of(scene_.points.begin(), scene_.points.end(), moves);
    if (out_.data_version != previous_->data_version || needs_displacements) out_.changed.add(scene::Part::kGeometry);
    if (request_.on_change && out_.changed.any()) request_.on_change(out_.changed);
  }

  bool has_new_data() const { return out_.changed.geometry || out_.changed.assignment; }

  points::LoadRequest data_request(std::size_t index) {
    points::LoadRequest out = points_request(request_.source, scene_, index);
    out.has_previous = has_vectors();
    if (reader_.closing())
      out.moves_from = scene_.camera.shutter_open;
    else if (out.has_previous)
      out.moves_from = 0;
    return out;
  }

  bool has_vectors() const { return base::contains(scene::requested_layers(scene_), scene::kVectorLayer); }

  /// Identifies the data files, their contents, and the frames that are read from them.
  std::string data_version() {
    const auto version_of = [&](const std::filesystem::path& file) {
      return request_.source.data_version ? request_.source.data_version(file) : base::file_version(file);
    };
    std::string out;
    for (std::size_t i = 0; i < scene_.points.size(); ++i) {
      const scene::Points& points = scene_.points[i];
      if (!reader_.is_read(fmt::format("points[{}].file", i))) continue;
      const points::LoadRequest request = data_request(i);
      int frame = 0;
      try {
        frame = points::chosen_frame(request, points);
      } catch (const base::Error&) {  // reported when the file is loaded
      }
      out += fmt::format("{}\n{}\n", version_of(request.file), frame);
      if (points.motion.is_set() && request.moves_from)
        out += fmt::format("{} {}\n", *request.moves_from, scene_.camera.shutter_close);
      if (!request.topology.empty()) out += base::file_version(request.topology) + '\n';
      if (points.color.has_map_file()) out += base::file_version(request.folder / points.color.map) + '\n';
    }
    for (std::size_t i = 0; i < scene_.rod_files.size(); ++i)
      if (reader_.is_read(fmt::format("rods[{}].file", i))) out += version_of(rods_request(i).file) + '\n';
    return out;
  }

  /// Reads the data files, or takes what was determined when they were read, and checks the scene with its data.
  void load_data() {
    if (has_new_data()) {
      read_data();
    } else {
      for (std::size_t i = 0; i < scene_.points.size(); ++i) take_loaded(i);
      out_.data_warnings = std::move(previous_->data_warnings);
      reader_.add(out_.data_warnings);
    }
    reader_.add(scene::validate(scene_));
    find_coincident();
  }

  void read_data() {
    const std::uint64_t limit =
        request_.memory_limit > 0 ? request_.memory_limit : base::available_memory().value_or(0);
    std::uint64_t used = 0;
    const auto load = [&](points::LoadRequest data, auto& table, auto load_table) {
      if (!reader_.is_read(data.key + ".file")) return;
      data.memory_limit = rest_of(limit, used);
      try {
        const std::vector<scene::SceneDiagnostic> found = load_table(data, table);
        reader_.add(found);
        out_.data_warnings.insert(out_.data_warnings.end(), found.begin(), found.end());
      } catch (const base::Error& error) {
        if (error.kind() != base::ErrorKind::kBadData && error.kind() != base::ErrorKind::kMissingInput) throw;
        reader_.add_file_error(data.key + ".file", error);
      }
      used += table.bytes();
    };
    for (std::size_t i = 0; i < scene_.points.size(); ++i) load(data_request(i), scene_.points[i], points::load_points);
    for (std::size_t i = 0; i < scene_.rod_files.size(); ++i)
      load(rods_request(i), scene_.rod_files[i], points::load_rods);
  }

  points::LoadRequest rods_request(std::size_t index) const {
    return request_for(request_.source, scene_.rod_files[index].file, fmt::format("rods[{}]", index));
  }

  /// Takes what is known of a points table besides its spheres.
  void take_loaded(std::size_t index) {
    scene::PointsFindings& known = scene_.points[index];
    known = std::move(previous_->read.scene.points[index]);
    known.palette = std::move(previous_->palettes[index]);
  }

  void find_coincident() {
    if (!out_.changed.geometry) {
      scene_.distinct_in = previous_->read.scene.distinct_in;
      reader_.add(previous_->coincident);
      out_.coincident = std::move(previous_->coincident);
      return;
    }
    out_.coincident = scene::warn_of_coincident(scene_, pointer_to(reader_.closing()));
    if (out_.coincident.empty()) scene_.distinct_in = scene_.render.precision;
    reader_.add(out_.coincident);
  }

  /// Looks up the colour names of the scene. Returns the errors in them.
  std::vector<scene::SceneDiagnostic> look_up_colors() {
    const scene::Color& color = scene_.color;
    const display::Settings settings = settings_of(request_.source, color);
    if (!request_.develops && !names_anything(settings, color)) return {};
    scene::KeyFaults faults;
    display::LookUp found = display::look_up(settings, color.space);
    for (const display::NameFault& fault : found.faults) {
      if (fault.name != "config" || !color.config.empty())
        faults.error("color." + fault.name, fault.error);
      else
        name_error_.emplace(fault.error);
    }
    out_.choice = std::move(found.choice);
    return faults.take();
  }

  /// Checks the names in [color], then reads textures and the background.
  void load_images() {
    std::vector<scene::SceneDiagnostic> diagnostics = look_up_colors();
    const auto add = [&](const std::vector<scene::SceneDiagnostic>& more) {
      diagnostics.insert(diagnostics.end(), more.begin(), more.end());
    };
    if (diagnostics.empty()) {
      const ImageRequest images{request_.source.file.parent_path(), settings_of(request_.source, scene_.color).config,
                                request_.memory_limit, request_.skips_large_background};
      load_textures(images);
      for (const LoadedTexture& texture : out_.textures) add(texture.map.diagnostics);
      load_background(images);
      if (out_.background) add(out_.background->diagnostics);
      add(check_exposures(scene_, out_));
    }
    reader_.add(diagnostics);
  }

  void load_textures(const ImageRequest& images) {
    static const std::vector<LoadedTexture> kNone;
    const std::vector<LoadedTexture>& known = previous_ ? previous_->textures : kNone;
    out_.textures = load::load_textures(images, known, scene_);
    const auto is_same = [](const LoadedTexture& a, const LoadedTexture& b) { return a.map.image == b.map.image; };
    if (!std::equal(known.begin(), known.end(), out_.textures.begin(), out_.textures.end(), is_same))
      out_.changed.add(scene::Part::kLook);
  }

  void load_background(const ImageRequest& images) {
    const scene::Background& background = scene_.background;
    const bool is_sky = background.type == scene::BackgroundType::kSky;
    if (!is_sky && (background.type != scene::BackgroundType::kImage || background.file.empty())) return;
    std::optional<LoadedMap> known;
    if (previous_) known = std::move(previous_->background);
    const bool is_known = known && known->image &&
                          (is_sky ? !out_.changed.look && !out_.changed.assignment && !out_.changed.geometry
                                  : known->version == background_version(images, scene_));
    if (is_known) {
      out_.background = std::move(known);
      return;
    }
    known.reset();
    if (previous_ && !out_.changed.look) {
      out_.changed.add(scene::Part::kLook);
      if (request_.on_change) request_.on_change(out_.changed);
    }
    out_.background = is_sky ? load_sky(images.ocio_config, scene_) : load::load_background(images, scene_);
  }

  /// Completes the scene: its images, display transform and working space.
  void finish(scene::Scene& scene) {
    if (request_.keeps_authored)
      for (const scene::Points& points : scene.points) out_.palettes.push_back(points.palette);
    if (out_.background) scene.background.image = out_.background->image;
    set_textures(out_.textures, scene);
    out_.display = settings_of(request_.source, scene.color);
    out_.warnings = std::move(out_.read.warnings);
    if (out_.choice)
      for (const std::string& text : out_.choice->warnings)
        out_.warnings.push_back(base::file_diagnostic(base::Severity::kWarning, out_.choice->config, text));
    if (const int clamped = to_working_space(out_.display.config, scene); clamped > 0)
      out_.warnings.push_back(base::file_diagnostic(
          base::Severity::kWarning, request_.source.file.string(),
          fmt::format("{} colours are out of range in {} and were clamped", clamped, scene.color.working_space())));
    if (scene.background.alpha != 0) out_.display.backdrop = scene.background.backdrop;
  }

  const SceneRequest& request_;
  std::optional<LoadedScene> previous_;
  SceneReader reader_;
  scene::Scene& scene_;
  std::optional<base::Error> name_error_;  ///< of the config in $OCIO; thrown if the scene has no errors
  LoadedScene out_;
};

}  // namespace

LoadedScene load_scene(const SceneRequest& request, std::optional<LoadedScene> previous) {
  return SceneLoader(request, std::move(previous)).run();
}

ReadResult read_with_data(const SceneRequest& request) { return SceneLoader(request, {}).read_with_data(); }

points::SourceRows read_source_rows(const SceneSource& source, const scene::Scene& scene, std::size_t table) {
  points::SourceRows out;
  points::LoadRequest request = points_request(source, scene, table);
  request.memory_limit = base::available_memory().value_or(0);
  request.source = &out;
  scene::Points points = scene.points[table];
  for (const scene::SceneDiagnostic& d : points::load_points(request, points))
    if (d.severity == base::Severity::kError)
      throw base::Error(d.kind, fmt::format("{}: {}", request.file.string(), d.text));
  return out;
}

void reduce_picture(ReadResult& scene, double pixels) {
  scene::Image& image = scene.scene.image;
  const double scale = std::min(1.0, std::sqrt(pixels / (static_cast<double>(image.width) * image.height)));
  image.crop.reset();
  image.overscan = 0;
  image.width = std::max(1, static_cast<int>(std::lround(image.width * scale)));
  image.height = std::max(1, static_cast<int>(std::lround(image.height * scale)));
  if (scene.closing) scene.closing->image = image;
}

}  // namespace orrery::load
