// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "data/byte_source.h"

namespace orrery::data {

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
std::string_view trimmed(std::string_view text);

/// Splits a string into words separated by any of these characters.
std::vector<std::string_view> words_of(std::string_view text, std::string_view separators = " \t\r");

/// Parses a word as an integer.
///
/// Result     false unless the whole word is an integer
bool parse_integer(std::string_view word, std::int64_t& value);

}  // namespace orrery::data
