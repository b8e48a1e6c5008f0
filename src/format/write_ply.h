// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace orrery::format {

/// The type of centres and radii in a written file.
enum class PlyReal {
  kFloat,   ///< half the size; what other programs expect
  kDouble,  ///< reads back to the same bits
};

/// Writes spheres as binary little-endian PLY: x, y, z, radius, and material as uint where there is one. A comment in
/// the header says that orrery made it.
///
/// Errors     base::Error: kCannotCreate, kIo; kBadData where a number does not fit into a float: it would be infinite
/// Cost       the file stands in memory before it is written
/// Reference  turk1994
void write_ply(const scene::Points& points, const std::filesystem::path& file, PlyReal real = PlyReal::kDouble);

/// Whether write_ply wrote a file, so that writing it again destroys nobody's data.
bool is_own_ply(const std::filesystem::path& file);

}  // namespace orrery::format
