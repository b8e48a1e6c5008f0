// SPDX-License-Identifier: Apache-2.0
#include "points/rows.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <span>
#include <utility>

#include <fmt/core.h>

#include "base/huge_pages.h"
#include "base/parallel.h"
#include "base/stop_point.h"
#include "base/text.h"
#include "data/columns.h"
#include "scene/value_text.h"

namespace orrery::points {

namespace {

Labels labels_of_words(const data::Words& words, const Rows& rows, std::size_t limit) {
  std::vector<std::uint8_t> occurs(words.words.size());
  for (std::size_t i = 0; i < rows.size(); ++i) occurs[words.index[rows[i]]] = 1;
  std::vector<std::uint32_t> order;
  for (std::uint32_t w = 0; w < occurs.size(); ++w)
    if (occurs[w] != 0) order.push_back(w);
  if (order.size() > limit) return {};
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return words.words[a] < words.words[b]; });
  Labels out;
  std::vector<std::uint32_t> label(words.words.size());
  for (std::uint32_t l = 0; l < order.size(); ++l) {
    out.names.push_back(words.words[order[l]]);
    label[order[l]] = l;
  }
  out.of_rows.resize(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) out.of_rows[i] = label[words.index[rows[i]]];
  return out;
}

std::string label_text(double value) {
  constexpr double kExact = 1e15;
  return value == std::floor(value) && std::abs(value) < kExact ? std::to_string(static_cast<long long>(value))
                                                                : scene::number_text(value);
}

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

constexpr const char* kSpeed = "speed";

/// The numbers of three columns; null unless all have this type.
template <class Numbers>
std::array<Numbers*, 3> columns_of(data::Table& table, const std::array<std::string, 3>& names) {
  std::array<Numbers*, 3> out{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (data::Column* const column = table.find(names[axis])) out[axis] = std::get_if<Numbers>(&column->values);
    if (out[axis] == nullptr) return {};
  }
  return out;
}

/// Moves columns into an array of points, piece by piece. Views are copied.
template <class To, class Numbers>
scene::PointArray moved(const std::array<Numbers*, 3>& columns) {
  /// Rows after which memory is returned.
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  const std::size_t count = columns[0]->size();
  base::HugeVector<To> out(3 * count);
  const base::StopPoint stop;
  for (std::size_t begin = 0; begin < count; begin += kBlock) {
    stop.check();
    const std::size_t end = std::min(count, begin + kBlock);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(begin, end, 4096), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i)
        for (std::size_t axis = 0; axis < 3; ++axis) out[3 * i + axis] = static_cast<To>((*columns[axis])[i]);
    });
    if constexpr (requires(Numbers numbers) { numbers.data(); })
      for (Numbers* const column : columns) base::release_memory(std::span(&(*column)[begin], end - begin));
  }
  return scene::PointArray(scene::NumberArray(std::move(out)));
}

template <class Numbers>
bool fit_single(const std::array<Numbers*, 3>& columns) {
  return base::are_all(columns[0]->size(), [&](std::size_t i) {
    return std::all_of(columns.begin(), columns.end(),
                       [i](const auto* column) { return scene::NumberArray::is_single((*column)[i]); });
  });
}

}  // namespace

Labels labels_of(const data::Column& column, const Rows& rows, std::size_t limit) {
  if (const auto* words = std::get_if<data::Words>(&column.values)) return labels_of_words(*words, rows, limit);
  std::map<double, std::uint32_t> labels;
  // Most labels are small integers, which a table finds faster than the map.
  std::array<std::uint32_t, 256> table{};
  const auto in_table = [&](double v) -> std::uint32_t* {
    if (!(v >= 0 && v < static_cast<double>(table.size()))) return nullptr;
    const auto n = static_cast<std::size_t>(v);
    return static_cast<double>(n) == v ? &table[n] : nullptr;
  };
  bool is_full = false;
  double last = std::nan("");
  for_each_number(column, rows, [&](std::size_t, double v) {
    if (v == last || is_full) return;
    last = v;
    std::uint32_t* const known = in_table(v);
    if (known != nullptr ? std::exchange(*known, 1) == 1 : std::isnan(v)) return;
    labels.emplace(v, 0);
    is_full = labels.size() > limit;
  });
  if (is_full) return {};
  Labels out;
  for (auto& [value, label] : labels) {
    label = static_cast<std::uint32_t>(out.names.size());
    if (std::uint32_t* const known = in_table(value)) *known = label;
    out.names.push_back(label_text(value));
    out.values.push_back(value);
  }
  // NaN is a separate label, the last.
  const auto none = static_cast<std::uint32_t>(out.names.size());
  bool has_nan = false;
  out.of_rows.resize(rows.size());
  std::uint32_t last_label = none;
  last = std::nan("");
  for_each_number(column, rows, [&](std::size_t i, double v) {
    if (v != last) {
      last = v;
      const std::uint32_t* const known = in_table(v);
      last_label = known != nullptr ? *known : std::isnan(v) ? none : labels.find(v)->second;
    }
    has_nan = has_nan || last_label == none;
    out.of_rows[i] = last_label;
  });
  if (has_nan) {
    out.names.emplace_back("nan");
    out.values.push_back(std::nan(""));
  }
  return out;
}

