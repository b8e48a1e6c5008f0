// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace orrery::format {

/// Number type of centres and radii in the file.
enum class PlyReal {
  kFloat,   ///< half the size; expected by other programs
  kDouble,  ///< reads back to the same bits
};

/// Writes spheres as binary little-endian PLY: x, y, z, radius, and material as uint if `points` has materials. A
/// comment in the header identifies orrery as the writer.
///
/// Errors     base::Error: kCannotCreate, kIo; kBadData if a number overflows a float
/// Cost       the whole file is built in memory before it is written
/// Reference  turk1994
void write_ply(const scene::Points& points, const std::filesystem::path& file, PlyReal real = PlyReal::kDouble);

/// True if write_ply wrote the file, so that replacing it destroys no user data.
bool is_own_ply(const std::filesystem::path& file);

}  // namespace orrery::format
