// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace orrery::base {

/// Appends printf output of any length to a string.
[[gnu::format(printf, 2, 3)]] void append(std::string& out, const char* format, ...);

/// Formats a size in bytes: "49.4 MiB".
std::string bytes_text(std::uint64_t bytes);

/// Replaces control characters, which could control the terminal, by question marks; keeps tabs.
std::string printable(std::string_view text);
/// The same for a text of several lines: also keeps newlines.
std::string printable_lines(std::string_view text);

/// Length of the UTF-8 character at a position; 0 if the bytes are not valid UTF-8, or if it is a control character or
/// another character that XML does not allow.
///
/// Domain     at < text.size()
std::size_t printable_length(std::string_view text, std::size_t at);
/// True if a text consists of such characters.
bool is_printable(std::string_view text);

/// Converts ASCII letters to lower case.
std::string lower(std::string_view text);

/// Quotes a word for a POSIX shell; a word without special characters is returned unchanged.
std::string shell_quoted(const std::string& word);

/// Returns the candidate closest to a misspelt word.
///
/// Result     the first of equally close candidates; empty if more than a third of the letters, or the only letter,
///            would have to change
/// Cost       number of candidates times the square of the word length
std::string closest(std::string_view wrong, const std::vector<std::string>& candidates);

/// Returns "did you mean `samples`?", or an empty string if no candidate is close.
std::string did_you_mean(std::string_view wrong, const std::vector<std::string>& candidates);

/// Returns whether a list contains a name.
bool contains(const std::vector<std::string>& names, std::string_view name);

/// Joins names: "a, b, c".
std::string joined(const std::vector<std::string>& names, const char* separator = ", ");

/// Encodes bytes in base64 with padding and without line breaks.
///
/// Result     4 characters for every 3 bytes, rounded up
/// Reference  rfc4648, section 4
std::string base64(std::string_view bytes);

}  // namespace orrery::base
