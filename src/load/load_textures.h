// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "load/load_map.h"
#include "scene/scene.h"

namespace orrery::load {

/// An image texture that was read.
struct LoadedTexture {
  std::string key;  ///< "material.earth.albedo"
  LoadedMap map;
  bool is_shared = false;  ///< an earlier texture has the same image
};

/// Reads the files of all image textures, each once, and converts them to the working space. Reflectances and numbers
/// are clamped to 0..1. The memory limit applies to all of them together.
///
/// `scene_file`   names of textures are relative to its folder
/// `ocio_config`  in the form of display::Settings
/// `known`        textures of an earlier load; those whose files have not changed since are not read again
/// Result         in the order of scene::image_textures
/// Errors         as load_map
std::vector<LoadedTexture> load_textures(const std::filesystem::path& scene_file, const std::string& ocio_config,
                                         std::uint64_t memory_limit, bool skips_large,
                                         const std::vector<LoadedTexture>& known, const scene::Scene& scene);

/// Assigns the images that load_textures() has read to the textures of a scene.
void set_textures(const std::vector<LoadedTexture>& loaded, scene::Scene& scene);

}  // namespace orrery::load
