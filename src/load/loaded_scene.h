// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "display/settings.h"
#include "format/read_result.h"
#include "load/load_textures.h"
#include "load/loaded_map.h"
#include "scene/changed_parts.h"
#include "scene/scene.h"

namespace orrery::load {

/// A scene that is ready to be compiled, and what was determined while loading it.
struct LoadedScene {
  format::ReadResult read;                     ///< colours are in the working space
  display::Settings display;                   ///< from the command line and the scene
  std::optional<display::Choice> choice;       ///< if `develops`, or if a colour name is set
  std::optional<LoadedBackground> background;  ///< image background or sky; the scene refers to its image
  std::vector<LoadedTexture> textures;         ///< image textures; the scene refers to their images
  std::vector<base::Diagnostic> warnings;

  scene::Parts changed = scene::Parts::all();  ///< what differs from the previous load
  // For the next load.
  std::optional<scene::Scene> authored, authored_closing;  ///< the scene of the file, without spheres of points tables
  std::string data_version;                                ///< identifies the contents of all data files
  std::vector<scene::SceneDiagnostic> data_warnings, coincident;
  std::vector<std::vector<math::Vec3d>> palettes;  ///< of the points tables, not yet in the working space
};

}  // namespace orrery::load
