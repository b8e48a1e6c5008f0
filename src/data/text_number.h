// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

/// Numbers in text that is followed by kTextPadding bytes which belong to no number: there are no checks for the end.
namespace orrery::data {

inline constexpr std::size_t kTextPadding = 16;

/// Leading digits of a text, at most eight.
struct Digits {
  std::uint64_t value;
  unsigned count;
};

/// Reads eight bytes at once, because loops over digits mispredict their end.
inline Digits leading_digits(const char* at) {
  static_assert(std::endian::native == std::endian::little);
  std::uint64_t word = 0;
  std::memcpy(&word, at, sizeof word);
  word ^= 0x3030303030303030;
  // The top bit of each byte above 9; carries spoil only bytes behind the first of them.
  const std::uint64_t others = ((word + 0x7676767676767676) | word) & 0x8080808080808080;
  const unsigned count = static_cast<unsigned>(std::countr_zero(others)) / 8;
  if (count == 0) return {0, 0};
  word <<= 64 - 8 * count;  // as if preceded by zeros
  word = word * 10 + (word >> 8);
  word = (((word & 0x000000ff000000ff) * (100 + (std::uint64_t{1000000} << 32))) +
          (((word >> 16) & 0x000000ff000000ff) * (1 + (std::uint64_t{10000} << 32)))) >>
         32;
  return {word & 0xffffffff, count};
}

/// Appends all digits of a text to `value`, which may wrap around.
///
/// Result     the end of the digits
inline const char* scan_digits(const char* at, std::uint64_t& value) {
  constexpr std::uint64_t kPowers[] = {1, 10, 100, 1000, 10000, 100000, 1000000, 10000000, 100000000};
  for (;;) {
    const Digits digits = leading_digits(at);
    value = value * kPowers[digits.count] + digits.value;
    at += digits.count;
    if (digits.count < 8) return at;
  }
}

/// Reads a number for which scan_number() has no fast path.
const char* scan_number_slowly(const char* at, double& value);

/// Reads a number, correctly rounded.
///
/// Result     the end of the number; null if there is none
inline const char* scan_number(const char* at, double& value) {
  constexpr double kPowers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  constexpr std::int64_t kMaxPower = 22;  // 10^22 is the largest power of ten that is a double
  const bool is_negative = *at == '-';
  const char* p = at + (is_negative || *at == '+' ? 1 : 0);
  std::uint64_t mantissa = 0;
  const char* const whole = p;
  p = scan_digits(p, mantissa);
  auto digits = p - whole;
  std::int64_t exponent = 0;
  if (*p == '.') {
    const char* const fraction = p + 1;
    p = scan_digits(fraction, mantissa);
    exponent = fraction - p;
    digits += p - fraction;
  }
  if (digits == 0 || digits > 19) return scan_number_slowly(at, value);  // 19: any fit into 64 bits
  const char letter = static_cast<char>(*p | 0x20);
  if (letter == 'e' || letter == 'd') {
    const bool is_below = p[1] == '-';
    const char* const first = p + (is_below || p[1] == '+' ? 2 : 1);
    const Digits power = leading_digits(first);
    if (power.count == 0 || power.count > 4) return scan_number_slowly(at, value);
    p = first + power.count;
    exponent += is_below ? -static_cast<std::int64_t>(power.value) : static_cast<std::int64_t>(power.value);
  }
  // Both numbers are exact, hence one operation rounds correctly.
  constexpr std::uint64_t kMaxExact = std::uint64_t{1} << 53;
  if (mantissa > kMaxExact || exponent < -kMaxPower || exponent > kMaxPower) return scan_number_slowly(at, value);
  const auto exact = static_cast<double>(mantissa);
  const double magnitude = exponent < 0 ? exact / kPowers[-exponent] : exact * kPowers[exponent];
  value = is_negative ? -magnitude : magnitude;
  return p;
}

/// Reads an integer.
///
/// Result     the end of the integer; null if there is none, or none of 64 bits
inline const char* scan_integer(const char* at, std::int64_t& value) {
  const bool is_negative = *at == '-';
  const char* const first = at + (is_negative || *at == '+' ? 1 : 0);
  std::uint64_t magnitude = 0;
  const char* const end = scan_digits(first, magnitude);
  constexpr auto kMaxDigits = 19;
  const std::uint64_t limit = (std::uint64_t{1} << 63) - (is_negative ? 0 : 1);
  if (end == first || end - first > kMaxDigits || magnitude > limit) return nullptr;
  value = static_cast<std::int64_t>(is_negative ? 0 - magnitude : magnitude);
  return end;
}

}  // namespace orrery::data
