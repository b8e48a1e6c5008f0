// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/arguments.h"

namespace orrery::cli {

/// More threads than any machine has.
inline constexpr std::uint64_t kMaxThreads = 4096;

// Checks of option values. They replace CLI11's own, whose messages differ between versions.

/// Rejects a word that is not one of `names`, and suggests the closest one.
Check one_of(std::vector<std::string> names);

// The checks below that convert the value need Option::transform(); Option::check() keeps the typed text.

/// Rejects everything but an integer from..to. Removes leading zeros, which CLI11 would take for octal.
Check whole_number(std::uint64_t from, std::uint64_t to);

/// The number in a text that whole_number() accepts; 0 if it is none.
int integer_of(const std::string& text);

/// Rejects everything but a finite number from..to.
Check real_number(double from, double to);

/// Rejects everything but a size such as 512M or 1.5G. Converts it to bytes; K, M, G and T are powers of 1024.
Check byte_size();

/// One year, in seconds; a longer time is rejected, since its unit is probably wrong.
inline constexpr double kLongestTime = 365.0 * 24 * 3600;
/// Seconds; 0 would mean no limit.
inline constexpr double kShortestTime = 0.01;

/// Rejects everything but a time from kShortestTime to kLongestTime, such as 90s, 5m, 1.5h or 1h30m. Converts it to
/// seconds.
Check duration();

}  // namespace orrery::cli
