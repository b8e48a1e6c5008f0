// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "scene/scene.h"

namespace orrery::format {

/// Returns a scene file that authored_scene() reads back to the same scene, with every key that the schema describes.
/// Keys with default values are omitted. The spheres of points tables are in their files.
///
/// `comment`  placed at the top, each line after a #
/// Errors     base::Error(kInternal) for a scene that no file can represent: two materials of the same name, or a
///            material index that does not exist
std::string scene_text(const scene::Scene& scene, const std::string& comment);

/// A scene file that orrery writes: the text, below a line with its checksum, by which check_unedited() recognises it.
std::string marked_text(const std::string& text);

/// Refuses to replace a file that orrery did not write, or that was edited since.
///
/// Errors     base::Error(kCannotCreate)
void check_unedited(const std::filesystem::path& file);

/// Writes a scene file, marked by marked_text(), and a PLY file for each of its Points.
///
/// Errors     base::Error: kCannotCreate, kIo; kInternal as for scene_text
void write_scene(const scene::Scene& scene, const std::string& comment, const std::filesystem::path& file);

}  // namespace orrery::format
