// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "scene/scene.h"

namespace orrery::format {

/// The scene as text that reads back to the same scene, without what has its default.
///
/// `comment` stands at the head, each line behind a #.
///
/// Errors     base::Error(kInternal) for a scene that no file can say: two materials of one name, or one that is not
/// there
std::string scene_text(const scene::Scene& scene, const std::string& comment);

/// Writes the scene, and beside it a PLY file for each of its Points.
///
/// Errors     base::Error: kCannotCreate, kIo; kInternal as above
void write_scene(const scene::Scene& scene, const std::string& comment, const std::filesystem::path& file);

}  // namespace orrery::format
