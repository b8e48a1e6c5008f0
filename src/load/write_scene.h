// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "scene/scene.h"

namespace orrery::load {

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

/// The writer of write_ply()'s files, for is_ply_of().
inline constexpr const char* kPlyWriter = "orrery generate";

/// Writes spheres as binary little-endian PLY: x, y, z and radius as doubles, and material as int if `points` has
/// materials. A comment in the header names the writer.
///
/// Errors     base::Error: kCannotCreate, kIo
/// Reference  turk1994
void write_ply(const scene::Points& points, const std::filesystem::path& file);

/// True if the header of a PLY file names `writer` as its writer. A command that derives the name of a file replaces
/// only files that it wrote; others, such as those of `orrery convert`, belong to the user.
bool is_ply_of(std::string_view writer, const std::filesystem::path& file);

/// Writes a scene file, marked by marked_text(), and a PLY file for each of its Points.
///
/// Errors     base::Error: kCannotCreate, kIo; kInternal as for scene_text
void write_scene(const scene::Scene& scene, const std::string& comment, const std::filesystem::path& file);

}  // namespace orrery::load
