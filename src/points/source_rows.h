// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "data/table.h"

namespace orrery::points {

/// The data from which spheres were made.
struct SourceRows {
  data::FrameInfo info;             ///< description of the frame
  data::Table table;                ///< all columns of the frame
  std::vector<std::uint32_t> rows;  ///< row of each sphere; copies of a particle have the same one
};

}  // namespace orrery::points
