// SPDX-License-Identifier: Apache-2.0
#include "format/named_files.h"

#include "base/error.h"
#include "format/toml_tree.h"
#include "scene/scene.h"

namespace orrery::format {

NamedFiles named_files(const std::filesystem::path& scene_file, const Overrides& overrides, const std::string* text) {
  SourceText source;
  Diagnostics diagnostics;
  const std::string own = text != nullptr ? std::string() : read_file(scene_file, kLargestSceneFile);
  const std::string& scene = text != nullptr ? *text : own;
  const toml::table root = parse_tree(scene_file.string(), scene, overrides, source, diagnostics);
  if (root.empty() && diagnostics.has_errors()) {
    refuse_data_file(scene_file, scene);
    diagnostics.raise_errors(scene_file.string());
  }
  NamedFiles out;
  out.ocio_config = root["color"]["config"].value_or(std::string());
  out.background = root["background"]["file"].value_or(std::string());
  if (const toml::table* materials = root["material"].as_table())
    for (const auto& [name, node] : *materials)
      if (const toml::table* material = node.as_table())
        for (const auto& [key, value] : *material)
          if (const toml::table* texture = value.as_table())
            if (const auto file = (*texture)["file"].value<std::string>()) out.textures.push_back(*file);
  if (const toml::array* points = root["points"].as_array())
    for (const toml::node& node : *points)
      if (const toml::table* table = node.as_table()) {
        if (const auto file = (*table)["file"].value<std::string>()) out.points.push_back(*file);
        scene::PointsColor color;
        color.map = (*table)["color"]["map"].value_or(std::string());
        if (color.has_map_file()) out.color_maps.push_back(color.map);
      }
  return out;
}

}  // namespace orrery::format
