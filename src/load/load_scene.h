// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "display/settings.h"
#include "format/forward.h"
#include "load/forward.h"
#include "load/scene_source.h"
#include "scene/changed_parts.h"

namespace orrery::load {

/// A scene to load, and the display transform of its images.
struct SceneRequest {
  SceneSource source;
  display::Settings display;            ///< from the command line; the scene's [color] replaces empty values
  bool develops = false;                ///< true if display formats will be written
  std::uint64_t memory_limit = 0;       ///< bytes that an image may take; 0: the free memory
  bool skips_large_background = false;  ///< see BackgroundRequest::skips_large; also applies to textures
  bool keeps_authored = false;          ///< fill LoadedScene::authored, for a later load
  /// Called before data or images are read that replace those of an earlier load, so that their memory is released.
  std::function<void(const scene::Parts& changed)> on_change = {};
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

/// Loads a scene after another, and reads only what has changed since. The result is that of load_scene(request),
/// except that points tables have no spheres unless `changed` contains geometry or assignment.
///
/// `previous`  loaded with keeps_authored; its images move to the result
LoadedScene load_scene(const SceneRequest& request, LoadedScene previous);

/// Reads a scene file and its data files, but no images; colours are as in the file.
///
/// Errors     those of load_scene(), except those about images and names in [color]
format::ReadResult read_with_data(const SceneRequest& request);

}  // namespace orrery::load
