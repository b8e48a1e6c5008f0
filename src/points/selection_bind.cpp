// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "base/text.h"
#include "points/selection_program.h"

namespace orrery::points {
namespace {

/// Column names listed in a message.
constexpr std::size_t kMaxListed = 40;

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

struct Operand {
  Type type;
  Span span;
  std::size_t index = 0;  ///< text columns and strings: as in SelectionStep
};

/// Walks the postfix steps with a stack of types. Strings stay on this stack until they are compared, because blocks
/// cannot hold strings.
class Binder {
 public:
  Binder(const SelectionCode& code, const std::vector<data::ColumnInfo>& columns) : code_(code) {
    // The first column of a name, as in Table::find().
    std::vector<std::pair<std::string_view, bool>> known;
    for (const data::ColumnInfo& column : columns)
      known.emplace_back(column.name, column.type == data::ColumnType::kText);
    std::stable_sort(known.begin(), known.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const std::string& name : code.columns) {
      const auto found = std::lower_bound(known.begin(), known.end(), name,
                                          [](const auto& a, const std::string& b) { return a.first < b; });
      if (found == known.end() || found->first != name) fail_unknown(name, columns);
      is_text_.push_back(found->second);
    }
  }

  SelectionProgram bind() {
    for (const SelectionStep& step : code_.steps) add(step);
    if (!stack_.empty() && stack_.back().type != Type::kTruth) {
      const Operand& result = stack_.back();
      fail_selection(code_.text, result.span, std::string("expected a condition, not ") + type_text(result.type),
                     "compare it, as in: x != 0");
    }
    return std::move(program_);
  }

 private:
  [[noreturn]] void fail_unknown(const std::string& name, const std::vector<data::ColumnInfo>& columns) const {
    std::vector<std::string> names;
    for (const data::ColumnInfo& column : columns) names.push_back(column.name);
    std::string remedy = base::did_you_mean(name, names);
    if (remedy.empty()) {
      const std::size_t more = names.size() > kMaxListed ? names.size() - kMaxListed : 0;
      names.resize(names.size() - more);
      remedy = names.empty() ? "the data has no columns" : "columns are " + base::joined(names);
      if (more > 0) remedy += fmt::format(" and {} more", more);
    }
    std::size_t at = 0;
    while (code_.steps[at].op != SelectionOp::kColumn || code_.columns[code_.steps[at].index] != name) ++at;
    // element == C
    const bool is_compared = at + 1 < code_.steps.size() && (code_.steps[at + 1].op == SelectionOp::kEqual ||
                                                             code_.steps[at + 1].op == SelectionOp::kUnequal);
    if (is_compared) remedy += fmt::format("; strings are quoted: \"{}\"", name);
    fail_selection(code_.text, code_.steps[at].span, "unknown column " + name, remedy);
  }

  void add(const SelectionStep& step) {
    switch (step.op) {
      case SelectionOp::kNumber: emit({BlockOp::kConstant, step.number}, Type::kNumber, step.span); break;
      case SelectionOp::kText: stack_.push_back({Type::kText, step.span, step.index}); break;
      case SelectionOp::kColumn:
        if (is_text_[step.index]) {
          stack_.push_back({Type::kTextColumn, step.span, step.index});
        } else {
          emit({BlockOp::kLoad, 0, step.index}, Type::kNumber, step.span);
        }
        break;
      case SelectionOp::kNegate: add_unary(BlockOp::kNegate, Type::kNumber, step); break;
      case SelectionOp::kAbs: add_unary(BlockOp::kAbs, Type::kNumber, step); break;
      case SelectionOp::kSqrt: add_unary(BlockOp::kSqrt, Type::kNumber, step); break;
      case SelectionOp::kNot: add_unary(BlockOp::kNot, Type::kTruth, step); break;
      case SelectionOp::kAdd: add_binary(BlockOp::kAdd, Type::kNumber, Type::kNumber, step); break;
      case SelectionOp::kSubtract: add_binary(BlockOp::kSubtract, Type::kNumber, Type::kNumber, step); break;
      case SelectionOp::kMultiply: add_binary(BlockOp::kMultiply, Type::kNumber, Type::kNumber, step); break;
      case SelectionOp::kDivide: add_binary(BlockOp::kDivide, Type::kNumber, Type::kNumber, step); break;
      case SelectionOp::kMin: add_binary(BlockOp::kMin, Type::kNumber, Type::kNumber, step); break;
      case SelectionOp::kMax: add_binary(BlockOp::kMax, Type::kNumber, Type::kNumber, step); break;
      case SelectionOp::kLess: add_binary(BlockOp::kLess, Type::kNumber, Type::kTruth, step); break;
      case SelectionOp::kLessEqual: add_binary(BlockOp::kLessEqual, Type::kNumber, Type::kTruth, step); break;
      case SelectionOp::kGreater: add_binary(BlockOp::kGreater, Type::kNumber, Type::kTruth, step); break;
      case SelectionOp::kGreaterEqual: add_binary(BlockOp::kGreaterEqual, Type::kNumber, Type::kTruth, step); break;
      case SelectionOp::kAnd: add_binary(BlockOp::kAnd, Type::kTruth, Type::kTruth, step); break;
      case SelectionOp::kOr: add_binary(BlockOp::kOr, Type::kTruth, Type::kTruth, step); break;
      case SelectionOp::kEqual: add_equality(false, step); break;
      case SelectionOp::kUnequal: add_equality(true, step); break;
      case SelectionOp::kInNumbers:
        pop_of(Type::kNumber, step, "the list has numbers");
        emit({BlockOp::kInNumbers, 0, 0, 0, step.index}, Type::kTruth, step.span);
        break;
      case SelectionOp::kInTexts:
        add_in_texts(pop_of(Type::kTextColumn, step, "the list has strings"), code_.text_lists[step.index], step.span);
        break;
    }
  }

