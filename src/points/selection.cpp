// SPDX-License-Identifier: Apache-2.0
#include "points/selection.h"

#include <algorithm>
#include <unordered_map>
#include <variant>

#include "points/selection_run.h"

namespace orrery::points {
namespace {

/// For each string of `from`, its index in `to`; the number of strings in `to` if it is not found.
std::vector<std::uint32_t> places_in(const std::vector<std::string>& from, const std::vector<std::string>& to) {
  std::unordered_map<std::string_view, std::uint32_t> places;
  for (std::size_t i = 0; i < to.size(); ++i) places.emplace(to[i], static_cast<std::uint32_t>(i));
  std::vector<std::uint32_t> out;
  for (const std::string& word : from) {
    const auto found = places.find(word);
    out.push_back(found == places.end() ? static_cast<std::uint32_t>(to.size()) : found->second);
  }
  return out;
}

/// Evaluates all rows, block by block.
template <class Value>
void evaluate_rows(const Selection& selection, const data::Table& table, std::vector<Value>& out) {
  SelectionRun run(selection, table);
  for (std::size_t begin = 0; begin < table.rows; begin += SelectionRun::kRows)
    run.run(begin, std::min(SelectionRun::kRows, table.rows - begin), out.data() + begin);
}

}  // namespace

SelectionRun::SelectionRun(const Selection& selection, const data::Table& table) : selection_(selection) {
  for (const std::string& name : selection.columns) columns_.push_back(table.find(name));
  for (const TextTest& test : selection.text_tests)
    places_.push_back(places_in(words(test.column).words, test.is_same ? words(test.other).words : test.words));
}

void SelectionRun::run(std::size_t begin, std::size_t count) {
  begin_ = begin;
  count_ = count;
  number_end_ = truth_end_ = 0;
  for (const SelectionStep& step : selection_.steps) step(*this);
}

void SelectionRun::run(std::size_t begin, std::size_t count, Truth* out) {
  run(begin, count);
  std::copy_n(truths_.data(), count, out);
}

void SelectionRun::run(std::size_t begin, std::size_t count, double* out) {
  run(begin, count);
  std::copy_n(numbers_.data(), count, out);
}

double* SelectionRun::push_numbers() {
  number_end_ += kRows;
  if (number_end_ > numbers_.size()) numbers_.resize(number_end_);
  return numbers(1);
}

void SelectionRun::load(std::size_t column) {
  double* const to = push_numbers();
  std::visit(
      [&](const auto& values) {
        if constexpr (!requires { values.index; })
          for (std::size_t row = 0; row < count_; ++row) to[row] = static_cast<double>(values[begin_ + row]);
      },
      columns_[column]->values);
}

void SelectionRun::push_constant(double value) { std::fill_n(push_numbers(), count_, value); }

void SelectionRun::find(const std::vector<NumberRange>& ranges) {
  const double* const a = numbers(1);
  push_truths([&](std::size_t row) {
    const auto above = std::upper_bound(ranges.begin(), ranges.end(), a[row],
                                        [](double value, const NumberRange& range) { return value < range.low; });
    return above != ranges.begin() && a[row] <= above[-1].high;  // false for NaN
  });
  number_end_ -= kRows;
}

void SelectionRun::test_text(std::size_t index) {
  const TextTest& test = selection_.text_tests[index];
  const std::uint32_t *const place = places_[index].data(), *const word = words(test.column).index.data() + begin_;
  if (test.is_same) {
    const std::uint32_t* const other = words(test.other).index.data() + begin_;
    push_truths([&](std::size_t row) { return place[word[row]] == other[row]; });
  } else {
    const auto none = static_cast<std::uint32_t>(test.words.size());
    push_truths([&](std::size_t row) { return place[word[row]] != none; });
  }
}

void SelectionRun::negate() {
  Truth* const a = truths_.data() + truth_end_ - kRows;
  const std::size_t count = count_;
  for (std::size_t row = 0; row < count; ++row) a[row] ^= 1;
}

std::vector<std::uint8_t> Selection::evaluate(const data::Table& table) const {
  std::vector<std::uint8_t> out(table.rows, 1);
  if (!steps.empty()) evaluate_rows(*this, table, out);
  return out;
}

std::vector<double> Expression::evaluate(const data::Table& table) const {
  std::vector<double> out(table.rows);
  evaluate_rows(steps, table, out);
  return out;
}

}  // namespace orrery::points
