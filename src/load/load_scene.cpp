// SPDX-License-Identifier: Apache-2.0
#include "load/load_scene.h"

#include <string>
#include <utility>

#include <fmt/core.h>

#include "base/available_memory.h"
#include "base/error.h"
#include "display/look_up.h"
#include "format/read_result.h"
#include "format/read_scene.h"
#include "load/load_background.h"
#include "load/load_textures.h"
#include "load/loaded_scene.h"
#include "load/working_space.h"
#include "scene/validate.h"

namespace orrery::load {
namespace {

display::Settings settings_of(const SceneRequest& request, const scene::Color& color) {
  display::Settings out = request.display;
  const auto otherwise = [](std::string& option, const std::string& key) {
    if (option.empty()) option = key;
  };
  otherwise(out.config, config_of(request.source.file, color));
  otherwise(out.display, color.display);
  otherwise(out.view, color.view);
  otherwise(out.look, color.look);
  if (!out.exposure) out.exposure = color.exposure;
  out.working_space = color.working_space();
  return out;
}

bool names_anything(const display::Settings& settings, const scene::Color& color) {
  const scene::Color defaults;
  return color.space != defaults.space || settings.working_space != color.space || !settings.config.empty() ||
         !settings.display.empty() || !settings.view.empty() || !settings.look.empty();
}

/// Where a name comes from: an option, a key of the scene, or neither.
struct Origin {
  std::string option, key;
};

Origin origin_of(display::Name name, const display::Settings& options, const scene::Color& color) {
  const auto origin = [](const std::string& value, const char* option, bool is_in_scene, const char* key) {
    return !value.empty() ? Origin{option, {}} : is_in_scene ? Origin{{}, key} : Origin{};
  };
  switch (name) {
    case display::Name::kConfig: return origin(options.config, "--ocio", !color.config.empty(), "color.config");
    case display::Name::kSpace: return {{}, "color.space"};
    case display::Name::kWorkingSpace: return {{}, "color.working"};
    case display::Name::kDisplay: return origin(options.display, "--display", !color.display.empty(), "color.display");
    case display::Name::kView: return origin(options.view, "--view", !color.view.empty(), "color.view");
    case display::Name::kLook: return origin(options.look, "--look", !color.look.empty(), "color.look");
  }
  return {};
}

bool has_image(const scene::Background& background) {
  return background.type == scene::BackgroundType::kImage && !background.file.empty();
}

/// Looks up the colour names of a scene's [color] and of the command line.
class ColorCheck {
 public:
  explicit ColorCheck(const SceneRequest& request) : request_(request) {}

  /// Errors in the scene's names.
  std::vector<scene::SceneDiagnostic> operator()(const scene::Scene& scene) {
    const display::Settings settings = settings_of(request_, scene.color);
    std::vector<scene::SceneDiagnostic> diagnostics;
    if (!request_.develops && !names_anything(settings, scene.color)) return diagnostics;
    display::LookUp found = display::look_up(settings, scene.color.space);
    for (const display::NameFault& fault : found.faults) {
      const Origin origin = origin_of(fault.name, request_.display, scene.color);
      if (!origin.key.empty()) {
        const bool is_missing = fault.error.kind() == base::ErrorKind::kMissingInput;
        diagnostics.push_back({base::Severity::kError, origin.key, fault.error.what(),
                               is_missing ? base::ErrorKind::kMissingInput : base::ErrorKind::kBadData});
      } else if (!other_) {
        const std::string begin = origin.option.empty() ? "" : origin.option + ": ";
        other_.emplace(fault.error.kind(), begin + fault.error.what());
      }
    }
    choice_ = std::move(found.choice);
    return diagnostics;
  }

  /// The chosen display transform.
  ///
  /// Errors     base::Error for a wrong name that is not the scene's
  std::optional<display::Choice> take() {
    if (other_) throw base::Error(*other_);
    return std::move(choice_);
  }

 private:
  const SceneRequest& request_;
  std::optional<base::Error> other_;
  std::optional<display::Choice> choice_;
};

/// Errors where a light whose brightness depends on an image or a sky is too bright for its exposure.
std::vector<scene::SceneDiagnostic> check_exposures(const scene::Scene& scene, const LoadedScene& loaded) {
  std::vector<scene::SceneDiagnostic> out;
  const auto check = [&](const std::string& table, const LoadedMap& map, double exposure) {
    const std::string fault = scene::exposure_fault(static_cast<double>(map.brightest), exposure);
    if (!fault.empty()) out.push_back({base::Severity::kError, table + ".exposure", fault});
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
  return out;
}

}  // namespace

LoadedScene load_scene(const SceneRequest& request) {
  LoadedScene out;
  ColorCheck check(request);
  const auto check_and_load = [&](const scene::Scene& scene) {
    std::vector<scene::SceneDiagnostic> diagnostics = check(scene);
    if (!diagnostics.empty()) return diagnostics;
    out.textures = load_textures(request.source.file, settings_of(request, scene.color).config, request.memory_limit,
                                 request.skips_large_background, request.texture_cache.get(), scene);
    const auto add = [&](const std::vector<scene::SceneDiagnostic>& more) {
      diagnostics.insert(diagnostics.end(), more.begin(), more.end());
    };
    for (const LoadedTexture& texture : out.textures) add(texture.map.diagnostics);
    if (scene.background.type == scene::BackgroundType::kSky) {
      out.background = load_sky(settings_of(request, scene.color).config, scene);
    } else if (has_image(scene.background)) {
      const BackgroundRequest background{request.source.file.parent_path() / scene.background.file,
                                         settings_of(request, scene.color).config, request.memory_limit,
                                         request.skips_large_background, request.background_cache};
      out.background = load_background(background, scene);
    }
    if (out.background) add(out.background->diagnostics);
    add(check_exposures(scene, out));
    return diagnostics;
  };
  format::ReadOptions options;
  options.text = request.source.text;
  options.is_generated = request.source.is_generated;
  options.frame = request.source.frame;
  options.open_data = request.source.open_data;
  options.also = check_and_load;
  options.memory_limit = request.memory_limit > 0 ? request.memory_limit : base::available_memory().value_or(0);
  out.read = format::read_scene(request.source.file, request.source.overrides, options);
  out.choice = check.take();
  scene::Scene& scene = out.read.scene;
  if (out.background) scene.background.image = out.background->image;
  set_textures(out.textures, scene);
  out.display = settings_of(request, scene.color);
  out.warnings = std::move(out.read.warnings);
  if (out.choice)
    for (const std::string& text : out.choice->warnings)
      out.warnings.push_back(base::file_diagnostic(base::Severity::kWarning, out.choice->config, text));
  if (const int clamped = to_working_space(out.display.config, scene); clamped > 0)
    out.warnings.push_back(base::file_diagnostic(
        base::Severity::kWarning, request.source.file.string(),
        fmt::format("{} colours are out of range in {} and were clamped", clamped, scene.color.working_space())));
  return out;
}

}  // namespace orrery::load
