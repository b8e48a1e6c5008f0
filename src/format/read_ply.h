// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>

#include "scene/scene.h"

namespace orrery::format {

/// Reads the vertices of a PLY file (ascii, or binary of either byte order) as spheres into `points`.
///
/// Properties, of any number type: x, y, z; `radius`, `scalar_radius` or `r`, unless `points.radius` is set; optionally
/// `material`, a 0-based index into the scene's materials. Other properties and elements are skipped. `r` is a colour
/// if the vertex also has `g` and `b`.
///
/// Errors     base::Error: kMissingInput; kBadData with diagnostics for an invalid header, a file that is shorter or
///            longer than its header declares, an ascii row that is not exactly one line, a missing radius, non-finite
///            numbers, a material that does not exist; `points` is then unchanged
/// Cost       one read of the file; memory in proportion to its size, whatever the header declares
/// Reference  turk1994
void read_ply(const std::filesystem::path& file, std::size_t material_count, scene::Points& points);

}  // namespace orrery::format
