// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <unordered_map>
#include <utility>

#include "base/diagnostic.h"
#include "base/error.h"
#include "base/text.h"
#include "points/selection_code.h"

namespace orrery::points {
namespace {

/// Maximum length of a selection, bytes. Long lists of ids are pasted; a file passed by mistake is larger.
constexpr std::size_t kMaxLength = std::size_t{1} << 20;

/// Maximum nesting of parentheses, functions and prefixes: the parser recurses, and evaluation needs 8 KiB per level.
constexpr int kMaxDepth = 100;

/// Words of other languages and their replacements.
constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kForeignWords = {
    {{"and", "&&"}, {"or", "||"}, {"not", "!"}}};

struct Function {
  std::string_view name;
  SelectionOp op;
  bool takes_many;
};
constexpr Function kFunctions[] = {{"abs", SelectionOp::kAbs, false},
                                   {"sqrt", SelectionOp::kSqrt, false},
                                   {"min", SelectionOp::kMin, true},
                                   {"max", SelectionOp::kMax, true}};

bool is_digit(char c) { return c >= '0' && c <= '9'; }
/// Bytes of UTF-8 beyond ASCII count as letters.
bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || static_cast<unsigned char>(c) >= 0x80;
}
bool is_name(char c) { return is_letter(c) || is_digit(c) || c == '.'; }
bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

enum class Kind { kEnd, kNumber, kText, kName, kQuotedName, kSymbol };

struct Token {
  Kind kind = Kind::kEnd;
  Span span;
  std::string_view text;  ///< of a text or name, without quotes; of a symbol, verbatim
  double number = 0;
};

class Parser {
 public:
  explicit Parser(std::string_view text) {
    if (text.size() > kMaxLength)
      fail_selection("", {}, "the condition is longer than " + base::bytes_text(kMaxLength),
                     "select by ranges, or filter the file");
    code_.text = text;
    read();
  }

  SelectionCode parse() {
    if (token_.kind != Kind::kEnd) {
      parse_or();
      if (token_.kind != Kind::kEnd) fail_at_token("expected an operator", remedy_for_operator());
    }
    return std::move(code_);
  }

 private:
  // Tokens.

  void read() {
    const std::string_view all = code_.text;
    std::size_t at = next_;
    while (at < all.size() && is_blank(all[at])) ++at;
    token_ = {};
    token_.span = {at, at};
    next_ = at;
    if (at == all.size()) return;
    const char c = all[at];
    if (is_digit(c) || (c == '.' && at + 1 < all.size() && is_digit(all[at + 1]))) {
      read_number();
    } else if (c == '"' || c == '\'' || c == '`') {
      read_quoted(c);
    } else if (is_letter(c)) {
      read_name();
    } else {
      read_symbol();
    }
    next_ = token_.span.end;
  }

  void read_number() {
    const char* begin = code_.text.data() + token_.span.begin;
    const char* end = code_.text.data() + code_.text.size();
    const auto [stop, status] = std::from_chars(begin, end, token_.number);
    token_.kind = Kind::kNumber;
    token_.span.end = token_.span.begin + static_cast<std::size_t>(stop - begin);
    if (status != std::errc()) fail_at_token("number is out of range", "at most 1.8e308");
    if (stop != end && is_name(*stop)) {
      while (token_.span.end < code_.text.size() && is_name(code_.text[token_.span.end])) ++token_.span.end;
      fail_at_token("malformed number " + std::string(verbatim(token_.span)),
                    "a column whose name begins with a digit is written in backquotes");
    }
  }

  void read_quoted(char quote) {
    const std::size_t begin = token_.span.begin + 1, end = code_.text.find(quote, begin);
    token_.span.end = code_.text.size();
    if (end == std::string::npos) fail_at_token("quote is not closed", std::string("add ") + quote);
    token_.kind = quote == '`' ? Kind::kQuotedName : Kind::kText;
    token_.span.end = end + 1;
    token_.text = verbatim({begin, end});
    if (quote == '`' && end == begin) fail_at_token("no name between the backquotes", "write the name of a column");
  }

  void read_name() {
    const std::string& all = code_.text;
    std::size_t end = token_.span.begin;
    while (end < all.size() && is_name(all[end])) ++end;
    // The index of c_stress[1]; `in[` begins a list.
    while (end < all.size() && all[end] == '[' && verbatim({token_.span.begin, end}) != "in") {
      std::size_t close = end + 1;
      while (close < all.size() && is_name(all[close])) ++close;
      if (close == end + 1 || close >= all.size() || all[close] != ']') break;
      end = close + 1;
    }
    token_.kind = Kind::kName;
    token_.span.end = end;
    token_.text = verbatim(token_.span);
  }

