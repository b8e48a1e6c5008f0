// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
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

/// The frame of a scene that nobody asks for another one of.
inline constexpr int kFirstFrame = 1;

struct ReadResult {
  scene::Scene scene;
  std::vector<base::Finding> warnings;
  std::vector<Setting> settings;  ///< every key of which a scene has one, in the documentation's order
  /// The scene without points as it stands when the shutter closes; `scene` is then what it opens on. Nothing where it
  /// is never open.
  std::optional<scene::Scene> closing = {};
};

/// Reads and checks a scene file, and the data files it names.
///
/// `frame` chooses what its keys and its sequences of files come to.
///
/// `overrides` are "key=value" with the value as in the file; quotes around a word may be left out. Keys are dotted,
/// spheres are counted from 0: "camera.vfov=30", "material.gold.fuzz=0.3", "sphere[2].radius=0.5".
///
/// Errors     base::Error: kMissingInput where the file cannot be opened; kBadData with all findings of the file, of
///            the overrides and of the data files, each with its place
/// Reference  docs/scene-format.md
ReadResult read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides = {},
                      int frame = kFirstFrame);

}  // namespace orrery::format
