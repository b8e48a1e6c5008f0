// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "data/byte_source.h"
#include "rows/ply_header.h"

namespace orrery::rows {

/// Reads values in sequence from the data after the header. In an ASCII file, each row is one line.
///
/// Cost       2 MiB of memory
class PlyCursor {
 public:
  /// `begin`    offset of the first data byte, `line` its line number
  PlyCursor(const data::ByteSource& bytes, std::uint64_t begin, PlyEncoding encoding, int line);

  /// Advances to the next row; skips blank lines.
  ///
  /// Errors     base::Error: kIo; kBadData for a line that is too long
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
  void skip_bytes(std::uint64_t bytes);

  std::uint64_t bytes_left() const { return static_cast<std::uint64_t>(end_ - at_) + bytes_->size() - next_; }
  /// Returns why the last take or skip failed.
  std::string fault() const;
  /// Returns the next word in the row, truncated if it is long.
  std::string word() const;

 private:
  void fill();
  void find_row_end();
  void skip_blanks();
  void step_over_line_end();
  bool take_word(double& value);

  const data::ByteSource* bytes_;
  std::uint64_t next_;  ///< offset of the first byte behind the buffer
  std::vector<char> buffer_;
  const char* at_ = nullptr;
  const char* end_ = nullptr;  ///< of the bytes in the buffer
  const char* row_end_ = nullptr;
  int line_, row_line_ = 0;
  bool ascii_, is_big_endian_, is_bad_length_ = false;
};

}  // namespace orrery::rows
