// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "load/load_scene.h"
#include "load/read_scene.h"

namespace orrery::support {

/// Reads a scene file and its data files, but no images.
inline load::ReadResult read_scene_file(const std::filesystem::path& file, const load::Overrides& overrides = {}) {
  load::SceneRequest request;
  request.source.file = file;
  request.source.overrides = overrides;
  return load::read_with_data(request);
}

}  // namespace orrery::support
