// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "data/table.h"

namespace orrery::points {

/// Name of the column that is computed from the velocity components if the file lacks it.
inline constexpr const char* kSpeed = "speed";

/// Adds the column `speed` to the columns of a frame, if it can be computed: from vx, vy and vz, or from the components
/// of velocity, velocities, vel or velo.
void add_derived_columns(data::FrameInfo& info);

/// Returns the columns of the file that a column is computed from; empty if the file contains it.
std::vector<std::string> sources_of(const data::FrameInfo& info, const std::string& column);

/// Adds `speed` to a table, the length of the vector of the source columns.
///
/// Domain     a table with the columns of sources_of(), all numeric
void compute_speed(const std::vector<std::string>& sources, data::Table& table);

}  // namespace orrery::points
