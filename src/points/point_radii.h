// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "data/table.h"
#include "scene/forward.h"

namespace orrery::points {

class KeyFaults;
class Rows;

/// How the radii of a file's spheres are determined: one of the alternatives of scene::PointsRadius, or the file's own.
struct RadiusSource {
  enum class Kind { kValue, kColumn, kElement, kType };
  Kind kind = Kind::kValue;
  std::string column;  ///< column to read; empty: none
  double scale = 1;    ///< multiplies column and element radii
};

/// Determines the source of the radii. Reports a missing radius, unknown columns, and mutually exclusive keys.
RadiusSource radius_source(const data::FrameInfo& info, const scene::PointsRadius& radius, KeyFaults& faults);

/// Returns the radii of the rows. Reports elements and types without a radius.
///
/// Domain     a table with the source's column
scene::NumberArray radii_of(const data::Table& table, const Rows& rows, const RadiusSource& source,
                            const scene::PointsRadius& radius, KeyFaults& faults);

}  // namespace orrery::points
