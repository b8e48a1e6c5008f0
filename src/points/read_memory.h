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

/// Memory that is needed to read the spheres of a data file.
struct ReadMemory {
  std::uint64_t file_bytes = 0;    ///< bytes of the open file, see data::DataFile::memory()
  std::uint64_t rows = 0;          ///< number of rows in the file
  std::uint64_t row_bytes = 0;     ///< bytes per row of the columns that are read
  std::uint64_t sphere_bytes = 0;  ///< bytes per sphere of scene data
  double bond_bytes = 0;           ///< bytes of all bonds, and for finding them
  double images = 1;               ///< number of periodic images of the box; may exceed 64 bits
  double spheres = 0;              ///< number of spheres in all images; 0: not known yet
  std::size_t copies = 0;          ///< copies of an assembly in one image
};

/// Returns the type of a column of a frame.
data::ColumnType type_of(const data::FrameInfo& info, const std::string& column);

/// Upper bound of the size of a sphere's centre and radius as scene data, bytes. Numbers that do not need double
/// precision are stored as floats.
///
/// `are_rounded`   whether make_copies() rounds the centres
std::uint64_t bytes_per_sphere(const data::FrameInfo& info, const scene::Points& points, const RadiusSource& radius,
                               bool are_rounded);

/// Checks that there is enough memory to read the spheres.
///
/// `limit`    bytes; 0: none
/// Errors     base::Error(kNoMemory) with the needed size
void require_memory(const ReadMemory& need, std::uint64_t limit, const std::filesystem::path& file);

}  // namespace orrery::points