  void read_symbol() {
    static constexpr std::string_view kSymbols[] = {"==", "!=", "<=", ">=", "&&", "||", "<", ">", "+",
                                                    "-",  "*",  "/",  "!",  "(",  ")",  "[", "]", ","};
    static constexpr std::pair<std::string_view, std::string_view> kForeign[] = {
        {"=", "equality is =="}, {"&", "write &&"}, {"|", "write ||"}, {"^", "write x * x"}, {"~", "write !"}};
    const std::string_view rest = std::string_view(code_.text).substr(token_.span.begin);
    token_.kind = Kind::kSymbol;
    for (const std::string_view symbol : kSymbols)
      if (rest.substr(0, symbol.size()) == symbol) {
        token_.span.end = token_.span.begin + symbol.size();
        token_.text = verbatim(token_.span);
        return;
      }
    token_.span.end = token_.span.begin + 1;
    for (const auto& [symbol, remedy] : kForeign)
      if (rest[0] == symbol[0]) fail_at_token("unknown operator " + std::string(symbol), std::string(remedy));
    fail_at_token("unexpected character", "columns with such names are written in backquotes");
  }

  std::string_view verbatim(Span span) const {
    return std::string_view(code_.text).substr(span.begin, span.end - span.begin);
  }
  bool is_symbol(std::string_view symbol) const { return token_.kind == Kind::kSymbol && token_.text == symbol; }
  bool is_word(std::string_view word) const { return token_.kind == Kind::kName && token_.text == word; }

  bool take(std::string_view symbol) {
    if (!is_symbol(symbol)) return false;
    read();
    return true;
  }

  [[noreturn]] void fail_at_token(const std::string& text, const std::string& remedy) const {
    fail_selection(code_.text, token_.span, text, remedy);
  }

  /// The remedy for a token where an operator is expected.
  std::string remedy_for_operator() const {
    for (const auto& [word, symbol] : kForeignWords)
      if (is_word(word)) return "write " + std::string(symbol);
    if (is_symbol(")")) return "no parenthesis is open";
    return "e.g. ==, &&, || or +";
  }

  // Steps.

  void emit(SelectionOp op, Span span, double number = 0, std::size_t index = 0) {
    code_.steps.push_back({op, span, number, index});
  }

  std::size_t column_index(std::string_view name) {
    const auto [found, is_new] = column_indices_.try_emplace(std::string(name), code_.columns.size());
    if (is_new) code_.columns.emplace_back(name);
    return found->second;
  }

  // Grammar, one function per precedence.

  void parse_or() {
    parse_and();
    while (is_symbol("||")) parse_binary(SelectionOp::kOr, &Parser::parse_and);
  }

  void parse_and() {
    parse_comparison();
    while (is_symbol("&&")) parse_binary(SelectionOp::kAnd, &Parser::parse_comparison);
  }

  std::optional<SelectionOp> comparison() const {
    static constexpr std::pair<std::string_view, SelectionOp> kComparisons[] = {
        {"==", SelectionOp::kEqual},     {"!=", SelectionOp::kUnequal}, {"<", SelectionOp::kLess},
        {"<=", SelectionOp::kLessEqual}, {">", SelectionOp::kGreater},  {">=", SelectionOp::kGreaterEqual}};
    for (const auto& [symbol, op] : kComparisons)
      if (is_symbol(symbol)) return op;
    return {};
  }

  void parse_comparison() {
    parse_sum();
    if (const auto op = comparison()) {
      parse_binary(*op, &Parser::parse_sum);
    } else if (is_word("in")) {
      parse_list();
    } else {
      return;
    }
    if (comparison() || is_word("in")) fail_at_token("comparisons cannot be chained", "write 1 < x && x < 2");
  }

  void parse_sum() {
    parse_product();
    while (is_symbol("+") || is_symbol("-"))
      parse_binary(is_symbol("+") ? SelectionOp::kAdd : SelectionOp::kSubtract, &Parser::parse_product);
  }

  void parse_product() {
    parse_operand();
    while (is_symbol("*") || is_symbol("/"))
      parse_binary(is_symbol("*") ? SelectionOp::kMultiply : SelectionOp::kDivide, &Parser::parse_operand);
  }

  /// Parses an operator and its right operand.
  void parse_binary(SelectionOp op, void (Parser::*parse_right)()) {
    const Span span = token_.span;
    read();
    (this->*parse_right)();
    emit(op, span);
  }

