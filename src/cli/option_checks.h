// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/arguments.h"

namespace orrery::cli {

/// Maximum number of threads: more than any machine has.
inline constexpr std::uint64_t kMaxThreads = 4096;

// Checks of option values. They replace CLI11's own, whose messages differ between versions.

/// Rejects a word that is not one of `names`, and suggests the closest one.
Check one_of(std::vector<std::string> names);

// The checks below that convert the value need Option::transform(); Option::check() keeps the typed text.

/// Accepts an integer in from..to. Removes leading zeros, which CLI11 would interpret as octal.
Check whole_number(std::uint64_t from, std::uint64_t to);

/// Returns the integer in a string that whole_number() accepts; 0 for other strings.
int integer_of(const std::string& text);

/// Accepts a finite number in from..to.
Check real_number(double from, double to);

/// Accepts a size such as 512M or 1.5G and converts it to bytes; K, M, G and T are powers of 1024.
Check byte_size();

/// Maximum time limit, one year in seconds: a longer time probably has the wrong unit.
inline constexpr double kLongestTime = 365.0 * 24 * 3600;
/// Minimum time limit, seconds; 0 would mean no limit.
inline constexpr double kShortestTime = 0.01;

/// Accepts a time from kShortestTime to kLongestTime, such as 90s, 5m, 1.5h or 1h30m, and converts it to seconds.
Check duration();

}  // namespace orrery::cli
