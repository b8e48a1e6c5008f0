// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace orrery::data {

/// Parses a word as a number, correctly rounded. Exponents may be those of Fortran, with d. Numbers that are too large
/// for a double are infinite.
///
/// Result     false unless the whole word is a number
bool parse_number(std::string_view word, double& value);

/// Bytes from the start of a word that scan_decimal() may read.
inline constexpr std::size_t kDecimalBytes = 18;

/// Scans a decimal number of up to 15 digits, with a point behind at most seven of them: most numbers of text files, in
/// half the time of parse_number(), correctly rounded.
///
/// Domain     kDecimalBytes may be read
/// Result     the character after the number, which may belong to its word; null for other words
const char* scan_decimal(const char* at, double& value);

/// Parses a word as an integer.
///
/// Result     false unless the whole word is an integer of 64 bits
bool parse_integer(std::string_view word, std::int64_t& value);

}  // namespace orrery::data
