// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "base/diagnostic.h"
#include "display/settings.h"
#include "format/read_result.h"
#include "load/load_textures.h"
#include "load/loaded_map.h"

namespace orrery::load {

/// A scene that is ready to be compiled, and what was determined while loading it.
struct LoadedScene {
  format::ReadResult read;                     ///< colours are in the working space
  display::Settings display;                   ///< from the command line and the scene
  std::optional<display::Choice> choice;       ///< if `develops`, or if a colour name is set
  std::optional<LoadedBackground> background;  ///< image background or sky; the scene refers to its image
  std::vector<LoadedTexture> textures;         ///< image textures; the scene refers to their images
  std::vector<base::Diagnostic> warnings;
};

}  // namespace orrery::load
