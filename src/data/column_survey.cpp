// SPDX-License-Identifier: Apache-2.0
#include "data/column_survey.h"

#include <algorithm>
#include <array>

#include "data/text_cursor.h"
#include "data/text_rows.h"

namespace orrery::data {

void ColumnSurvey::add(std::string_view value, bool value_is_quoted, std::uint64_t line) {
  constexpr std::int64_t kLargestExact = std::int64_t{1} << 53;
  if (value.empty()) {
    has_missing = true;
    return;
  }
  is_quoted = is_quoted && value_is_quoted;
  std::int64_t integer = 0;
  double number = 0;
  if (value.find('.') == std::string_view::npos && parse_integer(value, integer)) {
    has_large_integers = has_large_integers || integer > kLargestExact || integer < -kLargestExact;
    number = static_cast<double>(integer);
  } else if (parse_number(value, number)) {
    has_fractions = true;
  } else {
    if (is_missing_marker(value)) {
      has_missing = has_markers = true;
    } else if (first_word_line == 0) {
      first_word_line = line;
      first_word = value;
    }
    return;
  }
  has_numbers = true;
  largest = std::max(largest, number);
}

void ColumnSurvey::add(const ColumnSurvey& later) {
  has_numbers = has_numbers || later.has_numbers;
  has_fractions = has_fractions || later.has_fractions;
  has_large_integers = has_large_integers || later.has_large_integers;
  has_missing = has_missing || later.has_missing;
  has_markers = has_markers || later.has_markers;
  is_quoted = is_quoted && later.is_quoted;
  largest = std::max(largest, later.largest);
  if (first_word_line == 0) {
    first_word_line = later.first_word_line;
    first_word = later.first_word;
  }
}

bool is_missing_marker(std::string_view word) {
  constexpr std::array<std::string_view, 8> kMarkers = {"NA", "N/A", "n/a", "#N/A", "<NA>", "null", "NULL", "None"};
  return std::find(kMarkers.begin(), kMarkers.end(), word) != kMarkers.end();
}

}  // namespace orrery::data
