// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "data/byte_source.h"
#include "data/faults.h"
#include "data/text_number.h"

namespace orrery::data {

/// Maximum length of a line, bytes; a file with longer lines is not a text table.
inline constexpr std::size_t kMaxLineBytes = std::size_t{1} << 20;

/// Bytes behind the lines of TextLines that may be read.
inline constexpr std::size_t kTextPadding = kDecimalBytes;

/// Throws an error for a line that is longer.
///
/// `line`     its number; 0: unknown
[[noreturn]] inline void fail_as_too_long(const ByteSource& bytes, std::uint64_t line) {
  Faults(bytes.file()).fail(line, "a line is longer than 1 MiB", "the file is damaged, or not a text file");
}

/// Number of newlines in [begin, end).
std::uint64_t newline_count(const char* begin, const char* end);

/// The newline that ends a line of TextLines.
const char* line_end(const char* at);

/// The lines that begin in a range of a file. Every line ends in a newline, which is added to the last one if it is
/// missing, and kTextPadding newlines follow.
class TextLines {
 public:
  /// Reads the lines whose first byte is at `first` <= offset < `last`. Reuses the memory of the previous call.
  ///
  /// `is_line_start`  a line begins at `first`, even if no newline precedes it
  /// Errors           base::Error: kIo; kBadData for a line that is too long
  void read(const ByteSource& bytes, std::uint64_t first, std::uint64_t last, bool is_line_start);

  const char* begin() const { return buffer_.get() + begin_; }
  const char* end() const { return buffer_.get() + end_; }
  /// File offset of a byte of these lines.
  std::uint64_t offset_of(const char* at) const { return offset_ + static_cast<std::uint64_t>(at - buffer_.get()); }

  /// Number of lines.
  std::uint64_t count() const { return newline_count(begin(), end()); }
  /// Number of lines that are not blank.
  ///
  /// `skips_comments`  comments do not count
  std::uint64_t filled_count(bool skips_comments) const;

 private:
  void reserve(std::size_t count);

  std::unique_ptr<char[]> buffer_;
  std::size_t capacity_ = 0;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::uint64_t offset_ = 0;  ///< file offset of the buffer
};

constexpr bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

inline const char* skip_blanks(const char* at) {
  while (is_blank(*at)) ++at;
  return at;
}

/// Returns whether a line is a comment: # or %, followed by a space, the same character or the end of the line. A row
/// may begin with #ff0000.
///
/// `line`     ends in a newline or a null character
inline bool is_comment(const char* line) {
  const char* const sign = skip_blanks(line);
  const auto may_follow = [sign](char c) { return is_blank(c) || c == '\n' || c == '\0' || c == *sign; };
  return (*sign == '#' || *sign == '%') && may_follow(sign[1]);
}

/// Returns whether a line contains no row: it is blank, or a comment if comments are skipped.
inline bool has_no_row(const char* line, bool skips_comments) {
  return *skip_blanks(line) == '\n' || (skips_comments && is_comment(line));
}

/// Reads a text file line by line, and skips lines fast.
class TextCursor {
 public:
  struct Place {
    std::uint64_t offset = 0;
    std::uint64_t line = 1;
  };

  explicit TextCursor(const ByteSource& bytes, Place place = {0, 1}) : bytes_(&bytes), place_(place) {}

  /// The position of the next line.
  Place place() const { return place_; }
  std::uint64_t offset() const { return place_.offset; }
  std::uint64_t line() const { return place_.line; }
  bool at_end() const { return place_.offset >= bytes_->size(); }

  /// Reads a line, without its line ending.
  ///
  /// Result     false at the end of the file
  /// Errors     base::Error: kIo; kBadData for a line that is too long
  bool next(std::string& text);
  /// Like next(), but skips blank lines.
  bool next_filled(std::string& text);
  /// Returns whether next_filled() would find a line.
  bool has_filled() const;

  /// Skips lines.
  ///
  /// Result     number of lines skipped, at most `count`
  std::uint64_t skip(std::uint64_t count);

 private:
  bool fill(std::size_t count);

  const ByteSource* bytes_;
  Place place_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0;  ///< start of the unread bytes in the buffer
};

/// Removes white space at both ends of a string.
inline std::string_view trimmed(std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(" \t\r"), text.size());
  return text.substr(begin, text.find_last_not_of(" \t\r") + 1 - begin);
}

/// Splits a string into words separated by any of these characters.
inline std::vector<std::string_view> words_of(std::string_view text, std::string_view separators = " \t\r") {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t begin = std::min(text.find_first_not_of(separators, at), text.size());
    at = std::min(text.find_first_of(separators, begin), text.size());
    if (begin < at) words.push_back(text.substr(begin, at - begin));
  }
  return words;
}

}  // namespace orrery::data
