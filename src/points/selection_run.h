// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "points/selection.h"

namespace orrery::points {

/// Numbers from `low` to `high`, both included.
struct NumberRange {
  double low, high;
};

/// The evaluation of a selection on a table, a block of rows at a time. Operands are on two stacks of blocks, one of
/// numbers and one of truth values.
class SelectionRun {
 public:
  using Truth = std::uint8_t;
  /// Rows of a block: its numbers take 8 KiB, so that those of usual selections fit into the first-level cache.
  static constexpr std::size_t kRows = 1024;

  SelectionRun(const Selection& selection, const data::Table& table);

  /// Evaluates rows [begin, begin + count) of a selection, or of an expression.
  void run(std::size_t begin, std::size_t count, Truth* out);
  void run(std::size_t begin, std::size_t count, double* out);

  /// Pushes a column of numbers.
  void load(std::size_t column);
  void push_constant(double value);

  /// Replaces a number a by f(a).
  template <class F>
  void change(F f) {
    double* const a = numbers(1);
    for (std::size_t row = 0; row < count_; ++row) a[row] = f(a[row]);
  }
  /// Replaces two numbers a and b by f(a, b).
  template <class F>
  void combine(F f) {
    double *const a = numbers(2), *const b = a + kRows;
    for (std::size_t row = 0; row < count_; ++row) a[row] = f(a[row], b[row]);
    number_end_ -= kRows;
  }
  /// Replaces two numbers a and b by the truth value f(a, b).
  template <class F>
  void compare(F f) {
    const double *const a = numbers(2), *const b = a + kRows;
    push_truths([&](std::size_t row) { return f(a[row], b[row]); });
    number_end_ -= 2 * kRows;
  }
  /// Replaces a number by whether it is in one of some ranges, which are ascending and do not overlap.
  void find(const std::vector<NumberRange>& ranges);
  /// Pushes the result of a text test.
  void test_text(std::size_t index);
  /// Pushes the result of a row test.
  void test_rows(std::size_t index);
  void negate();
  /// Replaces two truth values a and b by f(a, b).
  template <class F>
  void combine_truths(F f) {
    truth_end_ -= kRows;
    Truth *const b = truths_.data() + truth_end_, *const a = b - kRows;
    const std::size_t count = count_;  // a Truth may alias any member
    for (std::size_t row = 0; row < count; ++row) a[row] = f(a[row], b[row]);
  }

 private:
  void run(const std::vector<SelectionStep>& steps, std::size_t begin, std::size_t count);
  std::vector<Truth> truths_of(const RowTest& test, std::size_t rows);
  /// The topmost numbers, `depth` blocks.
  double* numbers(std::size_t depth) { return numbers_.data() + number_end_ - depth * kRows; }
  double* push_numbers();
  template <class F>
  void push_truths(F f) {
    truth_end_ += kRows;
    if (truth_end_ > truths_.size()) truths_.resize(truth_end_);
    Truth* const to = truths_.data() + truth_end_ - kRows;
    const std::size_t count = count_;
    for (std::size_t row = 0; row < count; ++row) to[row] = static_cast<Truth>(f(row));
  }
  const data::Words& words(std::size_t column) const { return std::get<data::Words>(columns_[column]->values); }

  const Selection& selection_;
  std::vector<const data::Column*> columns_;
  std::vector<std::vector<std::uint32_t>> places_;  ///< for each text test and distinct string, its index in the others
  std::vector<std::vector<Truth>> of_rows_;         ///< results of the row tests
  std::size_t begin_ = 0, count_ = 0;
  std::vector<double> numbers_;
  std::vector<Truth> truths_;
  std::size_t number_end_ = 0, truth_end_ = 0;
};

}  // namespace orrery::points
