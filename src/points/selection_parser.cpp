// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/text.h"
#include "math/scalar.h"
#include "points/selection_lexer.h"
#include "points/selection_run.h"

namespace orrery::points {

namespace {

/// Maximum length of a selection, bytes. Long lists of ids are pasted; a file passed by mistake is larger.
constexpr std::size_t kMaxLength = std::size_t{1} << 20;

/// Maximum nesting of parentheses, functions and prefixes: the parser recurses, and evaluation needs 8 KiB per level.
constexpr int kMaxDepth = 100;

/// Column names listed in a message.
constexpr std::size_t kMaxListed = 40;

using Replacement = std::pair<std::string_view, std::string_view>;

/// Operators that are words.
constexpr Replacement kOperatorWords[] = {{"and", "&&"}, {"or", "||"}, {"not", "!"}};

/// Names in the selections of PyMOL, VMD and MDAnalysis, and the columns of PDB and mmCIF files.
constexpr Replacement kAliases[] = {{"resid", "residue_number"},
                                    {"resi", "residue_number"},
                                    {"resnum", "residue_number"},
                                    {"resname", "residue"},
                                    {"resn", "residue"}};

/// Groups of atoms that those programs know, and what selects them here.
constexpr Replacement kGroups[] = {{"protein", "record == \"ATOM\""},  {"nucleic", "record == \"ATOM\""},
                                   {"polymer", "record == \"ATOM\""},  {"hetatm", "record == \"HETATM\""},
                                   {"water", "residue in {HOH, WAT}"}, {"solvent", "residue in {HOH, WAT}"},
                                   {"backbone", "name N CA C O"},      {"hydrogen", "element H"}};

/// Columns that tell residues apart, those that a file has. The number is always needed.
constexpr std::string_view kResidueNumber = "residue_number";
constexpr std::string_view kResidue[] = {"chain", "subchain", "segment", "residue", kResidueNumber};

/// Returns the replacement of a word; empty if there is none.
std::string_view replacement(std::span<const Replacement> all, std::string_view word) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Replacement& r) { return r.first == word; });
  return found == all.end() ? std::string_view() : found->second;
}

constexpr const char* kLists = "e.g. type in [1, 2], z in [20:60], chain in {A, B}";

/// A symbol or the name of a function, and the step that it adds.
struct Operator {
  std::string_view name;
  void (*step)(SelectionRun&);
};
using Run = SelectionRun;
constexpr Operator kOr[] = {{"||", [](Run& run) { run.combine_truths(std::bit_or<Run::Truth>()); }}};
constexpr Operator kAnd[] = {{"&&", [](Run& run) { run.combine_truths(std::bit_and<Run::Truth>()); }}};
constexpr Operator kComparisons[] = {
    {"==", [](Run& run) { run.compare(std::equal_to<>()); }},
    {"!=", [](Run& run) { run.compare([](double a, double b) { return a < b || a > b; }); }},  // false for NaN
    {"<", [](Run& run) { run.compare(std::less<>()); }},
    {"<=", [](Run& run) { run.compare(std::less_equal<>()); }},
    {">", [](Run& run) { run.compare(std::greater<>()); }},
    {">=", [](Run& run) { run.compare(std::greater_equal<>()); }}};
constexpr Operator kSums[] = {{"+", [](Run& run) { run.combine(std::plus<>()); }},
                              {"-", [](Run& run) { run.combine(std::minus<>()); }}};
constexpr Operator kProducts[] = {{"*", [](Run& run) { run.combine(std::multiplies<>()); }},
                                  {"/", [](Run& run) { run.combine(std::divides<>()); }}};
constexpr Operator kFunctions[] = {{"abs", [](Run& run) { run.change([](double a) { return std::abs(a); }); }},
                                   {"sqrt", [](Run& run) { run.change([](double a) { return std::sqrt(a); }); }},
                                   {"exp", [](Run& run) { run.change([](double a) { return std::exp(a); }); }},
                                   {"log", [](Run& run) { run.change([](double a) { return std::log(a); }); }},
                                   {"log10", [](Run& run) { run.change([](double a) { return std::log10(a); }); }},
                                   {"floor", [](Run& run) { run.change([](double a) { return std::floor(a); }); }}};
