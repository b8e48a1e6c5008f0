// SPDX-License-Identifier: Apache-2.0
#include "format/key_depth.h"

namespace orrery::format {
namespace {

/// Position in a text, with line and column.
class Cursor {
 public:
  explicit Cursor(std::string_view text) : text_(text) {}

  bool at_end() const { return at_ >= text_.size(); }
  char now() const { return text_[at_]; }
  bool begins(std::string_view word) const { return text_.substr(at_, word.size()) == word; }
  void step() {
    if (text_[at_] == '\n') {
      ++line_;
      column_ = 1;
    } else if ((static_cast<unsigned char>(text_[at_]) & 0xC0u) != 0x80u) {
      ++column_;
    }
    ++at_;
  }
  void step(std::size_t count) {
    for (; count > 0 && !at_end(); --count) step();
  }
  Place place() const { return {"", line_, column_, 1}; }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1, column_ = 1;
};

void skip_comment(Cursor& cursor) {
  while (!cursor.at_end() && cursor.now() != '\n') cursor.step();
}

/// Skips a TOML string of any of the four kinds. An unclosed string ends at the end of the line or of the text.
void skip_string(Cursor& cursor) {
  const char quote = cursor.now();
  const bool escapes = quote == '"';
  const std::string_view triple = escapes ? "\"\"\"" : "'''";
  const bool is_long = cursor.begins(triple);
  cursor.step(is_long ? 3 : 1);
  while (!cursor.at_end()) {
    if (escapes && cursor.now() == '\\') {
      cursor.step(2);
    } else if (is_long && cursor.begins(triple)) {
      cursor.step(3);
      // Up to two more quotes belong to the string.
      for (int i = 0; i < 2 && !cursor.at_end() && cursor.now() == quote; ++i) cursor.step();
      return;
    } else if (!is_long && (cursor.now() == quote || cursor.now() == '\n')) {
      cursor.step();
      return;
    } else {
      cursor.step();
    }
  }
}

}  // namespace

Place too_deep_key(std::string_view text) {
  Cursor cursor(text);
  // Keys are delimited by the other characters. Decimal points count as dots, too, which does no harm.
  for (int parts = 1; !cursor.at_end();) {
    switch (cursor.now()) {
      case '#': skip_comment(cursor); break;
      case '"':
      case '\'': skip_string(cursor); break;
      case '.':
        if (++parts > kDeepestKey) return cursor.place();
        cursor.step();
        break;
      case '=':
      case ',':
      case '[':
      case ']':
      case '{':
      case '}':
      case '\n':
        parts = 1;
        cursor.step();
        break;
      default: cursor.step();
    }
  }
  return {};
}

}  // namespace orrery::format
