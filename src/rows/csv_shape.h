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
  char separator = ',';                   ///< ' ': any number of blanks and tabs
  std::uint64_t begin = 0;                ///< offset of the first row of values
  std::uint64_t first_line = 1;           ///< its line number
  bool has_header = false;                ///< otherwise the columns are named column1, column2 ..
  std::vector<data::ColumnInfo> columns;  ///< kFloat64, kInt64 or kText
};

/// Examines up to 1000 rows after comments, which begin with #, % or //; those between rows are as in is_comment().
///
/// - The separator is the first of tab, semicolon, comma and blank that divides all of these rows into equally many
///   values, at least two.
/// - The first row is the header if none of its values is a number; otherwise the last comment is, if it has as many
///   words as the rows have values.
/// - The types of columns are those of set_types(), as far as the examined rows show.
///
/// Errors     base::Error: kBadData for a line that is too long; kIo
CsvShape csv_shape(const data::ByteSource& bytes);

/// Sets the types of columns. A column has numbers if all of its values are numbers or missing. They are integers of 64
/// bits if all are integers, of which a float64 cannot represent some. If all values of a column are quoted, but not
/// those of all columns, then it has strings.
void set_types(std::vector<data::ColumnInfo>& columns, const std::vector<data::ColumnSurvey>& surveys);

/// A value of a row, without quotes and blanks around it.
struct CsvValue {
  std::string text;
  bool is_quoted = false;
};
std::vector<CsvValue> split_row(std::string_view line, char separator);

}  // namespace orrery::rows
