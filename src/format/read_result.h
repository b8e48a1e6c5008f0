// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "scene/scene.h"

namespace orrery::format {

/// The value of a key, and its origin.
struct Setting {
  std::string key;     ///< "camera.vfov"
  std::string value;   ///< as written in a scene file
  std::string origin;  ///< "default", "scene.toml:12", "--set", "--samples"
};

/// Result of reading a scene.
struct ReadResult {
  scene::Scene scene;
  std::vector<base::Diagnostic> warnings;
  std::vector<Setting> settings;  ///< all keys that a scene has at most once, in documentation order
  /// The scene at shutter close, without points; `scene` is then the scene at shutter open. Empty without motion blur.
  std::optional<scene::Scene> closing = {};
};

}  // namespace orrery::format
