// SPDX-License-Identifier: Apache-2.0
#include "format/key_depth.h"

namespace orrery::format {
namespace {

/// Walks over a text and knows its line and column.
class Walk {
 public:
  explicit Walk(std::string_view text) : text_(text) {}

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

void skip_comment(Walk& walk) {
  while (!walk.at_end() && walk.now() != '\n') walk.step();
}

/// A string of any of the four kinds, which begins here. One that is not closed ends with its line, or with the text.
void skip_string(Walk& walk) {
  const char quote = walk.now();
  const bool escapes = quote == '"';
  const std::string_view triple = escapes ? "\"\"\"" : "'''";
  const bool is_long = walk.begins(triple);
  walk.step(is_long ? 3 : 1);
  while (!walk.at_end()) {
    if (escapes && walk.now() == '\\') {
      walk.step(2);
    } else if (is_long && walk.begins(triple)) {
      walk.step(3);
      // Up to two quotes more belong to the string.
      for (int i = 0; i < 2 && !walk.at_end() && walk.now() == quote; ++i) walk.step();
      return;
    } else if (!is_long && (walk.now() == quote || walk.now() == '\n')) {
      walk.step();
      return;
    } else {
      walk.step();
    }
  }
}

}  // namespace

Place too_deep_key(std::string_view text) {
  Walk walk(text);
  // A key is what stands between two of the other signs; the dot of a number counts as well, which harms nobody.
  for (int parts = 1; !walk.at_end();) {
    switch (walk.now()) {
      case '#': skip_comment(walk); break;
      case '"':
      case '\'': skip_string(walk); break;
      case '.':
        if (++parts > kDeepestKey) return walk.place();
        walk.step();
        break;
      case '=':
      case ',':
      case '[':
      case ']':
      case '{':
      case '}':
      case '\n':
        parts = 1;
        walk.step();
        break;
      default: walk.step();
    }
  }
  return {};
}

}  // namespace orrery::format
