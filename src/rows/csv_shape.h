// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "data/byte_source.h"
#include "data/column_survey.h"
#include "data/table.h"

namespace orrery::rows {

/// Layout of a text table, determined from its first lines.
struct CsvShape {
  char separator = ',';                   ///< ' ': any number of spaces and tabs
  std::uint64_t begin = 0;                ///< offset of the first row of values
  std::uint64_t first_line = 1;           ///< its line number
  bool has_header = false;                ///< otherwise the columns are named column1, column2 ..
  std::vector<data::ColumnInfo> columns;  ///< kFloat64, kInt64 or kText
};

/// Examines up to 1000 rows after the leading comments, which begin with #, % or //; comments between rows are those of
/// is_comment().
///
/// - The separator is the first of tab, semicolon, comma and space that splits all of these rows into the same number
///   of values, at least two.
/// - The first row is the header if none of its values is a number; otherwise, the last comment is the header if it has
///   as many words as the rows have values.
/// - Column types are determined by set_types() from the examined rows.
///
/// Errors     base::Error: kBadData for a line that is too long; kIo
CsvShape csv_shape(const data::ByteSource& bytes);

/// Sets the types of columns. A column is numeric if all of its values are numbers or missing. It is int64 if all are
/// integers and float64 cannot represent some of them. A column whose values are all quoted is text, unless this holds
/// for every column.
void set_types(std::vector<data::ColumnInfo>& columns, const std::vector<data::ColumnSurvey>& surveys);

/// A value of a row, without surrounding quotes and spaces.
struct CsvValue {
  std::string text;
  bool is_quoted = false;
};
std::vector<CsvValue> split_row(std::string_view line, char separator);

}  // namespace orrery::rows
