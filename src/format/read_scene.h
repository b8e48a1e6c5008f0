// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/finding.h"
#include "scene/scene.h"

namespace orrery::format {

/// One value of the scene and where it came from.
struct Setting {
  std::string key;     ///< "camera.vfov"
  std::string value;   ///< as it would stand in a scene file
  std::string origin;  ///< "default", "scene.toml:12", "--set"
};

struct ReadResult {
  scene::Scene scene;
  std::vector<base::Finding> warnings;
  std::vector<Setting> settings;  ///< every key of which a scene has one, in the documentation's order
};

/// Reads and checks a scene file, and the data files it names.
///
/// `overrides` are "key=value" with the value as in the file; quotes around a word may be left out. Keys are dotted,
/// spheres are counted from 0: "camera.vfov=30", "material.gold.fuzz=0.3", "sphere[2].radius=0.5".
///
/// Errors     base::Error: kMissingInput where the file cannot be opened; kBadData with all findings of the file, of
///            the overrides and of the data files, each with its place
/// Reference  docs/scene-format.md
ReadResult read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

}  // namespace orrery::format
