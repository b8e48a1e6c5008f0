// SPDX-License-Identifier: Apache-2.0
// Random selections against an evaluator that computes one row at a time from the same random tree.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "points/selection.h"

namespace orrery::points {
namespace {

using data::Column;
using data::Table;
using data::Words;

/// A random expression, as text and as a function of the row.
template <class T>
struct Random {
  std::string text;
  std::function<T(std::size_t)> at;
};
using Number = Random<double>;
using Condition = Random<bool>;

class RandomSelections {
 public:
  /// Two blocks and a part of a third. Few values, so that they are often equal.
  RandomSelections() {
    constexpr std::size_t kRows = 2500;
    table_.rows = kRows;
    std::vector<double> x(kRows);
    std::vector<float> z(kRows);
    std::vector<std::int32_t> type(kRows);
    Words element{{"C", "N", "CA", ""}, std::vector<std::uint32_t>(kRows)};
    Words label{{"N", "O", "C"}, std::vector<std::uint32_t>(kRows)};
    for (std::size_t i = 0; i < kRows; ++i) {
      x[i] = chance(10) ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(below(9)) - 4;
      z[i] = chance(20) ? std::numeric_limits<float>::infinity() : static_cast<float>(below(40)) / 8 - 2;
      type[i] = static_cast<std::int32_t>(below(4));
      element.index[i] = below(4);
      label.index[i] = below(3);
    }
    table_.columns = {Column{"x", x}, Column{"z", z}, Column{"type", type}, Column{"element", element},
                      Column{"label", label}};
  }

  const Table& table() const { return table_; }

  Condition condition(int depth) {
    if (depth > 0 && !chance(4)) {
      const Condition a = condition(depth - 1);
      if (chance(4)) return {"!(" + a.text + ")", [a](std::size_t i) { return !a.at(i); }};
      const Condition b = condition(depth - 1);
      if (chance(2)) return {"(" + a.text + ") && " + b.text, [a, b](std::size_t i) { return a.at(i) && b.at(i); }};
      return {"(" + a.text + " || " + b.text + ")", [a, b](std::size_t i) { return a.at(i) || b.at(i); }};
    }
    return chance(3) ? text_condition() : number_condition();
  }

 private:
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(random_() % n); }
  bool chance(std::uint32_t n) { return below(n) == 0; }

  std::string word_at(const char* column, std::size_t row) const {
    const Words& words = std::get<Words>(table_.find(column)->values);
    return words.words[words.index[row]];
  }

  Condition text_condition() {
    const char* const column = chance(2) ? "element" : "label";
    const char* const kWords[] = {"C", "N", "CA", "O", "Zr"};
    const std::string first = kWords[below(5)], second = kWords[below(5)];
    const auto word = [this, column](std::size_t i) { return word_at(column, i); };
    switch (below(4)) {
      case 0: return {column + (" == '" + first) + "'", [=](std::size_t i) { return word(i) == first; }};
      case 1: return {column + (" != '" + first) + "'", [=](std::size_t i) { return word(i) != first; }};
      case 2:
        return {column + (" in {" + first) + ", \"" + second + "\"}",
                [=](std::size_t i) { return word(i) == first || word(i) == second; }};
      default:
        return {"element != label", [this](std::size_t i) { return word_at("element", i) != word_at("label", i); }};
    }
  }

  Condition number_condition() {
    const Number a = number(3);
    if (chance(3)) return list_condition(a);
    const Number b = number(3);
    const auto compared = [&](const char* op, auto f) {
      return Condition{a.text + op + b.text, [a, b, f](std::size_t i) { return f(a.at(i), b.at(i)); }};
    };
    switch (below(6)) {
      case 0: return compared("==", [](double p, double q) { return p == q; });
      case 1: return compared(" != ", [](double p, double q) { return p != q && p == p && q == q; });
      case 2: return compared("<", [](double p, double q) { return p < q; });
      case 3: return compared(" <= ", [](double p, double q) { return p <= q; });
      case 4: return compared(" > ", [](double p, double q) { return p > q; });
      default: return compared(">=", [](double p, double q) { return p >= q; });
    }
  }