/// Functions of two or more operands: min(x, y, z) is min(min(x, y), z). NaN if one operand is NaN: a missing value
/// must not become the limit of a clamp.
constexpr Operator kFolds[] = {
    {"min", [](Run& run) { run.combine([](double a, double b) { return a < b || a != a ? a : b; }); }},
    {"max", [](Run& run) { run.combine([](double a, double b) { return a > b || a != a ? a : b; }); }}};

const Operator* find(std::span<const Operator> operators, std::string_view name) {
  const auto found =
      std::find_if(operators.begin(), operators.end(), [&](const Operator& o) { return o.name == name; });
  return found == operators.end() ? nullptr : &*found;
}

enum class Type { kNumber, kTruth, kTextColumn, kText };

constexpr const char* type_text(Type type) {
  switch (type) {
    case Type::kNumber: return "a number";
    case Type::kTruth: return "a condition";
    case Type::kTextColumn:
    case Type::kText: return "a string";
  }
  return "";
}

/// An operand whose steps have been added; strings have none until they are compared.
struct Operand {
  Type type;
  Span span;                   ///< of the operand, or of its operator
  std::size_t column = 0;      ///< kTextColumn: index into the columns of the selection
  std::string_view text = {};  ///< kText
};

/// Parses a selection, checks its types and adds its steps, all in one pass.
class Parser {
 public:
  Parser(std::string_view text, const std::vector<data::ColumnInfo>& columns,
         const std::array<std::string, 3>& position = {})
      : columns_(columns), position_(position) {
    if (text.size() > kMaxLength)
      fail_selection("", {}, "the condition is longer than " + base::bytes_text(kMaxLength),
                     "select by ranges, or filter the file");
    text_ = text;
    for (const data::ColumnInfo& column : columns)  // the first of a name, as in Table::find()
      known_.try_emplace(column.name, Known{column.type == data::ColumnType::kText, kUnused});
    read();
  }

  Selection parse() {
    if (token_.kind == TokenKind::kEnd) return {};
    const Operand result = parse_or();
    if (token_.kind != TokenKind::kEnd) fail_at_token("expected an operator", remedy_for_operator());
    if (result.type != Type::kTruth)
      fail(result.span, std::string("expected a condition, not ") + type_text(result.type),
           "compare it, as in: x != 0");
    return std::move(selection_);
  }

  Expression parse_number_of_row() {
    const Operand result = parse_sum();
    if (token_.kind != TokenKind::kEnd) fail_at_token("expected an arithmetic operator", "e.g. sqrt(vx^2 + vy^2)");
    if (result.type != Type::kNumber)
      fail(result.span, std::string("expected a number, not ") + type_text(result.type), "e.g. sqrt(vx^2 + vy^2)");
    return {std::move(selection_)};
  }

 private:
  // Tokens.

  void read(bool takes_word = false) {
    follows_equality_ = is_symbol("==") || is_symbol("!=");
    token_ = lexer_.next(takes_word);
    if (!takes_word) accept_operator_word();
  }

  void accept_operator_word() {
    if (token_.kind != TokenKind::kName) return;
    const std::string_view symbol = replacement(kOperatorWords, token_.text);
    if (!symbol.empty()) token_ = {TokenKind::kSymbol, token_.span, symbol};
  }

  bool is_symbol(std::string_view symbol) const { return token_.kind == TokenKind::kSymbol && token_.text == symbol; }
  bool is_word(std::string_view word) const { return token_.kind == TokenKind::kName && token_.text == word; }

  bool take(std::string_view symbol) {
    if (!is_symbol(symbol)) return false;
    read();
    return true;
  }

  const Operator* operator_in(std::span<const Operator> operators) const {
    return token_.kind == TokenKind::kSymbol ? find(operators, token_.text) : nullptr;
  }

  // Errors.

  [[noreturn]] void fail(Span span, const std::string& text, const std::string& remedy) const {
    fail_selection(text_, span, text, remedy);
  }
  [[noreturn]] void fail_at_token(const std::string& text, const std::string& remedy) const {
    fail(token_.span, text, remedy);
  }

  /// The remedy for a token where an operator is expected.
  std::string remedy_for_operator() const {
    if (is_symbol(")")) return "no parenthesis is open";
    return "e.g. ==, &&, || or +";
  }

