// SPDX-License-Identifier: Apache-2.0
#include "points/id_order.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <type_traits>
#include <utility>
#include <variant>

#include "base/stop_point.h"
#include "data/table.h"
#include "points/rows.h"

namespace orrery::points {
namespace {

/// Order of ids. Missing ones come last.
template <class T>
bool is_before(T a, T b) {
  if constexpr (std::is_floating_point_v<T>)
    if (std::isnan(a) || std::isnan(b)) return !std::isnan(a) && std::isnan(b);
  return a < b;
}

template <class Ids>
bool ascend(const Ids& ids) {
  for (std::size_t i = 1; i < ids.size(); ++i)
    if (is_before(ids[i], ids[i - 1])) return false;
  return true;
}

template <class Ids>
void sort(const Ids& ids, std::vector<std::uint32_t>& rows) {
  // Ids are usually a permutation of 1 to N, so each row's position is known.
  constexpr std::uint32_t kFree = 0xffffffff;
  std::vector<std::uint32_t> at(ids.size() + 1, kFree);
  bool is_permutation = true;
  for (const std::uint32_t row : rows) {
    const auto n = static_cast<double>(ids[row]);
    is_permutation = n >= 0 && n <= static_cast<double>(ids.size()) && n == std::floor(n) &&
                     at[static_cast<std::size_t>(n)] == kFree;
    if (!is_permutation) break;
    at[static_cast<std::size_t>(n)] = row;
  }
  if (!is_permutation) {
    std::stable_sort(rows.begin(), rows.end(), [&](auto a, auto b) { return is_before(ids[a], ids[b]); });
    return;
  }
  rows.clear();
  for (const std::uint32_t row : at)
    if (row != kFree) rows.push_back(row);
}

template <class Ids>
void order(const Ids& ids, std::vector<std::uint32_t>& rows) {
  const base::StopPoint stop;
  stop.check();
  if (ascend(ids)) return;
  if (rows.empty()) {
    rows.resize(ids.size());
    std::iota(rows.begin(), rows.end(), 0U);
  }
  stop.check();
  sort(ids, rows);
}

/// The number of equal neighbours; missing ids are not equal.
template <class Ids>
std::size_t count_repeated(const Ids& ids, const std::vector<std::uint32_t>& rows) {
  std::size_t out = 0;
  const std::size_t count = rows.empty() ? ids.size() : rows.size();
  for (std::size_t i = 1; i < count; ++i) out += rows.empty() ? ids[i] == ids[i - 1] : ids[rows[i]] == ids[rows[i - 1]];
  return out;
}

}  // namespace

Rows rows_by_id(const data::Column& ids, std::vector<std::uint32_t> selected, std::size_t& repeated) {
  repeated = 0;
  std::size_t count = 0;
  // In the type in which the file stores them: a double cannot represent all 64-bit ids.
  std::visit(
      [&](const auto& values) {
        if constexpr (std::is_same_v<std::decay_t<decltype(values)>, data::Words>) {
          count = values.index.size();  // unordered
        } else {
          count = values.size();
          order(values, selected);
          repeated = count_repeated(values, selected);
        }
      },
      ids.values);
  return selected.empty() ? Rows(count) : Rows(std::move(selected));
}

}  // namespace orrery::points
