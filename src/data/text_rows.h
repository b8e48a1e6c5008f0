// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "data/column_survey.h"
#include "data/table.h"

namespace orrery::data {

class ByteSource;
class Faults;

inline constexpr std::uint64_t kRowsToEnd = std::numeric_limits<std::uint64_t>::max();

/// A column of a text table: kFloat64, kInt64 or kText.
struct TextColumn {
  ColumnType type = ColumnType::kFloat64;
  bool is_wanted = true;  ///< false: skipped without being checked
};

/// Rows of a text table: one line each.
struct TextLayout {
  std::uint64_t begin = 0;          ///< offset of the first row
  std::uint64_t rows = kRowsToEnd;  ///< number of rows; kRowsToEnd: up to the end of the file, excluding blank lines
  std::uint64_t first_line = 1;     ///< line number of the first row
  char separator = ' ';          ///< ' ': any number of spaces and tabs; else one character, and values may be quoted
  bool allows_more = false;      ///< rows may have values beyond the last column
  char comment = '\0';           ///< begins a comment after the last value (only with separator ' '); 0: none
  bool allows_missing = false;   ///< an empty value (with a separator other than ' ') or a marker such as NA is NaN
  bool allows_comments = false;  ///< comments are skipped, see is_comment() (only up to the end of the file)
  bool surveys = false;          ///< all columns are surveyed, even those that are not wanted
  /// Number of bytes that a thread parses at a time; does not affect the result.
  std::uint64_t chunk_bytes = std::uint64_t{1} << 18;
  std::vector<TextColumn> columns;
};

struct TextTable {
  std::uint64_t rows = 0;
  std::vector<Values> values;         ///< one per column; empty if it is not wanted
  std::vector<ColumnSurvey> surveys;  ///< one per column, if requested
  std::uint64_t end = 0;              ///< offset after the last row
};

/// Parses the rows of a text table in parallel. Numbers are correctly rounded and independent of the locale; `nan`,
/// `inf`, and Fortran's exponents `d` and `D` are read. Lines may end in LF or CRLF.
///
/// Errors     base::Error(kBadData), thrown through `faults`: too few or too many values, malformed numbers, a file
///            that ends before the last row, each with its line
/// Cost       one pass over the bytes, two if the number of rows is not known; memory for the wanted columns, and a few
///            MiB per thread
TextTable read_text_rows(const ByteSource& bytes, const TextLayout& layout, Faults& faults);

/// Parses a number as in read_text_rows().
///
/// Result     false unless the whole word is a number
bool parse_number(std::string_view word, double& value);

}  // namespace orrery::data