  [[noreturn]] void fail_unknown_column(const Token& token, bool is_compared) const {
    const std::string name(token.text);
    std::vector<std::string> names;
    for (const data::ColumnInfo& column : columns_) names.push_back(column.name);
    std::string remedy(replacement(kGroups, name));
    remedy = remedy.empty() ? base::did_you_mean(name, names) : "e.g. " + remedy;
    if (remedy.empty()) {
      const std::size_t more = names.size() > kMaxListed ? names.size() - kMaxListed : 0;
      names.resize(names.size() - more);
      remedy = names.empty() ? "the data has no columns" : "columns are " + base::joined(names);
      if (more > 0) remedy += fmt::format(" and {} more", more);
    }
    if (is_compared) remedy += fmt::format("; strings are quoted: \"{}\"", name);  // element == C
    fail(token.span, "unknown column " + name, remedy);
  }

  /// `reason`   why this type is expected; empty: because of the operator
  void require(const Operand& operand, Type type, Span op, const char* reason = "") const {
    if (operand.type == type) return;
    std::string remedy = reason;
    if (remedy.empty() && type == Type::kTruth) remedy = "compare it, as in: x != 0";
    if (remedy.empty() && operand.type == Type::kTruth) remedy = "add parentheses";
    if (remedy.empty()) remedy = "strings can be compared with ==, != and in";
    if (type == Type::kTextColumn && operand.type == Type::kText) remedy = "write a column without quotes";
    fail(operand.span,
         fmt::format("{} expects {}, not {}", text_.substr(op.begin, op.end - op.begin), type_text(type),
                     type_text(operand.type)),
         remedy);
  }

  [[noreturn]] void fail_equality(Operand left, Operand right, Span op) const {
    if (left.type == Type::kTruth || right.type == Type::kTruth)
      fail(op, "a condition cannot be compared", "combine conditions by && and ||, or add parentheses");
    if (left.type == Type::kText && right.type == Type::kText)
      fail(op, "two strings are compared", "write a column without quotes");
    if (left.type == Type::kNumber) std::swap(left, right);
    if (left.type == Type::kText) fail(left.span, "text compared with a number", "numbers are written without quotes");
    fail(left.span, "text column " + selection_.columns[left.column] + " compared with a number",
         "quote the other side, as in: element == \"C\"");
  }

  // Steps.

  Operand emit(SelectionStep step, Type result, Span span) {
    selection_.steps.push_back(std::move(step));
    return {result, span};
  }

  Operand emit_text_test(TextTest test, Span span) {
    selection_.text_tests.push_back(std::move(test));
    const std::size_t index = selection_.text_tests.size() - 1;
    return emit([index](Run& run) { run.test_text(index); }, Type::kTruth, span);
  }

  // Grammar, one function per precedence.

  Operand parse_or() { return parse_chain(kOr, Type::kTruth, &Parser::parse_and); }
  Operand parse_and() { return parse_chain(kAnd, Type::kTruth, &Parser::parse_negation); }
  Operand parse_sum() { return parse_chain(kSums, Type::kNumber, &Parser::parse_product); }
  Operand parse_product() { return parse_chain(kProducts, Type::kNumber, &Parser::parse_operand); }

  /// Parses operands between operators of one precedence, from the left.
  Operand parse_chain(std::span<const Operator> operators, Type type, Operand (Parser::*parse_next)()) {
    Operand left = (this->*parse_next)();
    while (const Operator* const op = operator_in(operators)) {
      const Span span = token_.span;
      read();
      const Operand right = (this->*parse_next)();
      require(right, type, span);
      require(left, type, span);
      left = emit(op->step, type, span);
    }
    return left;
  }

  /// `!a == b` is `!(a == b)`, as `not a == b` is in other programs.
  Operand parse_negation() {
    const Span span = token_.span;
    bool is_negated = false, has_prefix = false;
    for (; take("!"); is_negated = !is_negated) has_prefix = true;
    const Operand out = parse_comparison();
    if (has_prefix) require(out, Type::kTruth, span);
    return is_negated ? negation(span) : out;
  }

  Operand negation(Span span) {
    return emit([](Run& run) { run.negate(); }, Type::kTruth, span);
  }

  Operand parse_comparison() {
    Operand left = parse_sum();
    if (const Operator* const op = operator_in(kComparisons)) {
      const Span span = token_.span;
      read();
      left = compare(*op, left, parse_sum(), span);
    } else if (is_word("in")) {
      left = parse_list(left);
    } else {
      return left;
    }
    if (operator_in(kComparisons) || is_word("in"))
      fail_at_token("comparisons cannot be chained", "write 1 < x && x < 2");
    return left;
  }

