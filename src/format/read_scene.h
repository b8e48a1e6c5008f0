// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "format/override.h"
#include "scene/scene.h"
#include "scene/validate.h"

namespace orrery::format {

/// One value of the scene and where it came from.
struct Setting {
  std::string key;     ///< "camera.vfov"
  std::string value;   ///< as it would stand in a scene file
  std::string origin;  ///< "default", "scene.toml:12", "--set", "--samples"
};

/// The frame of a scene that nobody asks for another one of.
inline constexpr int kFirstFrame = 1;

struct ReadResult {
  scene::Scene scene;
  std::vector<base::Diagnostic> warnings;
  std::vector<Setting> settings;  ///< every key of which a scene has one, in the documentation's order
  /// The scene without points as it stands when the shutter closes; `scene` is then what it opens on. Nothing where it
  /// is never open.
  std::optional<scene::Scene> closing = {};
};

/// What somebody else finds wrong with a scene that is valid by itself, such as names that an OCIO config lacks.
using SceneCheck = std::function<std::vector<scene::SceneDiagnostic>(const scene::Scene&)>;

/// Reads and checks a scene file, and the data files it names.
///
/// `frame` selects the values of animated keys and the files of sequences. `also` is asked where nothing in [color] is
/// wrong by itself.
///
/// `overrides` are "key=value" with the value as in the file; quotes around a word may be left out. Keys are dotted,
/// spheres are counted from 0: "camera.vfov=30", "material.gold.fuzz=0.3", "sphere[2].radius=0.5".
///
/// Errors     base::Error: kMissingInput where the scene or nothing but data files cannot be opened; kIo; kBadData with
///            the findings of the file, of the overrides and of the data files, each with its place, the first
///            kMostErrors of them
/// Reference  docs/scene-format.md
ReadResult read_scene(const std::filesystem::path& file, const std::vector<Override>& overrides = {},
                      int frame = kFirstFrame, const SceneCheck& also = {});

}  // namespace orrery::format
