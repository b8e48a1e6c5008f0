// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>

#include "scene/scene.h"

namespace orrery::format {

/// Reads the vertices of a PLY file (ascii, binary of either byte order) as spheres into `points`.
///
/// Properties: x, y, z (any number type); `radius`, `scalar_radius` or `r`, where `points.radius` is not set;
/// `material`, an index from 0 into the scene's materials, optional. Other properties and elements are passed over. An
/// `r` beside `g` and `b` is a colour.
///
/// Errors     base::Error: kMissingInput; kBadData with findings for a header that cannot be understood, a file that is
///            shorter or longer than it says, an ascii row that is not exactly one line, no radius anywhere, numbers
///            that are not finite, a material that does not exist; `points` then is as before
/// Cost       one read of the file; memory in proportion to it, whatever its header promises
/// Reference  turk1994
void read_ply(const std::filesystem::path& file, std::size_t material_count, scene::Points& points);

}  // namespace orrery::format