  Operand compare(const Operator& op, Operand left, Operand right, Span span) {
    const bool is_equality = op.name == "==" || op.name == "!=";
    if (!is_equality || (left.type == Type::kNumber && right.type == Type::kNumber)) {
      require(right, Type::kNumber, span);
      require(left, Type::kNumber, span);
      return emit(op.step, Type::kTruth, span);
    }
    if (left.type == Type::kText) std::swap(left, right);
    if (left.type != Type::kTextColumn || (right.type != Type::kTextColumn && right.type != Type::kText))
      fail_equality(left, right, span);
    TextTest test{left.column, right.column, right.type == Type::kTextColumn, {}};
    if (!test.is_same) test.words.emplace_back(right.text);
    const Operand out = emit_text_test(std::move(test), span);
    return op.name == "==" ? out : negation(span);
  }

  Operand parse_operand() {
    if (++depth_ > kMaxDepth)
      fail_at_token(fmt::format("more than {} nested parentheses or prefixes", kMaxDepth), "simplify it");
    const Token token = token_;
    Operand out{Type::kNumber, token.span};
    if (take("(")) {
      out = parse_or();
      close("(", token.span);
    } else if (take("-")) {
      require(parse_operand(), Type::kNumber, token.span);
      emit([](Run& run) { run.change(std::negate<>()); }, Type::kNumber, token.span);
    } else if (token.kind == TokenKind::kNumber) {
      read();
      emit([value = token.number](Run& run) { run.push_constant(value); }, Type::kNumber, token.span);
    } else if (token.kind == TokenKind::kText) {
      read();
      out = {Type::kText, token.span, 0, token.text};
    } else if (token.kind == TokenKind::kQuotedName || token.kind == TokenKind::kName) {
      out = parse_name();
    } else {
      fail_at_token(
          token.kind == TokenKind::kEnd ? "the condition ends too early" : "expected a column, number or text",
          is_symbol("/")   ? "e.g. chain A"
          : is_symbol(":") ? "e.g. resid 20:30"
                           : "e.g. type == 2 && z > 0");
    }
    const Span power = token_.span;
    if (take("^")) {  // -x^2 is -(x^2), and x^y^z is x^(y^z)
      require(parse_operand(), Type::kNumber, power);
      require(out, Type::kNumber, power);
      out =
          emit([](Run& run) { run.combine([](double a, double b) { return std::pow(a, b); }); }, Type::kNumber, power);
    }
    --depth_;
    return out;
  }

  Operand parse_name() {
    const Token token = token_;
    if (is_word("in")) fail_at_token("expected a column before `in`", "e.g. chain in {A, B}");
    if (is_word("within") && known_.count("within") == 0) return parse_near();
    if (is_word("same") && known_.count("same") == 0) return parse_group();
    const bool is_compared = follows_equality_;
    auto found = known_.find(token.text);
    if (found == known_.end()) found = known_.find(replacement(kAliases, token.text));
    const bool is_text = found != known_.end() && found->second.is_text;
    read(is_text);
    if (token.kind == TokenKind::kName && is_symbol("(")) return parse_call(token);
    if (found == known_.end()) fail_unknown_column(token, is_compared);
    const std::size_t index = use(*found);
    return is_text ? parse_words(token, index) : parse_numbers(token, index);
  }

  /// Parses `within 5 of CONDITION`.
  Operand parse_near() {
    const Span span = token_.span;
    constexpr const char* kExample = "e.g. within 5 of (residue HEM)";
    read();
    RowTest test;
    const Span length = token_.span;
    test.distance = parse_number();
    if (!(test.distance > 0)) fail(length, "the distance must be above 0", kExample);
    for (const std::string& column : position_) {
      const auto found = known_.find(column);
      if (found == known_.end() || found->second.is_text) fail(span, "the data have no positions", "select by columns");
      test.columns.push_back(use(*found));
    }
    return parse_others("of", std::move(test), span, kExample);
  }

