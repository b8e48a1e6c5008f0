// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "format/ply_header.h"

namespace orrery::format {

/// Takes values one after the other out of the data behind the header. In an ascii file each row is one line.
class PlyCursor {
 public:
  /// `line` is that of the first byte of the data.
  PlyCursor(std::string_view data, PlyEncoding encoding, int line);

  /// Goes to the next row. Blank lines are no rows.
  void begin_row();
  /// False where something is left of the row.
  bool end_row();
  /// Of the row; 0 in a binary file.
  int line() const { return row_line_; }

  /// False where the row or the data end, or where an ascii value is no number.
  bool take(PlyType type, double& value);
  bool skip(const PlyProperty& property);
  /// Domain     a binary file that has as many
  void skip_bytes(std::uint64_t bytes) { at_ += bytes; }

  std::uint64_t bytes_left() const { return static_cast<std::uint64_t>(end_ - at_); }
  /// Why the last take or skip was false.
  std::string fault() const;
  /// The word that comes next in the row; the beginning of one that is long.
  std::string word() const;

 private:
  void skip_blanks();
  void step_over_line_end();
  bool take_word(double& value);

  const char* at_;
  const char* end_;
  const char* row_end_;
  int line_, row_line_ = 0;
  bool ascii_, swap_, is_bad_length_ = false;
};

}  // namespace orrery::format
