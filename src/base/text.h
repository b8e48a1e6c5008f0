// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace orrery::base {

/// Appends printf output of any length to a string.
[[gnu::format(printf, 2, 3)]] void append(std::string& out, const char* format, ...);

/// Formats a size in bytes: "49.4 MiB".
std::string bytes_text(std::uint64_t bytes);

/// Quotes a word for a POSIX shell; a word without special characters stays as it is.
std::string shell_quoted(const std::string& word);

}  // namespace orrery::base
