// SPDX-License-Identifier: Apache-2.0
#include "load/scene_files.h"

#include "base/file_set.h"
#include "base/frames.h"
#include "display/settings.h"
#include "load/load_images.h"
#include "scene/schema.h"

namespace orrery::load {

namespace fs = std::filesystem;

void add_named_files(const SceneSource& scene, const std::vector<int>& frames, base::FileSet& files) {
  add_scene_files(scene.file, authored_scene(scene), files, frames);
}

void add_scene_files(const fs::path& scene_file, const scene::Scene& scene, base::FileSet& files,
                     const std::vector<int>& frames) {
  add_ocio_configs(config_of(scene_file, scene.color), files);
  const fs::path folder = scene_file.parent_path();
  for (const scene::NamedFile& file : scene::named_files(scene)) {
    if (file.role == &scene::kOcioConfigFile) continue;
    if (!base::is_sequence(folder / file.name)) {
      files.add_input(folder / file.name, file.role->name);
      continue;
    }
    for (const int frame : frames) files.add_input(folder / base::with_frame(file.name, frame), file.role->name);
  }
}

void add_ocio_configs(const std::string& config, base::FileSet& files) {
  for (const fs::path& file : display::config_files(config)) {
    if (!files.add_input(file, "OCIO config")) continue;
    for (const fs::path& table : display::table_files(file)) files.add_input(table, "table of the OCIO config");
  }
}

}  // namespace orrery::load
