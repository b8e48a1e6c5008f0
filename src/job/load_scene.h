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

/// A scene to load, and what its pictures will be shown with.
struct SceneRequest {
  SceneSource source;
  display::Settings display;  ///< of the command line; what is empty there the scene decides
  bool develops = false;      ///< display formats will be written
};

struct LoadedScene {
  format::ReadResult read;                ///< colours are in the working space
  display::Settings display;              ///< of the command line and the scene together
  std::optional<display::Choice> choice;  ///< where a display, or anything in [color], is asked for
  std::vector<base::Diagnostic> warnings;
};

/// Reads a scene, checks everything that a render would refuse of it, and brings its colours into the working space.
/// All commands that take a scene load it here, so that what one accepts no other refuses.
///
/// Names in [color] are looked up where there are any, whatever is to be written; a config that nobody named is not
/// loaded unless `develops`.
///
/// Errors     of format::read_scene, with unknown names in [color] among its findings; base::Error: kUsage for an
///            unknown name of the command line, kMissingInput and kBadData for a config of the command line or $OCIO
LoadedScene load_scene(const SceneRequest& request);

}  // namespace orrery::job
