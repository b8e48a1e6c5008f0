// SPDX-License-Identifier: Apache-2.0
#include "base/text.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdint>

#include <fmt/core.h>

namespace orrery::base {

std::string counted(std::uint64_t number, std::string_view noun) {
  return fmt::format("{} {}{}", number, noun, number == 1 ? "" : "s");
}

std::string bytes_text(std::uint64_t bytes) {
  const char* unit = "KiB";
  double value = static_cast<double>(bytes) / 1024;
  for (const char* larger : {"MiB", "GiB", "TiB"}) {
    if (value < 1024) break;
    value /= 1024;
    unit = larger;
  }
  return fmt::format("{:.1f} {}", value, unit);
}

std::string printable(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = text[at] == '\t' ? 1 : printable_length(text, at);
    if (length > 0)
      out += text.substr(at, length);
    else
      out += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[at]));
    at += std::max<std::size_t>(length, 1);
  }
  return out;
}

std::string printable_lines(std::string_view text) {
  std::string out;
  for (std::size_t at = 0;;) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    out += printable(text.substr(at, end - at));
    if (end == text.size()) return out;
    out += '\n';
    at = end + 1;
  }
}

std::size_t printable_length(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned>(static_cast<unsigned char>(text[i])); };
  const unsigned lead = byte(at);
  if (lead < 0x80) return lead >= 0x20 && lead != 0x7F ? 1 : 0;
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || at + length > text.size()) return 0;
  unsigned code = lead & (0x7Fu >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if (!continues_character(text[at + i])) return 0;
    code = code << 6 | (byte(at + i) & 0x3Fu);
  }
  const bool is_overlong = code < (length == 4 ? 0x10000u : length == 3 ? 0x800u : 0x80u);
  const bool is_forbidden = code < 0xA0 || (code >= 0xD800 && code < 0xE000) || code == 0xFFFE || code == 0xFFFF;
  return is_overlong || is_forbidden || code > 0x10FFFF ? 0 : length;
}

bool is_printable(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = printable_length(text, at);
    if (length == 0) return false;
    at += length;
  }
  return true;
}

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

std::string quoted(const std::string& word) { return "'" + replaced(word, "'", "'\\''") + "'"; }

namespace {

/// The word as $'...', with octal escapes of all but printable characters: a terminal acts on control characters that
/// are pasted, even within quotes. Quotes, backslashes and `!`, the history of interactive shells, are escaped as well.
std::string escaped(const std::string& word) {
  std::string out = "$'";
  for (std::size_t at = 0; at < word.size();) {
    const std::size_t length =
        std::string_view("'\\!").find(word[at]) != std::string_view::npos ? 0 : printable_length(word, at);
    if (length > 0)
      out += word.substr(at, length);
    else
      out += fmt::format("\\{:03o}", static_cast<unsigned char>(word[at]));
    at += std::max<std::size_t>(length, 1);
  }
  return out + "'";
}

}  // namespace

std::string shell_quoted(const std::string& word) {
  static const std::string plain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-./:=,+@%^";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  return is_printable(word) ? quoted(word) : escaped(word);
}

namespace {

/// Returns the number of insertions, deletions, replacements and swaps of neighbouring letters between two words.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> two_back(b.size() + 1), back(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) back[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = back[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({back[j] + 1, row[j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], two_back[j - 2] + 1);
    }
    two_back.swap(back);
    back.swap(row);
  }
  return back[b.size()];
}

/// Maximum length of names to compare: longer names are not typed by hand and are expensive to compare.
constexpr std::size_t kLongestName = 64;

}  // namespace

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

std::string closest(std::string_view wrong, const std::vector<std::string>& candidates) {
  if (wrong.empty() || wrong.size() > kLongestName) return {};
  std::string best;
  std::size_t best_distance = 0;
  for (const std::string& candidate : candidates) {
    if (candidate.size() > kLongestName) continue;
    const std::size_t distance = edit_distance(lower(wrong), lower(candidate));
    const std::size_t letters = std::max(wrong.size(), candidate.size());
    const std::size_t allowed = letters < 2 ? 0 : std::max<std::size_t>(1, letters / 3);
    if (distance > allowed) continue;
    if (best.empty() || distance < best_distance) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

std::string did_you_mean(std::string_view wrong, const std::vector<std::string>& candidates) {
  const std::string best = closest(wrong, candidates);
  return best.empty() ? "" : "did you mean `" + best + "`?";
}

bool contains(const std::vector<std::string>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string joined(const std::vector<std::string>& names, const char* separator) {
  std::string out;
  for (const std::string& name : names) {
    if (!out.empty()) out += separator;
    out += name;
  }
  return out;
}

std::string base64(std::string_view bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out((bytes.size() + 2) / 3 * 4, '=');
  char* to = out.data();
  const auto add = [&](std::uint32_t word, int digits) {
    for (int k = 0; k < digits; ++k) *to++ = kDigits[word >> (18 - 6 * k) & 63];
  };
  const auto word_of = [&](std::size_t i, std::size_t count) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < count; ++k)
      word |= std::uint32_t{static_cast<unsigned char>(bytes[i + k])} << (16 - 8 * k);
    return word;
  };
  const std::size_t whole = bytes.size() - bytes.size() % 3;
  for (std::size_t i = 0; i < whole; i += 3) add(word_of(i, 3), 4);
  if (whole < bytes.size()) add(word_of(whole, bytes.size() - whole), static_cast<int>(bytes.size() - whole) + 1);
  return out;
}

}  // namespace orrery::base
