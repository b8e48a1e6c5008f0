// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "format/overrides.h"

namespace orrery::format {

/// The files that a scene names, as written in it: relative to its folder, with frame patterns.
struct NamedFiles {
  std::vector<std::string> points;
  std::vector<std::string> color_maps;
  std::string background;
  std::vector<std::string> textures;
  std::string ocio_config;
};

/// Finds the files that a scene names, without reading its spheres or those files. Values of the wrong type are
/// skipped: read_scene reports them.
///
/// `text`     text of the scene; null: read the file
/// Errors     base::Error(kBadData) for invalid TOML; kMissingInput, kIo
/// Cost       parses the whole file
NamedFiles named_files(const std::filesystem::path& scene_file, const Overrides& overrides,
                       const std::string* text = nullptr);

}  // namespace orrery::format
