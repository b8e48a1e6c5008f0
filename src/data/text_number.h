// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

/// Fast parsing of numbers in text. The text must be followed by kTextPadding bytes that belong to no number, because
/// the parser does not check for its end.
namespace orrery::data {

inline constexpr std::size_t kTextPadding = 24;

// Powers of ten. At namespace scope, because functions would copy them to the stack.
inline constexpr std::uint64_t kIntegerPowers[] = {1, 10, 100, 1000, 10000, 100000, 1000000, 10000000, 100000000};
inline constexpr double kPowers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                     1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

/// Eight characters in one word. The branch at the end of a loop over digits would be mispredicted.
class CharacterBlock {
 public:
  explicit CharacterBlock(const char* at) {
    static_assert(std::endian::native == std::endian::little);
    std::memcpy(&word_, at, sizeof word_);
    word_ ^= 0x3030303030303030;  // maps digits to their values
  }

  /// Returns a mask with the top bit of each character that is not a digit.
  std::uint64_t others() const {
    return (((word_ & 0x7f7f7f7f7f7f7f7f) + 0x7676767676767676) | word_) & 0x8080808080808080;
  }

  /// Returns the number that the first `count` digits form.
  ///
  /// Domain     1 <= count <= 8
  std::uint64_t value(unsigned count) const {
    std::uint64_t word = word_ << (64 - 8 * count);  // as if preceded by zeros
    word = word * 10 + (word >> 8);
    word = (((word & 0x000000ff000000ff) * (100 + (std::uint64_t{1000000} << 32))) +
            (((word >> 16) & 0x000000ff000000ff) * (1 + (std::uint64_t{10000} << 32)))) >>
           32;
    return word & 0xffffffff;
  }

  /// Removes a character and appends `next`, the ninth character.
  void remove(unsigned index, char next) {
    const std::uint64_t before = (std::uint64_t{1} << (8 * index)) - 1;
    const auto last = static_cast<std::uint64_t>(static_cast<unsigned char>(next ^ 0x30)) << 56;
    word_ = (word_ & before) | ((word_ >> 8) & ~before) | last;
  }

 private:
  std::uint64_t word_ = 0;
};

/// Index of the first character that CharacterBlock::others() marks; 8 if there is none.
inline unsigned first_of(std::uint64_t marks) { return static_cast<unsigned>(std::countr_zero(marks)) / 8; }

/// Appends the leading digits of a text to `value`, which wraps around beyond 64 bits.
///
/// Result     the end of the digits
inline const char* scan_digits(const char* at, std::uint64_t& value) {
  for (;;) {
    const CharacterBlock characters(at);
    const unsigned count = first_of(characters.others());
    if (count > 0) value = value * kIntegerPowers[count] + characters.value(count);
    at += count;
    if (count < 8) return at;
  }
}

/// Reads any number, correctly rounded.
///
/// Result     the end of the number; null if there is none
const char* scan_any_number(const char* at, double& value);

/// Like scan_any_number(), but fast for numbers of up to eight digits with a decimal point.
inline const char* scan_number(const char* at, double& value) {
  // Parsing continues at the end of a number, so computing this end should take as few operations as possible.
  const unsigned sign = *at == '-' ? 1 : 0;
  const CharacterBlock characters(at);
  const std::uint64_t others = characters.others() & ~(std::uint64_t{sign} << 7);
  const std::uint64_t behind_point = others & (others - 1);
  const unsigned point = first_of(others);
  const unsigned far_end = 8 + first_of(CharacterBlock(at + 8).others());
  const unsigned end = behind_point != 0 ? first_of(behind_point) : far_end;
  const unsigned count = end - sign - 1;
  const char after = static_cast<char>(at[end] | 0x20);
  if (point == 8 || at[point] != '.' || count - 1 >= 8 || after == 'e' || after == 'd')
    return scan_any_number(at, value);
  CharacterBlock digits(at + sign);
  digits.remove(point - sign, at[sign + 8]);
  // Both numbers are exact, hence the quotient is correctly rounded.
  const double magnitude =
      static_cast<double>(static_cast<std::int64_t>(digits.value(count))) / kPowers[end - point - 1];
  // Branchless, because signs are unpredictable.
  value = std::bit_cast<double>(std::bit_cast<std::uint64_t>(magnitude) | std::uint64_t{sign} << 63);
  return at + end;
}

/// Reads an integer.
///
/// Result     the end of the integer; null if there is none, or if it exceeds 64 bits
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

/// Parses a word as a number, as read_text_rows() does, or as an integer; false unless the whole word is one.
bool parse_number(std::string_view word, double& value);
bool parse_integer(std::string_view word, std::int64_t& value);

}  // namespace orrery::data
