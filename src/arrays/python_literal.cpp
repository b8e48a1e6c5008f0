// SPDX-License-Identifier: Apache-2.0
#include "arrays/python_literal.h"

#include <charconv>
#include <cstddef>

#include <fmt/core.h>

namespace orrery::arrays {

namespace {

constexpr int kMaxDepth = 16;

using Kind = PythonLiteral::Kind;

class Parser {
 public:
  explicit Parser(std::string_view source) : source_(source) {}

  bool value(PythonLiteral& out, int depth) {
    skip_blanks();
    if (depth > kMaxDepth) return fail("it is nested too deeply");
    if (at_end()) return fail("it ends too early");
    switch (source_[at_]) {
      case '\'':
      case '"': return text(out);
      case '(': return sequence(out, Kind::kSequence, ')', depth);
      case '[': return sequence(out, Kind::kSequence, ']', depth);
      case '{': return sequence(out, Kind::kDict, '}', depth);
      default: return word(out);
    }
  }
  void skip_blanks() {
    while (!at_end() && std::string_view(" \t\r\n").find(source_[at_]) != std::string_view::npos) ++at_;
  }
  bool at_end() const { return at_ == source_.size(); }
  bool fail(const std::string& text) {
    if (fault_.empty()) fault_ = text;
    return false;
  }
  const std::string& fault() const { return fault_; }

 private:
  bool take(char c) {
    skip_blanks();
    if (at_end() || source_[at_] != c) return false;
    ++at_;
    return true;
  }

  bool sequence(PythonLiteral& out, Kind kind, char closing, int depth) {
    out.kind = kind;
    ++at_;
    while (!take(closing)) {
      PythonLiteral item;
      if (!value(item, depth + 1)) return false;
      out.items.push_back(std::move(item));
      if (kind == Kind::kDict) {
        if (!take(':')) return fail("`:` is missing after a key");
        PythonLiteral mapped;
        if (!value(mapped, depth + 1)) return false;
        out.items.push_back(std::move(mapped));
      }
      if (!take(',')) {
        if (!take(closing)) return fail(fmt::format("`{}` is missing", closing));
        return true;
      }
    }
    return true;
  }

  bool text(PythonLiteral& out) {
    out.kind = Kind::kText;
    const char quote = source_[at_++];
    while (!at_end() && source_[at_] != quote) {
      char c = source_[at_++];
      if (c == '\\') {
        if (at_end() || (source_[at_] != '\\' && source_[at_] != '\'' && source_[at_] != '"'))
          return fail("a string contains an escape sequence that is not supported");
        c = source_[at_++];
      }
      out.text += c;
    }
    if (at_end()) return fail("a string has no end");
    ++at_;
    return true;
  }

  bool word(PythonLiteral& out) {
    const std::string_view rest = source_.substr(at_);
    for (const std::string_view name : {"True", "False"})
      if (rest.starts_with(name)) {
        out.kind = Kind::kBool;
        out.integer = name == "True" ? 1 : 0;
        at_ += name.size();
        return true;
      }
    out.kind = Kind::kInteger;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), out.integer);
    if (error == std::errc::result_out_of_range) return fail("an integer is too large");
    if (error != std::errc()) return fail(fmt::format("unexpected `{}`", std::string(1, rest.front())));
    at_ += static_cast<std::size_t>(end - rest.data());
    if (!at_end() && source_[at_] == 'L') ++at_;  // Python 2
    return true;
  }

  std::string_view source_;
  std::size_t at_ = 0;
  std::string fault_;
};

}  // namespace

const PythonLiteral* PythonLiteral::find(std::string_view key) const {
  for (std::size_t i = 0; kind == Kind::kDict && i + 1 < items.size(); i += 2)
    if (items[i].is(Kind::kText) && items[i].text == key) return &items[i + 1];
  return nullptr;
}

std::string parse_python_literal(std::string_view source, PythonLiteral& out) {
  Parser parser(source);
  if (!parser.value(out, 0)) return parser.fault();
  parser.skip_blanks();
  return parser.at_end() ? "" : "unexpected characters after its end";
}

}  // namespace orrery::arrays
