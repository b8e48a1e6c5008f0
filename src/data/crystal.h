// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data/table.h"

/// Unit cells and space groups.
namespace orrery::data {

/// Returns the parallelepiped of a unit cell: a along x, b in the plane of x and y.
///
/// `cell`     lengths of a, b and c, and the angles alpha, beta and gamma in degrees
/// Result     none if it has no volume, or no such cell exists
std::optional<Box> cell_box(const std::array<double, 6>& cell);

/// Returns the point with these coordinates in units of the edges of a box.
inline Vec3d point_in(const Box& box, Vec3d fractions) {
  return box.origin + box.edges[0] * fractions.x + box.edges[1] * fractions.y + box.edges[2] * fractions.z;
}

/// Symmetry operators in fractional coordinates, of which the first is the identity.
using Operators = std::vector<Transform>;

/// Reads an operator such as "-x, y+1/2, z" or "0.5+x,-y,z"; none if it is malformed.
std::optional<Transform> operator_of(std::string_view text);

/// The operators of the space group with a Hall symbol; none if there is no such group.
std::optional<Operators> operators_of_hall(const std::string& symbol);

/// The operators of the space group with a Hermann-Mauguin symbol, or a number; none if there is no such group.
///
/// `cell`     tells hexagonal from rhombohedral axes, see cell_box()
std::optional<Operators> operators_of_group(const std::string& name, const std::array<double, 6>& cell);

/// Returns the images of a point in the unit cell, each once: of those on a special position several operators give the
/// same one, to within the rounding of coordinates in files.
///
/// Units      ångström for `box`, fractions of its edges for points
/// Result     from 0 to below 1; the first is that of the first operator
/// Cost       the square of the number of operators
std::vector<Vec3d> images_in_cell(Vec3d point, const Operators& operators, const Box& box);

}  // namespace orrery::data
