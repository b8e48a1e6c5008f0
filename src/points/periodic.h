// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "data/table.h"
#include "math/vec3.h"

namespace orrery::points {

using math::Vec3d;

/// Moves points by their counts of periodic images: p + ix a + iy b + iz c. A null column counts as 0.
///
/// Domain     columns of numbers, one row per point
/// Result     NaN where a count is NaN
void unwrap(std::span<Vec3d> centers, const data::Box& box, const std::array<const data::Column*, 3>& images);

/// Returns the number of points outside the box along one of its periodic edges, as unwrapped points are. Points on a
/// face, or within 1e-9 edges of it, are inside.
///
/// Domain     a box of positive volume; finite coordinates
std::size_t count_outside(std::span<const Vec3d> centers, const data::Box& box);

/// Returns the translations of nx x ny x nz copies of a box: i a + j b + k c, i fastest, the box itself first.
///
/// Domain     counts >= 1; their product is limited by the caller
std::vector<Vec3d> replica_translations(const data::Box& box, const std::array<int, 3>& counts);

/// Returns rotation p + translation.
Vec3d transformed(const data::Transform& transform, Vec3d p);

/// Returns for each row whether it belongs to a part of an assembly, 1 or 0.
///
/// Domain     the text column of chain names; null if the table has none and the part has all chains
std::vector<std::uint8_t> rows_of_part(const data::AssemblyPart& part, const data::Column* chain, std::size_t rows);

}  // namespace orrery::points
