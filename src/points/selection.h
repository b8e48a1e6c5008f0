// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "data/table.h"

/// Selection of the rows of a table. Pure functions, which read no data file.
namespace orrery::points {

class SelectionRun;

/// A step of a selection in postfix order: takes its operands from the stacks of a run, and pushes its result. Postfix
/// rather than a tree, to avoid recursion: a chain of a million `||` would be a million levels deep.
using SelectionStep = std::function<void(SelectionRun&)>;

/// A condition on text columns, which is tested once for each distinct string.
struct TextTest {
  std::size_t column = 0;          ///< index into the columns of the selection
  std::size_t other = 0;           ///< the column that must have the same string, if `is_same`
  bool is_same = false;            ///< false: the string must be in `words`
  std::vector<std::string> words;  ///< without a particular order
};

/// A condition on rows by others that meet one: those near them, or of the same group. It is tested for all rows before
/// the other steps.
struct RowTest {
  std::vector<SelectionStep> steps;  ///< of the condition on the others
  double distance = 0;               ///< of near rows: at most this far from one of the others; 0: of a group
  std::vector<std::size_t> columns;  ///< of the position, or of the group; indices into the columns of the selection
};

/// A condition on the rows of a table: `type == 2 && z > 0`, `element == "C" || !(chain in {A, B})`.
///
/// Operators by precedence, weakest first: `||` or `or`, `&&` or `and`, the prefix `!` or `not`, one of
/// `== != < <= > >= in`, `+ -`, `* /`, the prefix `-`, and `^`; parentheses; functions abs(x), sqrt(x), exp(x), log(x),
/// log10(x), floor(x), min(x, y, ...), max(x, y, ...). `x in [1, 5:8, 20:]` tests for numbers and closed ranges,
/// `chain in {A, B}` for strings; `id 1 5:8 20:` and `chain A B` are the same. Strings are quoted, except in these two,
/// and can be compared with ==, != and `in`. `within 5 of (CONDITION)` are the rows at most 5 from one that meets the
/// condition, which are rows of it, too; `same chain as (CONDITION)` those with the same value in a column; of the
/// column `residue`, which holds a name, in those that identify a residue. Columns are written by name, or `in
/// backquotes` if the name contains characters other than letters, digits, `_`, `.` and indices as in `c_stress[1]`.
///
/// Any comparison with NaN is false, even `!=`. Numbers are double: integers beyond 2^53 are rounded.
struct Selection {
  std::vector<std::string> columns;  ///< those that it reads, each once, in order of appearance
  std::vector<TextTest> text_tests;
  std::vector<RowTest> row_tests;    ///< each refers at most to those before it
  std::vector<SelectionStep> steps;  ///< empty: all rows are selected

  /// Returns for each row of a table whether it is selected, 1 or 0.
  ///
  /// Domain     a table with `columns`
  /// Cost       on one core 0.03 s for ten million rows of `type == 2 && z > 0`; memory one byte per row
  std::vector<std::uint8_t> evaluate(const data::Table& table) const;
};

/// A number for each row of a table, in the operators and functions of selections: `sqrt(vx^2 + vy^2)`.
struct Expression {
  Selection steps;  ///< leaves a number instead of a truth value

  const std::vector<std::string>& columns() const { return steps.columns; }
  /// Returns the values, one per row.
  ///
  /// Domain     a table with columns()
  std::vector<double> evaluate(const data::Table& table) const;
};

/// Parses a selection of the rows of a table with some columns. A blank string selects all rows.
///
/// `position` columns of the position
/// Errors     base::Error(kBadData) with one diagnostic: what is wrong, the remedy, and the selection as source line
///            with column and width. The caller sets file and line.
Selection parse_selection(std::string_view text, const std::vector<data::ColumnInfo>& columns,
                          const std::array<std::string, 3>& position = {"x", "y", "z"});

/// Parses an expression on the columns of a table; errors are those of parse_selection().
Expression parse_expression(std::string_view text, const std::vector<data::ColumnInfo>& columns);

/// The error that parsing a selection or an expression has thrown, with its place: "at character 5: unknown column; did
/// you mean `x`?".
std::string fault_text(const base::Error& error);

/// Requires that a selection closes the parentheses that it opens, so that it can be combined with others. Errors are
/// those of parse_selection(), but columns need not be known.
void require_closed(const std::string& selection);

}  // namespace orrery::points
