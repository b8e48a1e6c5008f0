// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "data/table.h"
#include "scene/forward.h"

namespace orrery::points {

struct RadiusSource;

/// Memory that reading the spheres of a data file takes.
struct ReadMemory {
  std::uint64_t rows = 0;          ///< of the file
  std::uint64_t row_bytes = 0;     ///< of the columns that are read
  std::uint64_t sphere_bytes = 0;  ///< of scene data
  double images = 1;               ///< of the periodic box; may exceed 64 bits
  double spheres = 0;              ///< in all images; 0: not known yet
  std::size_t copies = 0;          ///< of an assembly, in one image
};

/// Returns the type of a column of a frame.
data::ColumnType type_of(const data::FrameInfo& info, const std::string& column);

/// Bytes of the centre and the radius of a sphere as scene data. An upper bound: numbers that need no double precision
/// are stored as floats.
///
/// `copies`   of an assembly; else 1
std::uint64_t bytes_per_sphere(const data::FrameInfo& info, const scene::Points& points, const RadiusSource& radius,
                               std::size_t copies);

/// Checks that spheres fit into memory while they are read.
///
/// `limit`    bytes; 0: none
/// Errors     base::Error(kNoMemory) with the needed size
void require_memory(const ReadMemory& need, std::uint64_t limit, const std::filesystem::path& file);

}  // namespace orrery::points
