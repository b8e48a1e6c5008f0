// SPDX-License-Identifier: Apache-2.0
#include "data/text_cursor.h"

#include <algorithm>
#include <charconv>
#include <cstring>

#include "data/byte_source.h"
#include "data/faults.h"
#include "data/text_lines.h"

namespace orrery::data {
namespace {

constexpr std::size_t kFirstReadBytes = std::size_t{16} << 10;
constexpr std::size_t kSkipBytes = std::size_t{1} << 20;

}  // namespace

/// Replaces the buffer by the next bytes of the file.
///
/// Result     false at the end of the file
bool TextCursor::fill(std::size_t count) {
  if (at_end()) return false;
  buffer_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(count, bytes_->size() - place_.offset)));
  bytes_->read(place_.offset, buffer_.size(), buffer_.data());
  begin_ = 0;
  return true;
}

bool TextCursor::next(std::string& text) {
  text.clear();
  const std::uint64_t start = place_.offset;
  for (bool is_complete = false; !is_complete;) {
    if (begin_ == buffer_.size() && !fill(kFirstReadBytes)) break;
    const char* const begin = buffer_.data() + begin_;
    const char* const end = buffer_.data() + buffer_.size();
    const char* const newline = std::find(begin, end, '\n');
    text.append(begin, newline);
    is_complete = newline != end;
    const auto taken = static_cast<std::size_t>(newline - begin) + (is_complete ? 1 : 0);
    begin_ += taken;
    place_.offset += taken;
    if (text.size() > kMaxLineBytes)
      Faults(bytes_->file())
          .fail(place_.line, "a line is longer than 1 MiB", "the file is damaged, or not a text file");
  }
  if (place_.offset == start) return false;
  ++place_.line;
  if (text.ends_with('\r')) text.pop_back();
  return true;
}

bool TextCursor::next_filled(std::string& text) {
  while (next(text))
    if (text.find_first_not_of(" \t\r") != std::string::npos) return true;
  return false;
}

std::uint64_t TextCursor::skip(std::uint64_t count) {
  std::uint64_t skipped = 0;
  bool is_inside = false;  // of a line
  while (skipped < count && (begin_ < buffer_.size() || fill(kSkipBytes))) {
    const char* const begin = buffer_.data() + begin_;
    const char* end = buffer_.data() + buffer_.size();
    const std::uint64_t here = newline_count(begin, end);
    if (here > count - skipped || (here == count - skipped && end[-1] != '\n')) {
      const char* at = begin;
      for (; skipped < count; ++skipped)
        at = static_cast<const char*>(std::memchr(at, '\n', static_cast<std::size_t>(end - at))) + 1;
      end = at;
    } else {
      skipped += here;
    }
    is_inside = end[-1] != '\n';
    begin_ += static_cast<std::size_t>(end - begin);
    place_.offset += static_cast<std::uint64_t>(end - begin);
  }
  if (is_inside && skipped < count) ++skipped;  // the last line may lack its newline
  place_.line += skipped;
  return skipped;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(" \t\r"), text.size());
  return text.substr(begin, text.find_last_not_of(" \t\r") + 1 - begin);
}

std::vector<std::string_view> words_of(std::string_view text, std::string_view separators) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t begin = std::min(text.find_first_not_of(separators, at), text.size());
    at = std::min(text.find_first_of(separators, begin), text.size());
    if (begin < at) words.push_back(text.substr(begin, at - begin));
  }
  return words;
}

bool parse_integer(std::string_view word, std::int64_t& value) {
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  const char* const end = word.data() + word.size();
  const auto result = std::from_chars(word.data(), end, value);
  return result.ec == std::errc{} && result.ptr == end;
}

}  // namespace orrery::data
