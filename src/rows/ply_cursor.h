// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "rows/ply_header.h"

namespace orrery::rows {

/// Reads values in sequence from the data after the header. In an ASCII file, each row is one line.
class PlyCursor {
 public:
  /// `line` is the line number of the first data byte.
  PlyCursor(std::string_view data, PlyEncoding encoding, int line);

  /// Advances to the next row; skips blank lines.
  void begin_row();
  /// Ends a row; false if the row has unread values left.
  bool end_row();
  /// Returns the line number of the row; 0 in a binary file.
  int line() const { return row_line_; }

  /// Reads a value; false at the end of the row or the data, or if an ASCII value is not a number.
  bool take(data::NumberType type, double& value);
  /// Skips a value or a list; false as for take(), and if the length of the list is invalid.
  bool skip(const PlyProperty& property);
  /// Skips bytes of a binary file.
  ///
  /// Domain     bytes <= bytes_left()
  void skip_bytes(std::uint64_t bytes) { at_ += bytes; }

  std::uint64_t bytes_left() const { return static_cast<std::uint64_t>(end_ - at_); }
  /// Returns why the last take or skip failed.
  std::string fault() const;
  /// Returns the next word in the row, truncated if it is long.
  std::string word() const;

 private:
  void skip_blanks();
  void step_over_line_end();
  bool take_word(double& value);

  const char* at_;
  const char* end_;
  const char* row_end_;
  int line_, row_line_ = 0;
  bool ascii_, is_big_endian_, is_bad_length_ = false;
};

}  // namespace orrery::rows
