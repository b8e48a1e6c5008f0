// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <unordered_map>
#include <variant>

#include "points/selection_program.h"

namespace orrery::points {
namespace {

/// Rows that are evaluated at once: a block of numbers is 8 KiB, so that the blocks of usual selections fit into the
/// first-level cache.
constexpr std::size_t kBlock = 1024;

using Truth = std::uint8_t;

/// A condition on a text column: one truth value for each distinct string.
using WordTruths = std::vector<Truth>;

WordTruths truths_of(const data::Words& words, const std::vector<std::string>& ascending) {
  WordTruths out(words.words.size());
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = std::binary_search(ascending.begin(), ascending.end(), words.words[i]);
  return out;
}

/// For each distinct string of `from`, its index in `to`; the number of strings in `to` if it is not found.
std::vector<std::uint32_t> index_in(const data::Words& from, const data::Words& to) {
  std::unordered_map<std::string, std::uint32_t> indices;
  for (std::size_t i = 0; i < to.words.size(); ++i) indices.emplace(to.words[i], static_cast<std::uint32_t>(i));
  std::vector<std::uint32_t> out;
  for (const std::string& word : from.words) {
    const auto found = indices.find(word);
    out.push_back(found == indices.end() ? static_cast<std::uint32_t>(to.words.size()) : found->second);
  }
  return out;
}

class Runner {
 public:
  Runner(const SelectionProgram& program, const SelectionCode& code, const data::Table& table)
      : program_(program), code_(code) {
    for (const std::string& name : code.columns) columns_.push_back(table.find(name));
    numbers_.resize(program.number_depth * kBlock);
    truths_.resize(program.truth_depth * kBlock);
    word_truths_.resize(program.steps.size());
    word_indices_.resize(program.steps.size());
    for (std::size_t i = 0; i < program.steps.size(); ++i) {
      const BlockStep& step = program.steps[i];
      if (step.op == BlockOp::kInTexts) word_truths_[i] = truths_of(words(step.column), program.text_lists[step.list]);
      if (step.op == BlockOp::kSameText) word_indices_[i] = index_in(words(step.column), words(step.second));
    }
  }

  /// Evaluates rows [begin, begin + count).
  void run(std::size_t begin, std::size_t count, Truth* out) {
    begin_ = begin;
    count_ = count;
    number_end_ = numbers_.data();
    truth_end_ = truths_.data();
    for (std::size_t i = 0; i < program_.steps.size(); ++i) run_step(i);
    std::copy_n(truths_.data(), count, out);
  }

 private:
  const data::Words& words(std::size_t column) const { return std::get<data::Words>(columns_[column]->values); }

  void run_step(std::size_t i) {
    const BlockStep& step = program_.steps[i];
    switch (step.op) {
      case BlockOp::kLoad: load(*columns_[step.column]); break;
      case BlockOp::kConstant: std::fill_n(push_number(), count_, step.number); break;
      case BlockOp::kNegate: change([](double a) { return -a; }); break;
      case BlockOp::kAbs: change([](double a) { return std::abs(a); }); break;
      case BlockOp::kSqrt: change([](double a) { return std::sqrt(a); }); break;
      case BlockOp::kAdd: combine([](double a, double b) { return a + b; }); break;
      case BlockOp::kSubtract: combine([](double a, double b) { return a - b; }); break;
      case BlockOp::kMultiply: combine([](double a, double b) { return a * b; }); break;
      case BlockOp::kDivide: combine([](double a, double b) { return a / b; }); break;
      // NaN if one operand is NaN: a missing value must not become the limit of a clamp.
      case BlockOp::kMin: combine([](double a, double b) { return a < b || a != a ? a : b; }); break;
      case BlockOp::kMax: combine([](double a, double b) { return a > b || a != a ? a : b; }); break;
      case BlockOp::kEqual: compare([](double a, double b) { return a == b; }); break;
      case BlockOp::kUnequal: compare([](double a, double b) { return a < b || a > b; }); break;
      case BlockOp::kLess: compare([](double a, double b) { return a < b; }); break;
      case BlockOp::kLessEqual: compare([](double a, double b) { return a <= b; }); break;
      case BlockOp::kGreater: compare([](double a, double b) { return a > b; }); break;
      case BlockOp::kGreaterEqual: compare([](double a, double b) { return a >= b; }); break;
      case BlockOp::kInNumbers: find_numbers(code_.number_lists[step.list]); break;
      case BlockOp::kInTexts: {
        const std::uint32_t* index = words(step.column).index.data() + begin_;
        const WordTruths& truth = word_truths_[i];
        push_truths([&](std::size_t row) { return truth[index[row]]; });
        break;
      }
      case BlockOp::kSameText: {
        const std::uint32_t* first = words(step.column).index.data() + begin_;
        const std::uint32_t* second = words(step.second).index.data() + begin_;
        const std::vector<std::uint32_t>& same = word_indices_[i];
        push_truths([&](std::size_t row) { return static_cast<Truth>(same[first[row]] == second[row]); });
        break;
      }
      case BlockOp::kNot: {
        Truth* a = truth_end_ - kBlock;
        for (std::size_t row = 0; row < count_; ++row) a[row] ^= 1;
        break;
      }
      case BlockOp::kAnd: combine_truths(std::bit_and<Truth>()); break;
      case BlockOp::kOr: combine_truths(std::bit_or<Truth>()); break;
    }
  }

