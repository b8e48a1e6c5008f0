// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/arguments.h"

namespace orrery::cli {

/// More threads than any machine has; a number of another kind was meant.
inline constexpr std::uint64_t kMaxThreads = 4096;

// Checks of what is given to an option, in our own words: those of the library differ between its versions.

/// Refuses a word that is not among `names`, and says which one was meant.
Check one_of(std::vector<std::string> names);

// Those that say what they leave behind are given by transform(), for check() keeps what was typed.

/// Refuses what is no whole number from..to; leaves its digits without leading zeros, which would make them octal.
Check whole_number(std::uint64_t from, std::uint64_t to);

/// Refuses what is no finite number from..to.
Check real_number(double from, double to);

/// Refuses what is no size, as 512M or 1.5G; leaves bytes behind. K, M, G and T are powers of 1024.
Check byte_size();

/// A year: who asks for more has mistaken the unit.
inline constexpr double kLongestTime = 365.0 * 24 * 3600;
/// Nothing can be done in less, and none at all would mean no limit.
inline constexpr double kShortestTime = 0.01;

/// Refuses what is no time from kShortestTime to kLongestTime, such as 90s, 5m, 1.5h or 1h30m; leaves seconds behind.
Check duration();

}  // namespace orrery::cli
