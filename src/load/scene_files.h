// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/file_set.h"
#include "load/load_scene.h"

namespace orrery::load {

/// Adds the files that a scene references at these frames. Reads the scene file, but no other file.
///
/// Errors     those of add_scene_files and authored_scene
void add_named_files(const SceneSource& scene, const std::vector<int>& frames, base::FileSet& files);

/// Adds the files that a scene references.
///
/// `frames`   of sequences of files; a scene that was read at a frame has none
/// Errors     base::Error(kUsage) if one is an output
void add_scene_files(const std::filesystem::path& scene_file, const scene::Scene& scene, base::FileSet& files,
                     const std::vector<int>& frames = {});

/// Adds an OCIO config, from --ocio or a scene, and the config in $OCIO, if they are files, and their LUT files.
///
/// Errors     those of add_scene_files
/// Cost       loads a config that is not in the set
void add_ocio_configs(const std::string& config, base::FileSet& files);

}  // namespace orrery::load
