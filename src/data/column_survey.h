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
  bool has_fractions = false;       ///< numbers that are not integers of 64 bits
  bool has_large_integers = false;  ///< that a float64 cannot represent
  bool has_missing = false;         ///< empty values and markers
  bool has_markers = false;
  bool is_quoted = true;                                      ///< all values that are not empty are in quotes
  double largest = -std::numeric_limits<double>::infinity();  ///< number
  std::uint64_t first_word_line = 0;                          ///< of the first other value; 0: there is none
  std::string first_word;

  void add(std::string_view value, bool value_is_quoted, std::uint64_t line);
  /// Adds the survey of later lines.
  void add(const ColumnSurvey& later);

  /// Numbers with or without missing values, or no values at all.
  bool is_number() const { return first_word_line == 0 && (has_numbers || !has_markers); }
  /// Integers, of which a float64 cannot represent some. An int64 cannot represent missing values.
  bool is_large_integer() const { return is_number() && has_large_integers && !has_fractions && !has_missing; }
};

/// Returns whether a word stands for a missing value: NA, N/A, n/a, #N/A, <NA>, null, NULL, None.
bool is_missing_marker(std::string_view word);

}  // namespace orrery::data