  void add_unary(BlockOp op, Type type, const SelectionStep& step) {
    pop_of(type, step, {});
    emit({op}, type, step.span);
  }

  void add_binary(BlockOp op, Type operands, Type result, const SelectionStep& step) {
    pop_of(operands, step, {});
    pop_of(operands, step, {});
    emit({op}, result, step.span);
  }

  void add_equality(bool is_negated, const SelectionStep& step) {
    Operand right = pop(), left = pop();
    if (left.type == Type::kText) std::swap(left, right);
    if (left.type == Type::kNumber && right.type == Type::kNumber) {
      emit({is_negated ? BlockOp::kUnequal : BlockOp::kEqual}, Type::kTruth, step.span);
      return;
    }
    if (left.type != Type::kTextColumn || (right.type != Type::kTextColumn && right.type != Type::kText))
      fail_mismatch(left, right, step);
    if (right.type == Type::kText) {
      add_in_texts(left, {code_.texts[right.index]}, step.span);
    } else {
      emit({BlockOp::kSameText, 0, left.index, right.index}, Type::kTruth, step.span);
    }
    if (is_negated) program_.steps.push_back({BlockOp::kNot});
  }

  [[noreturn]] void fail_mismatch(Operand left, Operand right, const SelectionStep& step) const {
    if (left.type == Type::kTruth || right.type == Type::kTruth)
      fail_selection(code_.text, step.span, "a condition cannot be compared",
                     "combine conditions by && and ||, or add parentheses");
    if (left.type == Type::kText && right.type == Type::kText)
      fail_selection(code_.text, step.span, "two strings are compared", "write a column without quotes");
    if (left.type == Type::kNumber) std::swap(left, right);
    const bool is_column = left.type == Type::kTextColumn;
    fail_selection(code_.text, left.span,
                   (is_column ? "text column " + code_.columns[left.index] : "text") + " compared with a number",
                   is_column ? "quote the other side, as in: element == \"C\"" : "numbers are written without quotes");
  }

  void add_in_texts(const Operand& column, std::vector<std::string> list, Span span) {
    std::sort(list.begin(), list.end());
    emit({BlockOp::kInTexts, 0, column.index, 0, program_.text_lists.size()}, Type::kTruth, span);
    program_.text_lists.push_back(std::move(list));
  }

  Operand pop() {
    const Operand out = stack_.back();
    stack_.pop_back();
    if (out.type == Type::kNumber) --numbers_;
    if (out.type == Type::kTruth) --truths_;
    return out;
  }

  Operand pop_of(Type type, const SelectionStep& step, const std::string& reason) {
    const Operand operand = pop();
    if (operand.type == type) return operand;
    const std::string expected = type_text(type);
    std::string remedy = reason;
    if (remedy.empty() && type == Type::kTruth) remedy = "compare it, as in: x != 0";
    if (remedy.empty() && operand.type == Type::kTruth) remedy = "add parentheses";
    if (remedy.empty()) remedy = "strings can be compared with ==, != and in";
    if (type == Type::kTextColumn && operand.type == Type::kText) remedy = "write a column without quotes";
    fail_selection(code_.text, operand.span,
                   fmt::format("{} expects {}, not {}", verbatim(step.span), expected, type_text(operand.type)),
                   remedy);
  }

  void emit(BlockStep step, Type result, Span span) {
    program_.steps.push_back(step);
    stack_.push_back({result, span});
    if (result == Type::kNumber) program_.number_depth = std::max(program_.number_depth, ++numbers_);
    if (result == Type::kTruth) program_.truth_depth = std::max(program_.truth_depth, ++truths_);
  }

  std::string verbatim(Span span) const { return code_.text.substr(span.begin, span.end - span.begin); }

  const SelectionCode& code_;
  std::vector<bool> is_text_;  ///< per column of the selection
  std::vector<Operand> stack_;
  std::size_t numbers_ = 0, truths_ = 0;  ///< number of numbers and truth values on stack_
  SelectionProgram program_;
};

}  // namespace

SelectionProgram bind(const SelectionCode& code, const std::vector<data::ColumnInfo>& columns) {
  return Binder(code, columns).bind();
}

}  // namespace orrery::points
