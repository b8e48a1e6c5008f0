// SPDX-License-Identifier: Apache-2.0
#include "points/selection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <utility>
#include <variant>

#include "base/stop_point.h"
#include "math/vec3.h"
#include "points/rows.h"
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

/// Returns the rows that are at most `distance` from one of the `others`; those are, too.
std::vector<std::uint8_t> near_rows(const std::array<const data::Column*, 3>& position, double distance,
                                    std::vector<std::uint8_t> others) {
  // Cells as large as the distance, so that 27 of them contain all rows in reach.
  using Cell = std::array<std::int64_t, 3>;
  struct HashOfCell {
    std::size_t operator()(const Cell& cell) const {
      std::uint64_t hash = 0;
      for (const std::int64_t k : cell)
        hash = (hash ^ hash >> 29 ^ static_cast<std::uint64_t>(k)) * 0x9E3779B97F4A7C15u;
      return hash ^ hash >> 32;
    }
  };
  const auto place_of = [&](std::size_t row) {
    return math::Vec3d{position[0]->number(row), position[1]->number(row), position[2]->number(row)};
  };
  const auto cell_of = [&](const math::Vec3d& place) {
    constexpr double kFarthest = 1e15;
    Cell out;
    std::size_t axis = 0;
    for (const double x : {place.x, place.y, place.z})
      out[axis++] = static_cast<std::int64_t>(std::clamp(std::floor(x / distance), -kFarthest, kFarthest));
    return out;
  };
  std::unordered_map<Cell, std::vector<math::Vec3d>, HashOfCell> cells;
  const base::StopPoint stop;
  for (std::size_t row = 0; row < others.size(); ++row)
    if (others[row] != 0 && math::is_finite(place_of(row))) cells[cell_of(place_of(row))].push_back(place_of(row));
  const auto is_near = [&](const math::Vec3d& place) {
    const Cell middle = cell_of(place);
    for (std::int64_t step = 0; step < 27; ++step) {
      const auto found = cells.find({middle[0] + step % 3 - 1, middle[1] + step / 3 % 3 - 1, middle[2] + step / 9 - 1});
      if (found == cells.end()) continue;
      for (const math::Vec3d& other : found->second)
        if (math::length(other - place) <= distance) return true;
    }
    return false;
  };
  for (std::size_t row = 0; row < others.size() && !cells.empty(); ++row) {
    stop.check(row);
    const math::Vec3d place = place_of(row);
    if (others[row] == 0 && math::is_finite(place)) others[row] = is_near(place) ? 1 : 0;
  }
  return others;
}

/// Returns the rows that have the same values in some columns as one of the `others`.
std::vector<std::uint8_t> rows_of_groups(const std::vector<const data::Column*>& columns,
                                         std::vector<std::uint8_t> others) {
  const Rows all(others.size());
  std::vector<std::uint32_t> group(others.size());
  for (const data::Column* column : columns) {
    const Labels labels = labels_of(*column, all, others.size());
    std::unordered_map<std::uint64_t, std::uint32_t> numbers;
    for (std::size_t row = 0; row < group.size(); ++row) {
      const std::uint64_t key = std::uint64_t{group[row]} << 32 | labels.of_rows[row];
      group[row] = numbers.try_emplace(key, static_cast<std::uint32_t>(numbers.size())).first->second;
    }
  }
  std::vector<std::uint8_t> is_in(others.size());
  for (std::size_t row = 0; row < others.size(); ++row)
    if (others[row] != 0) is_in[group[row]] = 1;
  for (std::size_t row = 0; row < others.size(); ++row) others[row] = is_in[group[row]];
  return others;
}

}  // namespace

SelectionRun::SelectionRun(const Selection& selection, const data::Table& table) : selection_(selection) {
  for (const std::string& name : selection.columns) columns_.push_back(table.find(name));
  for (const TextTest& test : selection.text_tests)
    places_.push_back(places_in(words(test.column).words, test.is_same ? words(test.other).words : test.words));
  for (const RowTest& test : selection.row_tests) of_rows_.push_back(truths_of(test, table.rows));
}

std::vector<SelectionRun::Truth> SelectionRun::truths_of(const RowTest& test, std::size_t rows) {
  std::vector<Truth> others(rows);
  for (std::size_t begin = 0; begin < rows; begin += kRows) {
    run(test.steps, begin, std::min(kRows, rows - begin));
    std::copy_n(truths_.data(), count_, others.data() + begin);
  }
  std::vector<const data::Column*> columns;
  for (const std::size_t column : test.columns) columns.push_back(columns_[column]);
  return test.distance > 0 ? near_rows({columns[0], columns[1], columns[2]}, test.distance, std::move(others))
                           : rows_of_groups(columns, std::move(others));
}

void SelectionRun::run(const std::vector<SelectionStep>& steps, std::size_t begin, std::size_t count) {
  begin_ = begin;
  count_ = count;
  number_end_ = truth_end_ = 0;
  for (const SelectionStep& step : steps) step(*this);
}

void SelectionRun::run(std::size_t begin, std::size_t count, Truth* out) {
  run(selection_.steps, begin, count);
  std::copy_n(truths_.data(), count, out);
}

void SelectionRun::run(std::size_t begin, std::size_t count, double* out) {
  run(selection_.steps, begin, count);
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

void SelectionRun::test_rows(std::size_t index) {
  const Truth* const of = of_rows_[index].data() + begin_;
  push_truths([&](std::size_t row) { return of[row]; });
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
