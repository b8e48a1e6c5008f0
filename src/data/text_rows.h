// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "data/table.h"

namespace orrery::data {

/// Statistics of the values of a text column, which determine its type.
struct ColumnSurvey {
  bool has_numbers = false;
  bool has_fractions = false;       ///< numbers that are not 64-bit integers
  bool has_large_integers = false;  ///< integers that a float64 cannot represent
  bool has_missing = false;         ///< empty values and missing-value markers
  bool has_markers = false;
  bool is_quoted = true;                                      ///< all non-empty values are in quotes
  double largest = -std::numeric_limits<double>::infinity();  ///< number
  std::uint64_t first_word_line = 0;  ///< line of the first value that is neither a number nor missing; 0: none
  std::string first_word;

  void add(std::string_view value, bool value_is_quoted, std::uint64_t line);
  /// Merges the survey of later lines.
  void add(const ColumnSurvey& later);

  /// True if all values are numbers or missing; also if there are no values.
  bool is_number() const { return first_word_line == 0 && (has_numbers || !has_markers); }
  /// True if all values are integers, some of which a float64 cannot represent, and none is missing.
  bool is_large_integer() const { return is_number() && has_large_integers && !has_fractions && !has_missing; }
};

/// Returns whether a word stands for a missing value: NA, N/A, n/a, #N/A, <NA>, null, NULL, None.
bool is_missing_marker(std::string_view word);

class ByteSource;
class Faults;

inline constexpr std::uint64_t kRowsToEnd = std::numeric_limits<std::uint64_t>::max();

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
  std::vector<ColumnInfo> columns;  ///< kFloat64, kInt64 or kText, with distinct names
  std::vector<std::string> wanted;  ///< distinct names of columns; the others are skipped without being checked
};

/// Throws an error if a file is far too short for the rows that its header declares, so that their memory is not
/// estimated. A few missing rows are reported by read_text_rows(), with the last line.
///
/// `count_line`   line that declares the number
void require_room(const ByteSource& bytes, const TextLayout& layout, std::uint64_t count_line, Faults& faults);

struct TextTable {
  Table table;                        ///< the wanted columns, in their order
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

}  // namespace orrery::data
