// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "base/stop_point.h"
#include "data/table.h"
#include "scene/diagnostic.h"
#include "scene/scene.h"

namespace orrery::points {

using scene::KeyFaults;

/// Selected rows of a table, in the order of the spheres.
class Rows {
 public:
  /// All rows of a table, in its order.
  explicit Rows(std::size_t count) : count_(count) {}
  /// The listed rows.
  explicit Rows(std::vector<std::uint32_t> rows) : rows_(std::move(rows)), count_(rows_.size()), is_list_(true) {}

  std::size_t size() const { return count_; }
  /// All rows of the table, in its order.
  bool is_all() const { return !is_list_; }
  /// The row numbers.
  std::vector<std::uint32_t> list() const {
    std::vector<std::uint32_t> out = rows_;
    for (std::size_t i = out.size(); i < count_; ++i) out.push_back(static_cast<std::uint32_t>(i));
    return out;
  }
  std::size_t operator[](std::size_t i) const { return is_list_ ? rows_[i] : i; }

 private:
  std::vector<std::uint32_t> rows_;
  std::size_t count_;
  bool is_list_ = false;
};

/// Calls `f(i, value)` for each row, with the value as double.
///
/// Domain     a column of numbers
template <class F>
void for_each_number(const data::Column& column, const Rows& rows, F f) {
  std::visit(
      [&](const auto& values) {
        const base::StopPoint stop;
        stop.check();
        if constexpr (!std::is_same_v<std::decay_t<decltype(values)>, data::Words>)
          for (std::size_t i = 0; i < rows.size(); ++i) f(i, static_cast<double>(values[rows[i]]));
      },
      column.values);
}

/// A column with few distinct values: particle types, elements.
struct Labels {
  std::vector<std::string> names;      ///< distinct values as strings, sorted: numbers by value, strings alphabetically
  std::vector<double> values;          ///< numbers: the distinct values; NaN is the last
  std::vector<std::uint32_t> of_rows;  ///< one per row, index into `names`
};

/// Returns the distinct values of a column in the given rows.
///
/// `limit`    maximum number of distinct values
/// Result     no rows if there are more
Labels labels_of(const data::Column& column, const Rows& rows, std::size_t limit);

/// Maximum number of distinct types or elements; a column with more does not contain types.
inline constexpr std::size_t kMaxTypes = 65536;

/// The same; none, and an error is reported, if there are more values.
///
/// `part`     key of the error, see KeyFaults::error()
/// Domain     a table with this column
std::optional<Labels> require_labels(const data::Table& table, const Rows& rows, const std::string& column,
                                     std::size_t limit, const char* part, KeyFaults& faults,
                                     const std::string& remedy = {});

/// Returns the points whose coordinates are in three columns of numbers, multiplied by a factor.
///
/// Domain     a table with these columns
scene::PointArray points_of(const data::Table& table, const Rows& rows, const std::array<std::string, 3>& columns,
                            double scale = 1);

/// Returns the same, and removes the columns from the table. Their memory is returned piece by piece, so that they and
/// the points do not exist in full at the same time.
scene::PointArray take_points(data::Table& table, const Rows& rows, const std::array<std::string, 3>& columns);

/// "row 3 of melt.dump"
std::string row_name(const scene::PointsKeys& points, std::size_t row);

/// Checks that a file has a column, and that it is numeric if `is_number`. If not, reports the available columns.
bool require_column(const data::FrameInfo& info, const std::string& name, bool is_number, const std::string& part,
                    KeyFaults& faults);

/// Returns a column to which the format of the file gives a meaning; empty, and an error is reported, if the file has
/// none.
///
/// `role`     the column of data::Roles
/// `meaning`  "column of particle types"
std::string require_role(const data::FrameInfo& info, const std::string& role, const char* meaning, const char* part,
                         KeyFaults& faults);

/// Returns rows ascending by particle id; rows with equal ids keep their order, and those without an id are last.
///
/// `selected`  ascending; empty: all rows
/// `repeated`  receives the number of rows with the same id as the one before
/// Cost        one pass if the ids ascend, or are 1 to N in any order; else a sort
Rows rows_by_id(const data::Column& ids, std::vector<std::uint32_t> selected, std::size_t& repeated);

/// Adds the column `speed` to the columns of a frame, if the file lacks it and it can be computed: from vx, vy and vz,
/// or from the components of velocity, velocities, vel or velo.
void add_derived_columns(data::FrameInfo& info);

/// The file's names of the three components of the velocity; empty if it has none.
std::vector<std::string> velocity_of(const data::FrameInfo& info);

/// Returns the columns of the file that a column is computed from; empty if the file contains it.
std::vector<std::string> sources_of(const data::FrameInfo& info, const std::string& column);

/// Adds `speed` to a table, the length of the vector of the source columns.
///
/// Domain     a table with the columns of sources_of(), all numeric
void compute_speed(const std::vector<std::string>& sources, data::Table& table);

}  // namespace orrery::points