  double* push_number() {
    double* top = number_end_;
    number_end_ += kBlock;
    return top;
  }

  void load(const data::Column& column) {
    double* to = push_number();
    std::visit(
        [&](const auto& values) {
          if constexpr (!requires { values.index; })
            for (std::size_t row = 0; row < count_; ++row) to[row] = static_cast<double>(values[begin_ + row]);
        },
        column.values);
  }

  template <class F>
  void change(F f) {
    double* a = number_end_ - kBlock;
    for (std::size_t row = 0; row < count_; ++row) a[row] = f(a[row]);
  }

  template <class F>
  void combine(F f) {
    number_end_ -= kBlock;
    const double* b = number_end_;
    double* a = number_end_ - kBlock;
    for (std::size_t row = 0; row < count_; ++row) a[row] = f(a[row], b[row]);
  }

  template <class F>
  void compare(F f) {
    number_end_ -= 2 * kBlock;
    const double *a = number_end_, *b = number_end_ + kBlock;
    push_truths([&](std::size_t row) { return static_cast<Truth>(f(a[row], b[row])); });
  }

  void find_numbers(const std::vector<double>& ascending) {
    number_end_ -= kBlock;
    const double* a = number_end_;
    push_truths([&](std::size_t row) {
      const auto found = std::lower_bound(ascending.begin(), ascending.end(), a[row]);
      return static_cast<Truth>(found != ascending.end() && *found == a[row]);
    });
  }

  template <class F>
  void push_truths(F f) {
    Truth* to = truth_end_;
    truth_end_ += kBlock;
    for (std::size_t row = 0; row < count_; ++row) to[row] = f(row);
  }

  template <class F>
  void combine_truths(F f) {
    truth_end_ -= kBlock;
    const Truth* b = truth_end_;
    Truth* a = truth_end_ - kBlock;
    for (std::size_t row = 0; row < count_; ++row) a[row] = f(a[row], b[row]);
  }

  const SelectionProgram& program_;
  const SelectionCode& code_;
  std::vector<const data::Column*> columns_;
  std::vector<double> numbers_;
  std::vector<Truth> truths_;
  std::vector<WordTruths> word_truths_;                   ///< one per step
  std::vector<std::vector<std::uint32_t>> word_indices_;  ///< one per step
  std::size_t begin_ = 0, count_ = 0;
  double* number_end_ = nullptr;
  Truth* truth_end_ = nullptr;
};

}  // namespace

std::vector<std::uint8_t> run(const SelectionProgram& program, const SelectionCode& code, const data::Table& table) {
  std::vector<std::uint8_t> out(table.rows, 1);
  if (program.steps.empty()) return out;
  Runner runner(program, code, table);
  for (std::size_t begin = 0; begin < table.rows; begin += kBlock)
    runner.run(begin, std::min(kBlock, table.rows - begin), out.data() + begin);
  return out;
}

}  // namespace orrery::points
