// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace orrery::points {

/// A range of bytes in the text of a selection.
struct Span {
  std::size_t begin = 0, end = 0;
};

enum class TokenKind { kEnd, kNumber, kText, kName, kQuotedName, kSymbol };

struct Token {
  TokenKind kind = TokenKind::kEnd;
  Span span;
  std::string_view text;  ///< string or name without quotes; symbol verbatim
  double number = 0;
};

/// Throws base::Error(kBadData) for a position in a selection.
[[noreturn]] void fail_selection(const std::string& selection, Span span, const std::string& text,
                                 const std::string& remedy);

/// The tokens of a selection, one after the other.
class SelectionLexer {
 public:
  /// Starts at the first token.
  ///
  /// `text`     outlives this and the tokens
  explicit SelectionLexer(const std::string& text) : text_(text) {}

  /// Returns the next token; at the end of the text kEnd.
  ///
  /// `takes_word`   names may begin with a digit
  /// Errors         those of fail_selection()
  Token next(bool takes_word = false);

 private:
  void read_number(Token& token) const;
  void read_quoted(char quote, Token& token) const;
  void read_name(Token& token) const;
  void read_symbol(Token& token) const;
  std::string_view verbatim(Span span) const {
    return std::string_view(text_).substr(span.begin, span.end - span.begin);
  }
  [[noreturn]] void fail(const Token& token, const std::string& text, const std::string& remedy) const {
    fail_selection(text_, token.span, text, remedy);
  }

  const std::string& text_;
  std::size_t next_ = 0;  ///< first byte after the last token
};

}  // namespace orrery::points
