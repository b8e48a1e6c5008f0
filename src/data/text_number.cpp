// SPDX-License-Identifier: Apache-2.0
#include "data/text_number.h"

#include <locale.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>

#include "base/text.h"

namespace orrery::data {
namespace {

constexpr std::uint64_t kOnes = 0x0101010101010101;  ///< a factor: the same number in eight bytes
constexpr std::size_t kBlock = sizeof(std::uint64_t);

/// Eight characters, each less '0'.
std::uint64_t block_at(const char* at) {
  static_assert(std::endian::native == std::endian::little);
  std::uint64_t block = 0;
  std::memcpy(&block, at, kBlock);
  return block ^ '0' * kOnes;
}

/// The top bits of the bytes that are no digits.
std::uint64_t other_bytes(std::uint64_t block) {
  return (((block & 0x7f * kOnes) + 0x76 * kOnes) | block) & 0x80 * kOnes;
}

std::size_t first_byte(std::uint64_t marks) { return static_cast<std::size_t>(std::countr_zero(marks)) / 8; }

/// The number that the first digits of a block form.
///
/// Domain     1 <= count <= 8
std::uint64_t number_of(std::uint64_t block, std::size_t count) {
  block <<= 8 * (kBlock - count);  // as if preceded by zeros
  block = block * 10 + (block >> 8);
  constexpr std::uint64_t kPairs = 0x000000ff000000ff;
  return ((block & kPairs) * (100 + (std::uint64_t{1000000} << 32)) +
          (block >> 16 & kPairs) * (1 + (std::uint64_t{10000} << 32))) >>
         32;
}

/// Parses a magnitude that from_chars() does not accept: with a Fortran exponent, or out of range.
bool parse_unusual(std::string word, double& value) {
  if (std::isalpha(static_cast<unsigned char>(word[0])) != 0) return false;
  for (char& c : word)
    if (c == 'E' || c == 'd' || c == 'D') c = 'e';
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  // The host program may have set a locale with a decimal comma.
  static const locale_t c_locale = ::newlocale(LC_ALL_MASK, "C", nullptr);
  if (error == std::errc::result_out_of_range) value = ::strtod_l(word.c_str(), nullptr, c_locale);
  return stop == end;
}

}  // namespace

const char* scan_decimal(const char* at, double& value) {
  constexpr double kPowers[] = {1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
  constexpr std::uint64_t kIntegerPowers[] = {1, 10, 100, 1000, 10000, 100000, 1000000, 10000000};
  // Branches that depend on signs and digits would be mispredicted.
  const std::uint64_t sign = *at == '-' ? 1 : 0;
  at += sign;
  const std::uint64_t block = block_at(at), behind = block_at(at + kBlock), others = other_bytes(block);
  const std::size_t point = first_byte(others);
  if (point == kBlock || at[point] != '.') return nullptr;
  const std::uint64_t later = others & (others - 1);
  const std::size_t end = later != 0 ? first_byte(later) : kBlock + first_byte(other_bytes(behind)), count = end - 1;
  if (count == 0) return nullptr;
  const std::uint64_t before = (std::uint64_t{1} << 8 * point) - 1;
  const std::uint64_t digits = (block & before) | (block >> 8 & ~before) | behind << 56;  // without the point
  std::uint64_t number = number_of(digits, std::min(count, kBlock));
  if (count > kBlock) number = number * kIntegerPowers[count - kBlock] + number_of(behind >> 8, count - kBlock);
  // Both numbers are exact, so that the quotient is correctly rounded.
  const double magnitude = static_cast<double>(static_cast<std::int64_t>(number)) / kPowers[count - point];
  value = std::bit_cast<double>(std::bit_cast<std::uint64_t>(magnitude) | sign << 63);
  return at + end;
}

bool parse_number(std::string_view word, double& value) {
  const bool is_negative = word.starts_with('-');
  if (is_negative || word.starts_with('+')) word.remove_prefix(1);
  if (word.empty() || word[0] == '-') return false;  // from_chars() accepts a sign
  if (!base::from_text(word, value) && !parse_unusual(std::string(word), value)) return false;
  if (is_negative) value = -value;
  return true;
}

bool parse_integer(std::string_view word, std::int64_t& value) {
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  return base::from_text(word, value);
}

}  // namespace orrery::data