  /// Parses `same COLUMN as CONDITION`.
  Operand parse_group() {
    const Span span = token_.span;
    constexpr const char* kExample = "e.g. same residue as (within 5 of (residue HEM))";
    read();
    const Token column = token_;
    if (column.kind != TokenKind::kName && column.kind != TokenKind::kQuotedName)
      fail_at_token("expected a column after `same`", kExample);
    read();
    RowTest test;
    if (column.text == "residue" && known_.count(kResidueNumber) > 0) {
      for (const std::string_view part : kResidue)
        if (const auto found = known_.find(part); found != known_.end()) test.columns.push_back(use(*found));
    } else {
      const auto found = known_.find(column.text);
      if (found == known_.end()) fail_unknown_column(column, false);
      test.columns.push_back(use(*found));
    }
    return parse_others("as", std::move(test), span, kExample);
  }

  /// Parses a word, and the condition that follows it.
  Operand parse_others(const char* word, RowTest test, Span span, const char* example) {
    if (!is_word(word)) fail_at_token(fmt::format("expected `{}`", word), example);
    read();
    std::vector<SelectionStep> outer = std::exchange(selection_.steps, {});
    require(parse_comparison(), Type::kTruth, span, example);
    test.steps = std::exchange(selection_.steps, std::move(outer));
    selection_.row_tests.push_back(std::move(test));
    return emit([index = selection_.row_tests.size() - 1](Run& run) { run.test_rows(index); }, Type::kTruth, span);
  }

  /// Parses what follows a column of strings: `chain A B`, and `chain A+B` as in PyMOL, are `chain in {A, B}`.
  Operand parse_words(const Token& name, std::size_t column) {
    const auto is_word_or_text = [&] {
      accept_operator_word();
      return token_.kind == TokenKind::kText || (token_.kind == TokenKind::kName && !is_word("in"));
    };
    std::vector<std::string> words;
    for (bool is_needed = false; is_word_or_text() || is_needed;) {
      if (!is_word_or_text()) fail_at_token("expected a string", kLists);
      words.emplace_back(token_.text);
      read(true);
      is_needed = is_symbol("+");
      if (is_needed) read(true);
    }
    if (words.empty()) return {Type::kTextColumn, name.span, column};
    return emit_text_test({column, 0, false, std::move(words)}, name.span);
  }

  /// The same for numbers: `resid 5 8:12` is `resid in [5, 8:12]`.
  Operand parse_numbers(const Token& name, std::size_t column) {
    emit([column](Run& run) { run.load(column); }, Type::kNumber, name.span);
    if (token_.kind != TokenKind::kNumber) return {Type::kNumber, name.span};
    std::vector<NumberRange> ranges;
    do ranges.push_back(parse_range());
    while (take("+") || token_.kind == TokenKind::kNumber);
    return emit_ranges(std::move(ranges), name.span);
  }

  Operand parse_call(const Token& name) {
    const Operator* const fold = find(kFolds, name.text);
    const Operator* const function = find(kFunctions, name.text);
    if (fold == nullptr && function == nullptr)
      fail(name.span, "unknown function " + std::string(name.text),
           "functions are abs, sqrt, exp, log, log10, floor, min, max");
    const Span open = token_.span;
    int count = 0;
    do {
      read();
      require(parse_sum(), Type::kNumber, name.span);
      if (++count > 1 && fold != nullptr) emit(fold->step, Type::kNumber, name.span);
    } while (is_symbol(","));
    close(name.text, open);
    if (fold != nullptr ? count < 2 : count != 1)
      fail(name.span, fmt::format("{} with {} operands", name.text, count),
           fold != nullptr ? "two or more are needed" : "exactly one is allowed");
    if (function != nullptr) emit(function->step, Type::kNumber, name.span);
    return {Type::kNumber, name.span};
  }

  void close(std::string_view what, Span open) {
    if (take(")")) return;
    if (token_.kind == TokenKind::kEnd)
      fail(open, std::string(what == "(" ? "parenthesis" : what) + " is not closed", "add )");
    fail_at_token("expected ) or an operator", remedy_for_operator());
  }