  /// Some numbers, closed ranges and half-open ones.
  Condition list_condition(const Number& a) {
    constexpr double kUnbounded = std::numeric_limits<double>::infinity();
    std::vector<std::pair<double, double>> ranges;
    std::string list;
    for (std::uint32_t n = 1 + below(4); n > 0; --n) {
      const int low = static_cast<int>(below(12)) - 6, high = low + static_cast<int>(below(4));
      const std::string from = std::to_string(low), to = std::to_string(high);
      list += list.empty() ? "" : ", ";
      switch (below(chance(3) ? 4 : 2)) {
        case 0: ranges.emplace_back(low, low), list += from; break;
        case 1: ranges.emplace_back(low, high), list += from + ":" + to; break;
        case 2: ranges.emplace_back(high, kUnbounded), list += to + ":"; break;
        default: ranges.emplace_back(-kUnbounded, low), list += ":" + from; break;
      }
    }
    return {a.text + " in [" + list + "]", [a, ranges](std::size_t i) {
              for (const auto& [low, high] : ranges)
                if (a.at(i) >= low && a.at(i) <= high) return true;
              return false;
            }};
  }

  Number number(int depth) {
    if (depth == 0 || chance(3)) {
      if (chance(3)) {
        const double value = static_cast<double>(below(20)) / 4;
        return {std::to_string(value), [value](std::size_t) { return value; }};
      }
      const char* const kColumns[] = {"x", "z", "type"};
      const char* const column = kColumns[below(3)];
      return {column, [this, column](std::size_t i) { return table_.find(column)->number(i); }};
    }
    const Number a = number(depth - 1);
    if (chance(6)) return {"abs(" + a.text + ")", [a](std::size_t i) { return std::abs(a.at(i)); }};
    if (chance(6)) return {"sqrt(" + a.text + ")", [a](std::size_t i) { return std::sqrt(a.at(i)); }};
    if (chance(6)) return {"-(" + a.text + ")", [a](std::size_t i) { return -a.at(i); }};
    const Number b = number(depth - 1);
    switch (below(6)) {
      case 0: return {"(" + a.text + " + " + b.text + ")", [a, b](std::size_t i) { return a.at(i) + b.at(i); }};
      case 1: return {"(" + a.text + "-" + b.text + ")", [a, b](std::size_t i) { return a.at(i) - b.at(i); }};
      case 2: return {"(" + a.text + ") * (" + b.text + ")", [a, b](std::size_t i) { return a.at(i) * b.at(i); }};
      case 3: return {"((" + a.text + ") / (" + b.text + "))", [a, b](std::size_t i) { return a.at(i) / b.at(i); }};
      case 4: return {"min(" + a.text + ", " + b.text + ")", [a, b](std::size_t i) { return least(a.at(i), b.at(i)); }};
      default:
        return {"max(" + a.text + ", " + b.text + ")", [a, b](std::size_t i) { return -least(-a.at(i), -b.at(i)); }};
    }
  }

  static double least(double a, double b) { return std::isnan(a) || std::isnan(b) ? a + b : std::min(a, b); }

  std::mt19937_64 random_{1};
  Table table_;
};

TEST(PointsSelectionRandom, EqualsANaiveEvaluator) {
  RandomSelections selections;
  const Table& table = selections.table();
  std::vector<data::ColumnInfo> columns;
  for (const Column& column : table.columns) columns.push_back({column.name, column.type()});
  std::size_t selected = 0;
  constexpr int kSelections = 400;
  for (int n = 0; n < kSelections; ++n) {
    const Condition wanted = selections.condition(4);
    const std::vector<std::uint8_t> mask = parse_selection(wanted.text, columns).evaluate(table);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < table.rows; ++i) {
      selected += mask[i];
      wrong += mask[i] != static_cast<std::uint8_t>(wanted.at(i)) ? 1 : 0;
    }
    ASSERT_EQ(wrong, 0u) << wanted.text;
  }
  // The selections are neither empty nor full.
  EXPECT_GT(selected, kSelections * table.rows / 4);
  EXPECT_LT(selected, kSelections * table.rows * 3 / 4);
}

}  // namespace
}  // namespace orrery::points
