// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "data/table.h"
#include "points/selection_code.h"

namespace orrery::points {

/// Operations on blocks of rows. Operands are on two stacks of blocks, one of numbers and one of truth values.
enum class BlockOp {
  kLoad,      ///< pushes a column
  kConstant,  ///< pushes a number
  kNegate,
  kAbs,
  kSqrt,
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
  kMin,
  kMax,
  kEqual,  ///< compares two numbers and pushes a truth value, like the next five
  kUnequal,
  kLess,
  kLessEqual,
  kGreater,
  kGreaterEqual,
  kInNumbers,  ///< pushes whether a number is in a list
  kInTexts,    ///< pushes whether a text column's value is in a list
  kSameText,   ///< pushes whether two text columns are equal
  kNot,
  kAnd,
  kOr,
};

struct BlockStep {
  BlockOp op;
  double number = 0;                   ///< kConstant
  std::size_t column = 0, second = 0;  ///< indices into the selection's columns
  std::size_t list = 0;  ///< kInNumbers: index into the selection's lists; kInTexts: into the program's lists
};

/// A selection whose types are known.
struct SelectionProgram {
  std::vector<BlockStep> steps;                      ///< empty: all rows are selected
  std::vector<std::vector<std::string>> text_lists;  ///< ascending
  std::size_t number_depth = 0, truth_depth = 0;     ///< maximum depth of the two stacks, blocks
};

/// Determines the types of a selection's operands.
///
/// Errors     those of Selection::check()
SelectionProgram bind(const SelectionCode& code, const std::vector<data::ColumnInfo>& columns);

/// Evaluates a program.
///
/// Domain     a table with the columns that the program was bound to
std::vector<std::uint8_t> run(const SelectionProgram& program, const SelectionCode& code, const data::Table& table);

}  // namespace orrery::points