  Operand parse_list(const Operand& left) {
    const Span in = token_.span;
    read();
    const bool has_braces = is_symbol("{");
    if (!has_braces && !is_symbol("[")) fail_at_token("expected a list after `in`", kLists);
    const bool takes_words = has_braces && left.type == Type::kTextColumn;
    std::vector<NumberRange> ranges;
    std::vector<std::string> words;
    do {
      read(takes_words);
      const bool is_text = token_.kind == TokenKind::kText || (takes_words && token_.kind == TokenKind::kName);
      const bool is_number = token_.kind == TokenKind::kNumber || is_symbol("-") || is_symbol(":");
      if (!is_text && !is_number) fail_at_token("expected a number or a string", kLists);
      if (is_text ? !ranges.empty() : !words.empty())
        fail_at_token("list of both numbers and strings", "use two lists");
      if (is_text) {
        words.emplace_back(token_.text);
        read();
      } else {
        ranges.push_back(parse_range());
      }
    } while (is_symbol(","));
    if (!take(has_braces ? "}" : "]")) fail_at_token(has_braces ? "expected , or }" : "expected , or ]", kLists);
    if (ranges.empty()) {
      require(left, Type::kTextColumn, in, "the list has strings");
      return emit_text_test({left.column, 0, false, std::move(words)}, in);
    }
    require(left, Type::kNumber, in, "the list has numbers");
    return emit_ranges(std::move(ranges), in);
  }

  Operand emit_ranges(std::vector<NumberRange> ranges, Span span) {
    return emit([disjoint = disjoint(std::move(ranges))](Run& run) { run.find(disjoint); }, Type::kTruth, span);
  }

  /// Parses `5`, `5:8`, `5:`, `:8` or `:`; `5-8` and `5 to 8` as in other programs.
  NumberRange parse_range() {
    const Span first = token_.span;
    NumberRange out{-math::kInfinity, math::kInfinity};
    if (!is_symbol(":")) out.low = parse_number();
    if (is_word("to") || is_symbol("-"))
      read();
    else if (!take(":"))
      return {out.low, out.low};
    else if (token_.kind != TokenKind::kNumber && !is_symbol("-"))
      return out;
    const Span last = token_.span;
    out.high = parse_number();
    if (out.low > out.high)
      fail({first.begin, last.end}, "the range is empty", "write the smaller number first, as in: z in [20:60]");
    return out;
  }

  double parse_number() {
    const bool is_negative = take("-");
    if (token_.kind != TokenKind::kNumber) fail_at_token("expected a number", kLists);
    const double value = token_.number;
    read();
    return is_negative ? -value : value;
  }

  /// Sorts ranges and joins those that overlap.
  static std::vector<NumberRange> disjoint(std::vector<NumberRange> ranges) {
    std::sort(ranges.begin(), ranges.end(), [](const NumberRange& a, const NumberRange& b) { return a.low < b.low; });
    std::vector<NumberRange> out;
    for (const NumberRange& range : ranges) {
      if (out.empty() || out.back().high < range.low) {
        out.push_back(range);
      } else {
        out.back().high = std::max(out.back().high, range.high);
      }
    }
    return out;
  }

  /// The index of a column in those of the selection, to which it is added if necessary.
  std::size_t use(auto& known) {
    std::size_t& index = known.second.index;
    if (index == kUnused) {
      index = selection_.columns.size();
      selection_.columns.emplace_back(known.first);
    }
    return index;
  }

  static constexpr std::size_t kUnused = std::numeric_limits<std::size_t>::max();
  struct Known {
    bool is_text;
    std::size_t index;  ///< into the columns of the selection, or kUnused
  };

  std::string text_;
  const std::vector<data::ColumnInfo>& columns_;
  std::array<std::string, 3> position_;
  std::unordered_map<std::string_view, Known> known_;
  Selection selection_;
  SelectionLexer lexer_{text_};
  Token token_;
  bool follows_equality_ = false;  ///< whether the token before token_ is == or !=
  int depth_ = 0;
};

}  // namespace

Selection parse_selection(std::string_view text, const std::vector<data::ColumnInfo>& columns,
                          const std::array<std::string, 3>& position) {
  return Parser(text, columns, position).parse();
}

Expression parse_expression(std::string_view text, const std::vector<data::ColumnInfo>& columns) {
  return Parser(text, columns).parse_number_of_row();
}

std::string fault_text(const base::Error& error) {
  std::string out;
  for (const base::Diagnostic& d : error.diagnostics())
    out += fmt::format("at character {}: {}{}{}", d.column, d.text, d.remedy.empty() ? "" : "; ", d.remedy);
  return out.empty() ? error.what() : out;
}

}  // namespace orrery::points
