// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace orrery::base {

/// Parses a whole text as a number, as std::from_chars does: regardless of the locale.
///
/// `base`     of an integer; default: 10
/// Result     false for any other text
template <class T, class... Base>
bool from_text(std::string_view text, T& value, Base... base) {
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value, base...);
  return error == std::errc() && stop == end;
}

/// Returns the number that is the whole text, as from_text() parses it; empty if it is none.
template <class Number>
std::optional<Number> number_of(std::string_view text) {
  Number number{};
  return from_text(text, number) ? std::optional(number) : std::nullopt;
}

/// "1 sphere", "2 spheres".
std::string counted(std::uint64_t number, std::string_view noun);

/// Formats a size in bytes: "49.4 MiB".
std::string bytes_text(std::uint64_t bytes);

/// Replaces control characters, which could control the terminal, and bytes that are not UTF-8 by their values, e.g.
/// \x1b; keeps tabs.
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

/// Replaces all occurrences of a text.
std::string replaced(std::string text, std::string_view what, std::string_view by);

/// Quotes a word for a shell.
std::string quoted(const std::string& word);
/// The same for a terminal, where necessary: what is not printable becomes $'\033', which dash does not read.
std::string shell_quoted(const std::string& word);

/// True for the second and later bytes of a UTF-8 character.
inline bool continues_character(char c) { return (static_cast<unsigned char>(c) & 0xC0u) == 0x80u; }

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
