// SPDX-License-Identifier: Apache-2.0
#include "data/text_number.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <iterator>
#include <limits>
#include <string>
#include <system_error>

#include "base/text.h"

namespace orrery::data {
namespace {

/// Parses a magnitude of few digits without an exponent: twice as fast as from_chars().
bool parse_short(std::string_view word, double& value) {
  constexpr double kPowers[] = {1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
  if (word.size() > std::size(kPowers) || word == ".") return false;
  std::uint64_t digits = 0;
  std::size_t point = word.size();
  for (std::size_t i = 0; i < word.size(); ++i) {
    const unsigned digit = static_cast<unsigned char>(word[i]) - unsigned{'0'};
    if (digit < 10) {
      digits = 10 * digits + digit;
    } else if (word[i] == '.' && point == word.size()) {
      point = i;
    } else {
      return false;
    }
  }
  // Of a fraction both numbers are exact, so that the quotient is correctly rounded.
  value = static_cast<double>(digits) / kPowers[point == word.size() ? 0 : word.size() - 1 - point];
  return true;
}

/// The magnitude of a number that is too large or too small for a double. Its exponent may be too large for an integer.
double out_of_range(std::string_view word) {
  const std::size_t letter = std::min(word.find('e'), word.size());
  const std::string_view mantissa = word.substr(0, letter);
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
  const auto digit = static_cast<std::int64_t>(mantissa.find_first_of("123456789"));
  // Power of ten of the first significant digit.
  std::int64_t power = static_cast<std::int64_t>(point) - digit;
  if (letter < word.size()) {
    const std::string_view exponent = word.substr(letter + 1 + (word[letter + 1] == '+' ? 1 : 0));
    std::int64_t value = 0;
    constexpr std::int64_t kFar = std::int64_t{1} << 62;  // no mantissa has so many digits
    if (!base::from_text(exponent, value)) value = exponent.front() == '-' ? -kFar : kFar;
    power += std::clamp(value, -kFar, kFar);
  }
  return power > 0 ? std::numeric_limits<double>::infinity() : 0.0;
}

/// Parses a magnitude that from_chars() does not accept: with a Fortran exponent, or out of range.
bool parse_unusual(std::string word, double& value) {
  if (std::isalpha(static_cast<unsigned char>(word[0])) != 0) return false;
  for (char& c : word)
    if (c == 'E' || c == 'd' || c == 'D') c = 'e';
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (error == std::errc::result_out_of_range) value = out_of_range(word);
  return stop == end;
}

}  // namespace

bool parse_number(std::string_view word, double& value) {
  const bool is_negative = word.starts_with('-');
  if (is_negative || word.starts_with('+')) word.remove_prefix(1);
  if (word.empty() || word[0] == '-') return false;  // from_chars() accepts a sign
  if (!parse_short(word, value) && !base::from_text(word, value) && !parse_unusual(std::string(word), value))
    return false;
  if (is_negative) value = -value;
  return true;
}

bool parse_integer(std::string_view word, std::int64_t& value) {
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  return base::from_text(word, value);
}

}  // namespace orrery::data
