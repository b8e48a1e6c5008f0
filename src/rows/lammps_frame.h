// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "data/byte_source.h"
#include "data/faults.h"
#include "data/table.h"
#include "data/text_cursor.h"

namespace orrery::rows {

/// Header of a frame in a LAMMPS dump: everything before its rows.
struct LammpsFrame {
  double step = 0;
  std::uint64_t rows = 0;
  std::uint64_t rows_line = 0;  ///< number of the line that declares `rows`
  std::optional<data::Box> box;
  std::vector<std::string> columns;
  bool has_labels = false;  ///< the column `type` contains labels instead of numbers
};

/// Reads the items of a frame up to and including `ITEM: ATOMS`.
///
/// Errors     base::Error(kBadData), thrown through `faults`
LammpsFrame read_lammps_frame(data::TextCursor& cursor, data::Faults& faults);

/// Converts a LAMMPS box, given by low and high coordinates and tilt factors.
data::Box lammps_box(const data::Vec3d& low, const data::Vec3d& high, double xy, double xz, double yz);

}  // namespace orrery::rows
