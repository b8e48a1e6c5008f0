// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "base/error.h"
#include "base/stop_point.h"
#include "data/table.h"
#include "scene/diagnostic.h"

namespace orrery::points {

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

/// Diagnostics about the keys of a points table.
class KeyFaults {
 public:
  explicit KeyFaults(std::string key) : key_(std::move(key)) {}

  /// Adds an error about a key.
  ///
  /// `part`     part of the key: ".radius.column"; empty: the whole table
  void error(const std::string& part, std::string text, base::ErrorKind kind = base::ErrorKind::kBadData) {
    diagnostics_.push_back({base::Severity::kError, key_ + part, std::move(text), kind});
    has_errors_ = true;
  }
  /// Adds the errors that parsing the text of a key has thrown, with their places in the text.
  void error(const std::string& part, const base::Error& thrown);
  void warning(const std::string& part, std::string text) {
    diagnostics_.push_back({base::Severity::kWarning, key_ + part, std::move(text)});
  }
  bool has_errors() const { return has_errors_; }
  std::vector<scene::SceneDiagnostic> take() { return std::move(diagnostics_); }

 private:
  std::string key_;
  std::vector<scene::SceneDiagnostic> diagnostics_;
  bool has_errors_ = false;
};

/// Checks that a file has a column, and that it is numeric if `is_number`. If not, reports the available columns.
bool require_column(const data::FrameInfo& info, const std::string& name, bool is_number, const std::string& part,
                    KeyFaults& faults);

/// Returns "x, y, z, ... (3 more)".
std::string column_names(const data::FrameInfo& info);

/// Returns rows ascending by particle id; rows with equal ids keep their order, and those without an id are last.
///
/// `selected`  ascending; empty: all rows
/// `repeated`  receives the number of rows with the same id as the preceding row in this order
/// Cost        one pass if the ids ascend, or are 1 to N in any order; else a sort
Rows rows_by_id(const data::Column& ids, std::vector<std::uint32_t> selected, std::size_t& repeated);

}  // namespace orrery::points
