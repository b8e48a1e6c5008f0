// SPDX-License-Identifier: Apache-2.0
#include "points/select.h"

#include <utility>

#include "points/selection_code.h"
#include "points/selection_program.h"

namespace orrery::points {

Selection::Selection() : code_(std::make_shared<const SelectionCode>()) {}

const std::vector<std::string>& Selection::columns() const { return code_->columns; }

void Selection::check(const std::vector<data::ColumnInfo>& columns) const { points::bind(*code_, columns); }

std::vector<std::uint8_t> Selection::evaluate(const data::Table& table) const {
  std::vector<data::ColumnInfo> columns;
  for (const data::Column& column : table.columns) columns.push_back({column.name, column.type()});
  const SelectionProgram program = points::bind(*code_, columns);
  return run(program, *code_, table);
}

Selection parse_selection(std::string_view text) {
  Selection selection;
  selection.code_ = std::make_shared<const SelectionCode>(parse_selection_code(text));
  return selection;
}

}  // namespace orrery::points