std::optional<Labels> require_labels(const data::Table& table, const Rows& rows, const std::string& column,
                                     std::size_t limit, const char* part, KeyFaults& faults,
                                     const std::string& remedy) {
  Labels labels = labels_of(*table.find(column), rows, limit);
  if (labels.of_rows.size() == rows.size()) return labels;
  faults.error(part, fmt::format("column `{}` has more than {} distinct values{}{}", column, limit,
                                 remedy.empty() ? "" : "; ", remedy));
  return {};
}

scene::PointArray points_of(const data::Table& table, const Rows& rows, const std::array<std::string, 3>& columns,
                            double scale) {
  scene::PointArray out(rows.size());
  for (std::size_t axis = 0; axis < 3; ++axis)
    for_each_number(*table.find(columns[axis]), rows, [&](std::size_t i, double v) { out.set(i, axis, v * scale); });
  return out;
}

scene::PointArray take_points(data::Table& table, const Rows& rows, const std::array<std::string, 3>& columns) {
  std::optional<scene::PointArray> all;
  const auto move_singles = [&](const auto& numbers) {
    if (numbers[0] != nullptr) all = moved<float>(numbers);
  };
  const auto move_doubles = [&](const auto& numbers) {
    if (numbers[0] != nullptr) all = fit_single(numbers) ? moved<float>(numbers) : moved<double>(numbers);
  };
  if (rows.is_all()) {
    move_singles(columns_of<std::vector<float>>(table, columns));
    move_singles(columns_of<data::ArrayView<float>>(table, columns));
    move_doubles(columns_of<std::vector<double>>(table, columns));
    move_doubles(columns_of<data::ArrayView<double>>(table, columns));
  }
  scene::PointArray out = all ? std::move(*all) : points_of(table, rows, columns);
  std::erase_if(table.columns, [&](const data::Column& column) {
    return std::find(columns.begin(), columns.end(), column.name) != columns.end();
  });
  return out;
}

std::string row_name(const scene::PointsKeys& points, std::size_t row) {
  return fmt::format("row {} of {}", row + 1, points.file.string());
}

std::string require_role(const data::FrameInfo& info, const std::string& role, const char* meaning, const char* part,
                         KeyFaults& faults) {
  if (role.empty())
    faults.error(part, fmt::format("the file has no {}; its columns are {}", meaning, data::listed(info.columns)));
  return role;
}

bool require_column(const data::FrameInfo& info, const std::string& name, bool is_number, const std::string& part,
                    KeyFaults& faults) {
  if (const data::ColumnInfo* const found = data::find_named(info.columns, name)) {
    if (!is_number || found->type != data::ColumnType::kText) return true;
    faults.error(part, fmt::format("column `{}` is text; it must be a number", name));
    return false;
  }
  std::vector<std::string> names;
  for (const data::ColumnInfo& c : info.columns) names.push_back(c.name);
  const std::string suggestion = base::did_you_mean(name, names);
  faults.error(part, fmt::format("the file has no column `{}`; {}its columns are {}", name,
                                 suggestion.empty() ? "" : suggestion + " ", data::listed(info.columns)));
  return false;
}

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

std::vector<std::string> velocity_of(const data::FrameInfo& info) {
  const std::array<std::string, 3> names =
      data::number_columns(info.columns, {{"vx", "vy", "vz"},
                                          {"velocity[1]", "velocity[2]", "velocity[3]"},
                                          {"velocities[1]", "velocities[2]", "velocities[3]"},
                                          {"vel[1]", "vel[2]", "vel[3]"},
                                          {"velo[1]", "velo[2]", "velo[3]"}});
  return names[0].empty() ? std::vector<std::string>() : std::vector<std::string>(names.begin(), names.end());
}

void add_derived_columns(data::FrameInfo& info) {
  if (data::find_named(info.columns, kSpeed) == nullptr && !velocity_of(info).empty())
    info.columns.push_back({kSpeed, data::ColumnType::kFloat64, true});
}

std::vector<std::string> sources_of(const data::FrameInfo& info, const std::string& column) {
  const data::ColumnInfo* const known = data::find_named(info.columns, column);
  return known != nullptr && known->is_derived ? velocity_of(info) : std::vector<std::string>();
}

void compute_speed(const std::vector<std::string>& sources, data::Table& table) {
  std::vector<double> speed(table.rows);
  for (const std::string& name : sources)
    for_each_number(*table.find(name), Rows(table.rows), [&](std::size_t i, double v) { speed[i] += v * v; });
  for (double& s : speed) s = std::sqrt(s);
  table.columns.push_back({kSpeed, std::move(speed)});
}

}  // namespace orrery::points