  void parse_operand() {
    if (++depth_ > kMaxDepth)
      fail_at_token("more than " + std::to_string(kMaxDepth) + " nested parentheses or prefixes", "simplify it");
    const Token token = token_;
    if (take("(")) {
      parse_or();
      close("(", token.span);
    } else if (take("!")) {
      parse_operand();
      emit(SelectionOp::kNot, token.span);
    } else if (take("-")) {
      parse_operand();
      emit(SelectionOp::kNegate, token.span);
    } else if (token.kind == Kind::kNumber) {
      read();
      emit(SelectionOp::kNumber, token.span, token.number);
    } else if (token.kind == Kind::kText) {
      read();
      emit(SelectionOp::kText, token.span, 0, code_.texts.size());
      code_.texts.emplace_back(token.text);
    } else if (token.kind == Kind::kQuotedName || token.kind == Kind::kName) {
      parse_name();
    } else {
      fail_at_token(token.kind == Kind::kEnd ? "the condition ends too early" : "expected a column, number or text",
                    "e.g. type == 2 && z > 0");
    }
    --depth_;
  }

  void parse_name() {
    const Token token = token_;
    if (token.kind == Kind::kName) {
      for (const auto& [word, symbol] : kForeignWords)
        if (is_word(word)) fail_at_token("unknown word " + std::string(word), "write " + std::string(symbol));
      if (is_word("in")) fail_at_token("expected a column before `in`", "e.g. chain in [\"A\", \"B\"]");
    }
    read();
    if (token.kind == Kind::kName && is_symbol("(")) {
      parse_call(token);
    } else {
      emit(SelectionOp::kColumn, token.span, 0, column_index(token.text));
    }
  }

  void parse_call(const Token& name) {
    const Function* function = nullptr;
    std::vector<std::string> names;
    for (const Function& known : kFunctions) {
      names.emplace_back(known.name);
      if (known.name == name.text) function = &known;
    }
    if (function == nullptr)
      fail_selection(code_.text, name.span, "unknown function " + std::string(name.text),
                     "functions are " + base::joined(names));
    const Span open = token_.span;
    read();
    int count = 0;
    do {
      parse_sum();
      // min(x, y, z) is min(min(x, y), z).
      if (++count > 1 && function->takes_many) emit(function->op, name.span);
    } while (take(","));
    close(name.text, open);
    if (function->takes_many ? count < 2 : count != 1)
      fail_selection(code_.text, name.span, std::string(name.text) + " with " + std::to_string(count) + " operands",
                     function->takes_many ? "two or more are needed" : "exactly one is allowed");
    if (!function->takes_many) emit(function->op, name.span);
  }

  void close(std::string_view what, Span open) {
    if (take(")")) return;
    if (token_.kind == Kind::kEnd)
      fail_selection(code_.text, open, std::string(what == "(" ? "parenthesis" : what) + " is not closed", "add )");
    fail_at_token("expected ) or an operator", remedy_for_operator());
  }

  void parse_list() {
    const Span in = token_.span;
    read();
    if (!take("[")) fail_at_token("expected a list after `in`", "e.g. type in [1, 2]");
    std::vector<double> numbers;
    std::vector<std::string> texts;
    do {
      const bool negative = take("-");
      if (token_.kind == Kind::kNumber) {
        numbers.push_back(negative ? -token_.number : token_.number);
      } else if (token_.kind == Kind::kText && !negative) {
        texts.emplace_back(token_.text);
      } else {
        fail_at_token("expected a number or a string", "e.g. type in [1, 2], chain in [\"A\", \"B\"]");
      }
      if (!numbers.empty() && !texts.empty()) fail_at_token("list of both numbers and strings", "use two lists");
      read();
    } while (take(","));
    if (!take("]")) fail_at_token("expected , or ]", "e.g. type in [1, 2]");
    if (texts.empty()) {
      std::sort(numbers.begin(), numbers.end());
      emit(SelectionOp::kInNumbers, in, 0, code_.number_lists.size());
      code_.number_lists.push_back(std::move(numbers));
    } else {
      emit(SelectionOp::kInTexts, in, 0, code_.text_lists.size());
      code_.text_lists.push_back(std::move(texts));
    }
  }

  SelectionCode code_;
  std::unordered_map<std::string, std::size_t> column_indices_;
  std::size_t next_ = 0;  ///< first byte behind token_
  Token token_;
  int depth_ = 0;
};

}  // namespace

SelectionCode parse_selection_code(std::string_view text) { return Parser(text).parse(); }

void fail_selection(const std::string& selection, Span span, const std::string& text, const std::string& remedy) {
  base::Diagnostic diagnostic;
  diagnostic.text = text;
  diagnostic.remedy = remedy;
  diagnostic.source_line = selection;
  diagnostic.column = selection.empty() ? 0 : static_cast<int>(span.begin) + 1;
  diagnostic.width = std::max(1, static_cast<int>(span.end - span.begin));
  throw base::Error(base::ErrorKind::kBadData, "invalid selection", {diagnostic});
}

}  // namespace orrery::points
