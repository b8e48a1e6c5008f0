// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "format/override.h"

namespace orrery::format {

/// The files that a scene names, as it spells them: relative to its folder, points files with places for a frame.
struct NamedFiles {
  std::vector<std::string> points;
  std::string ocio_config;
};

/// Finds them without reading the scene's spheres or the files themselves. Values of other types are left out:
/// reading the scene reports them.
///
/// Errors     base::Error(kBadData) for a file that is not TOML; kMissingInput, kIo
/// Cost       parses the whole file
NamedFiles named_files(const std::filesystem::path& scene_file, const std::vector<Override>& overrides);

}  // namespace orrery::format
