// SPDX-License-Identifier: Apache-2.0
#include "points/selection_lexer.h"

#include <algorithm>
#include <charconv>
#include <system_error>
#include <utility>
#include <vector>

#include "base/error.h"
#include "points/selection.h"

namespace orrery::points {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
/// Bytes of UTF-8 beyond ASCII count as letters.
bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || static_cast<unsigned char>(c) >= 0x80;
}
bool is_name(char c) { return is_letter(c) || is_digit(c) || c == '.'; }
bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

}  // namespace

void fail_selection(const std::string& selection, Span span, const std::string& text, const std::string& remedy) {
  base::Diagnostic diagnostic;
  diagnostic.text = text;
  diagnostic.remedy = remedy;
  diagnostic.source_line = selection;
  diagnostic.column = selection.empty() ? 0 : static_cast<int>(span.begin) + 1;
  diagnostic.width = std::max(1, static_cast<int>(span.end - span.begin));
  throw base::Error(base::ErrorKind::kBadData, "invalid selection", {diagnostic});
}

Token SelectionLexer::next(bool takes_word) {
  std::size_t at = next_;
  while (at < text_.size() && is_blank(text_[at])) ++at;
  Token token;
  token.span = {at, at};
  next_ = at;
  if (at == text_.size()) return token;
  const char c = text_[at];
  if (is_letter(c) || (takes_word && is_name(c))) {
    read_name(token);
  } else if (is_digit(c) || (c == '.' && at + 1 < text_.size() && is_digit(text_[at + 1]))) {
    read_number(token);
  } else if (c == '"' || c == '\'' || c == '`') {
    read_quoted(c, token);
  } else {
    read_symbol(token);
  }
  next_ = token.span.end;
  return token;
}

void SelectionLexer::read_number(Token& token) const {
  const char* begin = text_.data() + token.span.begin;
  const char* end = text_.data() + text_.size();
  const auto [stop, status] = std::from_chars(begin, end, token.number);
  token.kind = TokenKind::kNumber;
  token.span.end = token.span.begin + static_cast<std::size_t>(stop - begin);
  if (status != std::errc()) fail(token, "number is out of range", "at most 1.8e308");
  if (stop != end && is_name(*stop)) {
    while (token.span.end < text_.size() && is_name(text_[token.span.end])) ++token.span.end;
    fail(token, "malformed number " + std::string(verbatim(token.span)),
         "a column whose name begins with a digit is written in backquotes");
  }
}

void SelectionLexer::read_quoted(char quote, Token& token) const {
  const std::size_t begin = token.span.begin + 1, end = text_.find(quote, begin);
  token.span.end = text_.size();
  if (end == std::string::npos) fail(token, "quote is not closed", std::string("add ") + quote);
  token.kind = quote == '`' ? TokenKind::kQuotedName : TokenKind::kText;
  token.span.end = end + 1;
  token.text = verbatim({begin, end});
  if (quote == '`' && end == begin) fail(token, "no name between the backquotes", "write the name of a column");
}

void SelectionLexer::read_name(Token& token) const {
  const std::string& all = text_;
  std::size_t end = token.span.begin;
  while (end < all.size() && is_name(all[end])) ++end;
  // The index of c_stress[1]; `in[` begins a list.
  while (end < all.size() && all[end] == '[' && verbatim({token.span.begin, end}) != "in") {
    std::size_t close = end + 1;
    while (close < all.size() && is_name(all[close])) ++close;
    if (close == end + 1 || close >= all.size() || all[close] != ']') break;
    end = close + 1;
  }
  token.kind = TokenKind::kName;
  token.span.end = end;
  token.text = verbatim(token.span);
}

void SelectionLexer::read_symbol(Token& token) const {
  static constexpr std::string_view kSymbols[] = {"==", "!=", "<=", ">=", "&&", "||", "<", ">", "+", "-", "*",
                                                  "/",  "^",  "!",  "(",  ")",  "[",  "]", "{", "}", ":", ","};
  static constexpr std::pair<std::string_view, std::string_view> kForeign[] = {
      {"=", "equality is =="}, {"&", "write &&"}, {"|", "write ||"}, {"~", "write !"}, {"@", "e.g. name CA"}};
  const std::string_view rest = std::string_view(text_).substr(token.span.begin);
  token.kind = TokenKind::kSymbol;
  for (const std::string_view symbol : kSymbols)
    if (rest.substr(0, symbol.size()) == symbol) {
      token.span.end = token.span.begin + symbol.size();
      token.text = verbatim(token.span);
      return;
    }
  token.span.end = token.span.begin + 1;
  for (const auto& [symbol, remedy] : kForeign)
    if (rest[0] == symbol[0]) fail(token, "unknown operator " + std::string(symbol), std::string(remedy));
  fail(token, "unexpected character", "columns with such names are written in backquotes");
}

void require_closed(const std::string& selection) {
  SelectionLexer lexer(selection);
  std::vector<Span> open;
  bool is_in_braces = false;
  for (Token token = lexer.next(); token.kind != TokenKind::kEnd; token = lexer.next(is_in_braces)) {
    if (token.kind != TokenKind::kSymbol) continue;
    if (token.text == "{" || token.text == "}") is_in_braces = token.text == "{";
    if (token.text == "(") open.push_back(token.span);
    if (token.text != ")") continue;
    if (open.empty())
      fail_selection(selection, token.span, "this `)` closes nothing", "remove it, or open it with `(`");
    open.pop_back();
  }
  if (!open.empty()) fail_selection(selection, open.back(), "this `(` is not closed", "close it with `)`");
}

}  // namespace orrery::points
