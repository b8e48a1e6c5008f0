// SPDX-License-Identifier: Apache-2.0
#include "load/scene_files.h"

#include "base/file_set.h"
#include "base/frames.h"
#include "display/settings.h"
#include "format/named_files.h"
#include "load/scene_source.h"
#include "load/working_space.h"
#include "scene/scene.h"
#include "scene/textures.h"

namespace orrery::load {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPointsRole = "points file";
constexpr const char* kMapRole = "colour map";
constexpr const char* kBackgroundRole = "background image";
constexpr const char* kTextureRole = "texture";

}  // namespace

void add_named_files(const SceneSource& scene, const std::vector<int>& frames, base::FileSet& files) {
  const fs::path& scene_file = scene.file;
  const format::NamedFiles named = format::named_files(scene_file, scene.overrides, scene.text.get());
  scene::Color color;
  color.config = named.ocio_config;
  add_ocio_configs(config_of(scene_file, color), files);
  const auto add = [&](const std::string& name, const char* role) {
    const fs::path folder = scene_file.parent_path();
    if (!base::is_sequence(folder / name)) {
      files.add_input(folder / name, role);
      return;
    }
    for (const int frame : frames) files.add_input(folder / base::with_frame(name, frame), role);
  };
  for (const std::string& name : named.points) add(name, kPointsRole);
  for (const std::string& name : named.color_maps) add(name, kMapRole);
  if (!named.background.empty()) add(named.background, kBackgroundRole);
  for (const std::string& name : named.textures) add(name, kTextureRole);
}

void add_scene_files(const fs::path& scene_file, const scene::Scene& scene, base::FileSet& files) {
  add_ocio_configs(config_of(scene_file, scene.color), files);
  for (const scene::Points& points : scene.points) {
    files.add_input(scene_file.parent_path() / points.file, kPointsRole);
    if (points.color.has_map_file()) files.add_input(scene_file.parent_path() / points.color.map, kMapRole);
  }
  if (!scene.background.file.empty())
    files.add_input(scene_file.parent_path() / scene.background.file, kBackgroundRole);
  for (const scene::NamedTexture& texture : scene::image_textures(scene))
    files.add_input(scene_file.parent_path() / texture.texture->file, kTextureRole);
}

void add_ocio_configs(const std::string& config, base::FileSet& files) {
  for (const fs::path& file : display::config_files(config)) {
    if (!files.add_input(file, "OCIO config")) continue;
    for (const fs::path& table : display::table_files(file)) files.add_input(table, "table of the OCIO config");
  }
}

}  // namespace orrery::load
