// SPDX-License-Identifier: Apache-2.0
#include "scene/layers.h"

#include <algorithm>
#include <cstddef>

#include "scene/schema.h"

namespace orrery::scene {
namespace {

/// Integers above this are not all exact in a float.
constexpr std::size_t kMaxFloatId = std::size_t{1} << 24;

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Returns all valid names of [output] layers.
const std::vector<std::string>& layer_names() {
  static const std::vector<std::string> names = [] {
    for (const Table& table : tables())
      for (const auto& key : table.keys)
        if (table.name == "output" && key.name == "layers") return key.choices;
    return std::vector<std::string>{};
  }();
  return names;
}

bool has_groups(const Scene& scene) {
  const auto has_group = [](const auto& thing) { return !thing.group.empty(); };
  return std::any_of(scene.spheres.begin(), scene.spheres.end(), has_group) ||
         std::any_of(scene.points.begin(), scene.points.end(), has_group);
}

}  // namespace

std::string layer_fault(const Scene& scene, const std::string& layer) {
  static const std::vector<std::string> light = {"diffuse", "specular", "transmission", "background"};
  if (contains(light, layer) && scene.render.shading != Shading::kPath)
    return layer + " requires render.shading = \"path\"";
  if (layer == "object_id" && scene.sphere_count() >= kMaxFloatId)
    return "a float cannot represent the ids of " + std::to_string(scene.sphere_count()) +
           " spheres exactly; use CryptoObject";
  return {};
}

std::vector<std::string> available_layers(const Scene& scene) {
  std::vector<std::string> out;
  for (const std::string& name : layer_names())
    if (name != kAllLayers && layer_fault(scene, name).empty() && (name != "CryptoGroup" || has_groups(scene)))
      out.push_back(name);
  return out;
}

std::vector<std::string> requested_layers(const Scene& scene) {
  const std::vector<std::string>& requested = scene.output.layers;
  if (!contains(requested, kAllLayers)) return requested;
  std::vector<std::string> out = available_layers(scene);
  for (const std::string& name : requested)
    if (name != kAllLayers && !contains(out, name)) out.push_back(name);
  return out;
}

}  // namespace orrery::scene
