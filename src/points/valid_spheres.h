// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "points/rows.h"
#include "scene/forward.h"

/// Which rows make valid spheres. Used only within this room.
namespace orrery::points {

/// Keeps the rows whose centres and radii are finite, and whose radii are above 0. Reports the others, as errors unless
/// `points.skip_bad`, and spheres that are outside the domain of scenes, while their rows are known.
///
/// `may_be_hollow`  accepts radii below 0
/// Shape            `rows`, `centers` and `radii` have one element per sphere
/// Result           unchanged after an error
void keep_valid(const scene::Points& points, bool may_be_hollow, Rows& rows, scene::PointArray& centers,
                scene::NumberArray& radii, KeyFaults& faults);

/// "row 3 of melt.dump"
std::string row_name(const scene::Points& points, std::size_t row);

/// Reports the number of similar faults of which only the first are reported.
void report_rest(std::size_t count, KeyFaults& faults);

}  // namespace orrery::points
