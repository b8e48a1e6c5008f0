// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace orrery::points {

/// A range of bytes in the text of a selection.
struct Span {
  std::size_t begin = 0, end = 0;
};

enum class SelectionOp {
  kNumber,
  kText,
  kColumn,
  kNegate,
  kNot,
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
  kEqual,
  kUnequal,
  kLess,
  kLessEqual,
  kGreater,
  kGreaterEqual,
  kInNumbers,
  kInTexts,
  kAnd,
  kOr,
  kAbs,
  kSqrt,
  kMin,
  kMax,
};

/// A step of a selection in postfix notation.
struct SelectionStep {
  SelectionOp op;
  Span span;              ///< position of the operand or operator
  double number = 0;      ///< kNumber
  std::size_t index = 0;  ///< kColumn: into columns; kText: into texts; kInNumbers, kInTexts: into the lists
};

/// A parsed selection: operands before their operator. Postfix rather than a tree, to avoid recursion: a chain of a
/// million `||` would be a million levels deep.
struct SelectionCode {
  std::string text;
  std::vector<SelectionStep> steps;
  std::vector<std::string> columns;
  std::vector<std::string> texts;
  std::vector<std::vector<double>> number_lists;  ///< ascending
  std::vector<std::vector<std::string>> text_lists;
};

/// Parses a selection without knowing the columns of the table.
///
/// Errors     those of parse_selection()
SelectionCode parse_selection_code(std::string_view text);

/// Throws base::Error(kBadData) for a position in a selection.
[[noreturn]] void fail_selection(const std::string& selection, Span span, const std::string& text,
                                 const std::string& remedy);

}  // namespace orrery::points
