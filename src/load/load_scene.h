// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "display/settings.h"
#include "load/forward.h"
#include "load/scene_source.h"

namespace orrery::load {

/// A scene to load, and the display transform of its images.
struct SceneRequest {
  SceneSource source;
  display::Settings display;            ///< from the command line; the scene's [color] replaces empty values
  bool develops = false;                ///< true if display formats will be written
  std::uint64_t memory_limit = 0;       ///< bytes that an image may take; 0: the free memory
  bool skips_large_background = false;  ///< see BackgroundRequest::skips_large; also applies to textures
  std::shared_ptr<BackgroundCache> background_cache = nullptr;
  std::shared_ptr<TextureCache> texture_cache = nullptr;
};

/// Reads a scene with its textures and its image background or sky, checks everything that a render would reject, and
/// converts its colours to the working space. All commands load scenes here, so that they accept the same scenes.
///
/// Names in [color] are always looked up. A default config is loaded only if `develops`.
///
/// Errors     those of format::read_scene, with unknown names in [color] among its diagnostics; base::Error: kUsage
///            for an unknown name from the command line, kMissingInput and kBadData for a config from there or from
///            $OCIO
LoadedScene load_scene(const SceneRequest& request);

}  // namespace orrery::load
