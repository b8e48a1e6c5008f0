// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace orrery::data {

/// Parses a word as a number, correctly rounded. Exponents may be those of Fortran, with d. Numbers that are too large
/// for a double are infinite.
///
/// Result     false unless the whole word is a number
bool parse_number(std::string_view word, double& value);

/// Parses a word as an integer.
///
/// Result     false unless the whole word is an integer of 64 bits
bool parse_integer(std::string_view word, std::int64_t& value);

}  // namespace orrery::data
