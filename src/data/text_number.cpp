// SPDX-License-Identifier: Apache-2.0
#include "data/text_number.h"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <limits>
#include <string>
#include <system_error>

#include "base/text.h"

namespace orrery::data {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool may_be_in_number(char c) {
  return is_digit(c) || c == '+' || c == '-' || c == '.' || c == '(' || c == ')' || c == '_' ||
         (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
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
    const auto [end, error] = std::from_chars(exponent.data(), exponent.data() + exponent.size(), value);
    constexpr std::int64_t kFar = std::int64_t{1} << 62;  // no mantissa has so many digits
    if (error != std::errc{}) value = exponent.front() == '-' ? -kFar : kFar;
    power += std::clamp(value, -kFar, kFar);
  }
  return power > 0 ? std::numeric_limits<double>::infinity() : 0.0;
}

/// Parses a whole word, without its sign, as a number.
bool parse_magnitude(std::string word, double& value) {
  // from_chars() also accepts a sign, and does not accept Fortran exponents.
  if (word.empty() || !(is_digit(word[0]) || word[0] == '.' || std::isalpha(static_cast<unsigned char>(word[0])) != 0))
    return false;
  if (is_digit(word[0]) || word[0] == '.')
    for (char& c : word)
      if (c == 'E' || c == 'd' || c == 'D') c = 'e';
  const char* const end = word.data() + word.size();
  const auto result = std::from_chars(word.data(), end, value);
  if (result.ptr != end) return false;
  if (result.ec == std::errc::result_out_of_range) value = out_of_range(word);
  return result.ec == std::errc{} || result.ec == std::errc::result_out_of_range;
}

/// Reads a number for which scan_any_number() has no fast path.
const char* scan_with_library(const char* at, double& value) {
  const char* end = at;
  while (may_be_in_number(*end)) ++end;
  const bool is_negative = *at == '-';
  const char* const first = at + (is_negative || *at == '+' ? 1 : 0);
  if (first > end || !parse_magnitude({first, end}, value)) return nullptr;
  if (is_negative) value = -value;
  return end;
}

}  // namespace

const char* scan_any_number(const char* at, double& value) {
  constexpr std::ptrdiff_t kMaxDigits = 19;  // any number with this many digits fits into 64 bits
  constexpr std::uint64_t kMaxExact = std::uint64_t{1} << 53;
  constexpr std::int64_t kMaxPower = std::size(kPowers) - 1;  // the largest power of ten that is a double
  const bool is_negative = *at == '-';
  const char* p = at + (is_negative || *at == '+' ? 1 : 0);
  std::uint64_t mantissa = 0;
  const char* const whole = p;
  p = scan_digits(p, mantissa);
  std::ptrdiff_t digits = p - whole;
  std::int64_t exponent = 0;
  if (*p == '.') {
    const char* const fraction = p + 1;
    p = scan_digits(fraction, mantissa);
    exponent = fraction - p;
    digits -= exponent;
  }
  if (digits == 0 || digits > kMaxDigits) return scan_with_library(at, value);
  const char letter = static_cast<char>(*p | 0x20);
  if (letter == 'e' || letter == 'd') {
    const bool is_below = p[1] == '-';
    const char* const first = p + (is_below || p[1] == '+' ? 2 : 1);
    const CharacterBlock characters(first);
    const unsigned count = first_of(characters.others());
    if (count == 0 || count == 8) return scan_with_library(at, value);
    const auto power = static_cast<std::int64_t>(characters.value(count));
    p = first + count;
    exponent += is_below ? -power : power;
  }
  // With both numbers exact, one operation is correctly rounded.
  if (mantissa > kMaxExact || exponent < -kMaxPower || exponent > kMaxPower) return scan_with_library(at, value);
  const auto exact = static_cast<double>(mantissa);
  value = exponent < 0 ? exact / kPowers[-exponent] : exact * kPowers[exponent];
  if (is_negative) value = -value;
  return p;
}

bool parse_number(std::string_view word, double& value) {
  constexpr std::size_t kLongest = 4096;  // no number has as many digits
  char padded[kLongest + kTextPadding];
  if (word.size() > kLongest) return false;
  std::memcpy(padded, word.data(), word.size());
  std::memset(padded + word.size(), '\n', kTextPadding);
  return scan_number(padded, value) == padded + word.size();
}

bool parse_integer(std::string_view word, std::int64_t& value) {
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  return base::from_text(word, value);
}

}  // namespace orrery::data
