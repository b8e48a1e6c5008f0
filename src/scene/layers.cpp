// SPDX-License-Identifier: Apache-2.0
#include "scene/layers.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

#include <fmt/core.h>

#include "base/text.h"
#include "scene/limits.h"

namespace orrery::scene {
namespace {

/// Names of the lobe AOVs; with an underscore, the endings of the layers of a light group.
constexpr const char* kLobes[] = {
    "background",        "diffuse_direct",      "diffuse_indirect",      "specular_direct",
    "specular_indirect", "transmission_direct", "transmission_indirect", "emission"};

/// Integers above this are not all exact in a float.
constexpr std::size_t kMaxFloatId = std::size_t{1} << 24;

bool is_emitter(const Material& material) { return std::holds_alternative<Emitter>(material.model); }

bool has_emitters(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(), is_emitter);
}

/// True if any light belongs to a group other than the default.
bool has_light_groups(const Scene& scene) {
  const auto is_named = [](const std::string& group) { return !group.empty() && group != kDefaultLightGroup; };
  return is_named(background_light_group(scene.background)) ||
         std::any_of(scene.materials.begin(), scene.materials.end(), [&](const Material& material) {
           return is_emitter(material) && is_named(std::get<Emitter>(material.model).light_group);
         });
}

bool has_groups(const Scene& scene) {
  const auto has_group = [](const auto& thing) { return !thing.group.empty(); };
  const auto any_has = [&](const auto& things) { return std::any_of(things.begin(), things.end(), has_group); };
  return any_has(scene.spheres) || any_has(scene.points) || any_has(scene.rods) || any_has(scene.rod_files);
}

bool is_animated(const Scene& scene) {
  return !scene.tracks.empty() || scene.animation.turntable != 0 ||
         std::any_of(scene.points.begin(), scene.points.end(), [](const Points& p) { return p.motion.is_set(); });
}

/// A layer, and which scenes can have it.
struct LayerRule {
  const char* name;
  bool is_light = false;                        ///< requires paths
  bool (*has_content)(const Scene&) = nullptr;  ///< whether it is not empty; null: always
};

/// All layers, in the order of the documentation.
constexpr LayerRule kLayerRules[] = {{"Z"},
                                     {"depth"},
                                     {"N"},
                                     {"P"},
                                     {"albedo"},
                                     {"diffuse", true},
                                     {"specular", true},
                                     {"transmission", true},
                                     {"background", true},
                                     {"emission", true, has_emitters},
                                     {"light_groups", true, has_light_groups},
                                     {"variance"},
                                     {"samples"},
                                     {"object_id"},
                                     {"material_id"},
                                     {kVectorLayer, false, is_animated},
                                     {"denoise.albedo"},
                                     {"denoise.normal"},
                                     {kHalvesLayer},
                                     {"CryptoObject"},
                                     {"CryptoMaterial"},
                                     {"CryptoGroup", false, has_groups}};

const LayerRule* rule_of(const std::string& layer) {
  const auto found = std::find_if(std::begin(kLayerRules), std::end(kLayerRules),
                                  [&](const LayerRule& rule) { return layer == rule.name; });
  return found != std::end(kLayerRules) ? found : nullptr;
}

}  // namespace

const std::vector<std::string>& layer_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    for (const LayerRule& rule : kLayerRules) out.emplace_back(rule.name);
    return out;
  }();
  return names;
}

std::string background_light_group(const Background& background) {
  const bool has_key = background.type == BackgroundType::kImage || background.type == BackgroundType::kSky;
  return has_key && !background.light_group.empty() ? background.light_group : kDefaultLightGroup;
}

std::string light_group_fault(const std::string& name) {
  if (name.empty()) return {};
  const auto is_word = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  if (!std::all_of(name.begin(), name.end(), is_word) || (name[0] >= '0' && name[0] <= '9'))
    return "must consist of letters, digits and underscores and not begin with a digit: it becomes the name of layers";
  if (name.size() > kLongestLightGroup)
    return fmt::format("has {} characters; the maximum is {}", name.size(), kLongestLightGroup);
  // The beauty's part of a multi-part file, and its channels.
  static const std::vector<std::string> reserved = {kAllLayers, "rgba", "R", "G", "B", "A", "half_a", "half_b"};
  bool is_layer = base::contains(reserved, name) || name.starts_with("Crypto");
  for (const std::string& layer : layer_names()) is_layer = is_layer || name == layer.substr(0, layer.find('.'));
  for (const char* lobe : kLobes) is_layer = is_layer || name == lobe;
  if (is_layer) return "is the name of another layer; choose a different one";
  for (const char* lobe : kLobes)
    if (name.ends_with(std::string("_") + lobe))
      return fmt::format("ends in \"_{}\", like a layer of another group; choose a different one", lobe);
  return {};
}

std::string layer_fault(const Scene& scene, const std::string& layer) {
  const LayerRule* const rule = rule_of(layer);
  if (rule != nullptr && rule->is_light && scene.render.shading != Shading::kPath)
    return layer + " requires render.shading = \"path\"";
  const std::size_t objects = scene.sphere_count() + scene.rod_count();
  if (layer == "object_id" && objects >= kMaxFloatId)
    return fmt::format("a float cannot represent the ids of {} spheres and rods exactly; use CryptoObject", objects);
  return {};
}

std::vector<std::string> available_layers(const Scene& scene) {
  std::vector<std::string> out;
  for (const LayerRule& rule : kLayerRules)
    if (layer_fault(scene, rule.name).empty() && (rule.has_content == nullptr || rule.has_content(scene)))
      out.emplace_back(rule.name);
  return out;
}

std::vector<std::string> requested_layers(const Scene& scene) {
  const std::vector<std::string>& requested = scene.output.layers;
  if (!base::contains(requested, kAllLayers)) return requested;
  std::vector<std::string> out = available_layers(scene);
  std::erase(out, kHalvesLayer);
  for (const std::string& name : requested)
    if (name != kAllLayers && !base::contains(out, name)) out.push_back(name);
  return out;
}

}  // namespace orrery::scene
