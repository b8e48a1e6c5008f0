// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "scene/scene.h"

namespace orrery::format {

/// The writer of write_ply()'s files, for is_ply_of().
inline constexpr const char* kPlyWriter = "orrery generate";

/// Writes spheres as binary little-endian PLY: x, y, z and radius as doubles, and material as uint if `points` has
/// materials. A comment in the header names the writer.
///
/// Errors     base::Error: kCannotCreate, kIo
/// Cost       the whole file is built in memory before it is written
/// Reference  turk1994
void write_ply(const scene::Points& points, const std::filesystem::path& file);

/// True if the header of a PLY file names `writer` as its writer. A command that derives the name of a file replaces
/// only files that it wrote; others, such as those of `orrery convert`, belong to the user.
bool is_ply_of(std::string_view writer, const std::filesystem::path& file);

}  // namespace orrery::format
