// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "data/byte_source.h"

namespace orrery::data {

/// Reads a text line by line, and skips lines fast.
class TextCursor {
 public:
  struct Place {
    std::uint64_t offset = 0;
    std::uint64_t line = 1;
  };

  explicit TextCursor(const ByteSource& bytes, Place place = {0, 1}) : bytes_(&bytes), place_(place) {}

  /// The next line.
  Place place() const { return place_; }
  std::uint64_t offset() const { return place_.offset; }
  std::uint64_t line() const { return place_.line; }
  bool at_end() const { return place_.offset >= bytes_->size(); }

  /// Reads a line, without its end.
  ///
  /// Result     false at the end of the file
  /// Errors     base::Error: kIo; kBadData for a line that is too long
  bool next(std::string& text);
  /// As next(), after skipping lines of white space.
  bool next_filled(std::string& text);

  /// Skips lines.
  ///
  /// Result     how many there were, up to `count`
  std::uint64_t skip(std::uint64_t count);

 private:
  bool fill(std::size_t count);

  const ByteSource* bytes_;
  Place place_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0;  ///< of the unread bytes in the buffer
};

/// A text without white space at its ends.
std::string_view trimmed(std::string_view text);

/// The words of a text, which are separated by any of these characters.
std::vector<std::string_view> words_of(std::string_view text, std::string_view separators = " \t\r");

/// Reads an integer that is the whole word.
///
/// Result     false unless it is one
bool parse_integer(std::string_view word, std::int64_t& value);

}  // namespace orrery::data
