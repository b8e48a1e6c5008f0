// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "data/faults.h"
#include "data/table.h"

namespace orrery::data {

/// Maximum number of columns of a file; a header that declares more is damaged.
inline constexpr std::uint64_t kMaxColumns = 4096;

/// Assigns roles to columns by their customary names, ignoring case. For formats that define no names.
///
/// - position: x, y, z; also pos_x, position_x, points:0, points_0, xu
/// - radius: radius, scalar_radius, r unless there are g and b, diameter with scale 0.5
/// - element: element, species, symbol, if it is text
/// - type: type, class, classification
/// - chain: subchain, chain, if it is text
/// - id: id
/// - rgb: red green blue, r g b, diffuse_red ..; rgb, rgba, color, colors, colour, colours with three or four
///   components. Full intensity is 255 for uint8 and signed integers, 65535 for uint16, 1 for floating point.
///
/// Result     roles without a column are empty, even the position
Roles customary_roles(const std::vector<ColumnInfo>& columns);

/// Like customary_roles(), but throws an error that lists the columns if there is no position.
Roles required_roles(const std::vector<ColumnInfo>& columns, Faults& faults);

/// Returns the first numeric column with one of the names, in order of priority and ignoring case; empty if there is
/// none.
std::string number_column(const std::vector<ColumnInfo>& columns, std::initializer_list<const char*> names);

/// Returns the first three numeric columns with the names of a triple, as number_column(); empty if there are none.
std::array<std::string, 3> number_columns(const std::vector<ColumnInfo>& columns,
                                          std::initializer_list<std::array<const char*, 3>> triples);

/// Returns the names of the components of an array: its name if there is one, `x`, `y`, `z` for the first array of
/// three that is named pos, position, positions, coords, coordinates, points or xyz, otherwise `name[1]`, `name[2]` ...
///
/// `columns`  existing columns
std::vector<std::string> component_names(const std::string& name, std::size_t components,
                                         const std::vector<ColumnInfo>& columns);

/// Gives columns unique names.
class UniqueNames {
 public:
  UniqueNames() = default;
  /// Reserves the names of these columns.
  explicit UniqueNames(const std::vector<ColumnInfo>& columns) {
    for (const ColumnInfo& column : columns) names_.insert(column.name);
  }

  /// Returns the name; if it is taken, appends an underscore and a number from 2.
  std::string add(const std::string& name);

 private:
  std::unordered_set<std::string> names_;
  std::unordered_map<std::string, int> numbers_;  ///< the last number that was tried, by name
};

/// Returns the columns to read in order to have columns of which three are computed from others: `names` without the
/// computed ones and with their sources, or `names` if none is computed.
std::vector<std::string> with_sources(const std::vector<std::string>& names, const std::array<std::string, 3>& computed,
                                      const std::array<std::string, 3>& sources);

/// Returns a coordinate of the positions that three columns of float64 give in units of the edges of a box.
std::vector<double> unscaled(const Table& table, const std::array<std::string, 3>& columns, const Box& box,
                             std::size_t axis);

/// Returns copies of columns of a table.
Table copied_columns(const Table& table, const std::vector<std::string>& names);

/// Returns columns of a table, in the order of their names.
Table in_order(Table table, const std::vector<std::string>& names);

/// Returns whether a column exists.
inline bool has_column(const std::vector<ColumnInfo>& columns, std::string_view name) {
  return find_named(columns, name) != nullptr;
}

/// Returns the names of columns for messages, shortened if there are many: "a, b, c, ... (200 in all)".
std::string listed(const std::vector<ColumnInfo>& columns);

}  // namespace orrery::data
