// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "base/diagnostic.h"
#include "display/develop.h"
#include "format/read_scene.h"
#include "job/scene_source.h"

namespace orrery::job {

/// A scene to load, and the display transform of its images.
struct SceneRequest {
  SceneSource source;
  display::Settings display;  ///< from the command line; the scene's [color] replaces empty values
  bool develops = false;      ///< true if display formats will be written
};

struct LoadedScene {
  format::ReadResult read;                ///< colours are in the working space
  display::Settings display;              ///< from the command line and the scene
  std::optional<display::Choice> choice;  ///< if `develops`, or if a colour name is set
  std::vector<base::Diagnostic> warnings;
};

/// Reads a scene, checks everything that a render would reject, and converts its colours to the working space. All
/// commands load scenes here, so that they accept the same scenes.
///
/// Names in [color] are always looked up. A default config is loaded only if `develops`.
///
/// Errors     those of format::read_scene, with unknown names in [color] among its diagnostics; base::Error: kUsage
///            for an unknown name from the command line, kMissingInput and kBadData for a config from there or from
///            $OCIO
LoadedScene load_scene(const SceneRequest& request);

}  // namespace orrery::job
