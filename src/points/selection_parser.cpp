// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <optional>
#include <unordered_map>
#include <utility>

#include <fmt/core.h>

#include "base/diagnostic.h"
#include "base/error.h"
#include "base/text.h"
#include "points/selection_code.h"
#include "points/selection_lexer.h"

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
    if (token_.kind != TokenKind::kEnd) {
      parse_or();
      if (token_.kind != TokenKind::kEnd) fail_at_token("expected an operator", remedy_for_operator());
    }
    return std::move(code_);
  }

 private:
  // Tokens.

  void read() { token_ = lexer_.next(); }

  bool is_symbol(std::string_view symbol) const { return token_.kind == TokenKind::kSymbol && token_.text == symbol; }
  bool is_word(std::string_view word) const { return token_.kind == TokenKind::kName && token_.text == word; }

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
      fail_at_token(fmt::format("more than {} nested parentheses or prefixes", kMaxDepth), "simplify it");
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
    } else if (token.kind == TokenKind::kNumber) {
      read();
      emit(SelectionOp::kNumber, token.span, token.number);
    } else if (token.kind == TokenKind::kText) {
      read();
      emit(SelectionOp::kText, token.span, 0, code_.texts.size());
      code_.texts.emplace_back(token.text);
    } else if (token.kind == TokenKind::kQuotedName || token.kind == TokenKind::kName) {
      parse_name();
    } else {
      fail_at_token(
          token.kind == TokenKind::kEnd ? "the condition ends too early" : "expected a column, number or text",
          "e.g. type == 2 && z > 0");
    }
    --depth_;
  }

  void parse_name() {
    const Token token = token_;
    if (token.kind == TokenKind::kName) {
      for (const auto& [word, symbol] : kForeignWords)
        if (is_word(word)) fail_at_token("unknown word " + std::string(word), "write " + std::string(symbol));
      if (is_word("in")) fail_at_token("expected a column before `in`", "e.g. chain in [\"A\", \"B\"]");
    }
    read();
    if (token.kind == TokenKind::kName && is_symbol("(")) {
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
      fail_selection(code_.text, name.span, fmt::format("{} with {} operands", name.text, count),
                     function->takes_many ? "two or more are needed" : "exactly one is allowed");
    if (!function->takes_many) emit(function->op, name.span);
  }

  void close(std::string_view what, Span open) {
    if (take(")")) return;
    if (token_.kind == TokenKind::kEnd)
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
      if (token_.kind == TokenKind::kNumber) {
        numbers.push_back(negative ? -token_.number : token_.number);
      } else if (token_.kind == TokenKind::kText && !negative) {
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
  SelectionLexer lexer_{code_.text};
  std::unordered_map<std::string, std::size_t> column_indices_;
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
