// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

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
  /// True if all values are integers, some of which a float64 cannot represent. An int64 cannot represent missing
  /// values.
  bool is_large_integer() const { return is_number() && has_large_integers && !has_fractions && !has_missing; }
};

/// Returns whether a word stands for a missing value: NA, N/A, n/a, #N/A, <NA>, null, NULL, None.
bool is_missing_marker(std::string_view word);

}  // namespace orrery::data
