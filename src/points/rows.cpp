// SPDX-License-Identifier: Apache-2.0
#include "points/rows.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/core.h>

#include "base/text.h"
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

}  // namespace

Labels labels_of(const data::Column& column, const Rows& rows, std::size_t limit) {
  if (const auto* words = std::get_if<data::Words>(&column.values)) return labels_of_words(*words, rows, limit);
  std::map<double, std::uint32_t> labels;
  bool is_full = false;
  double last = std::nan("");
  for_each_number(column, rows, [&](std::size_t, double v) {
    if (v == last || is_full) return;
    last = v;
    if (!std::isnan(v)) labels.emplace(v, 0);
    is_full = labels.size() > limit;
  });
  if (is_full) return {};
  Labels out;
  for (auto& [value, label] : labels) {
    label = static_cast<std::uint32_t>(out.names.size());
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
      last_label = std::isnan(v) ? none : labels.find(v)->second;
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

std::string column_names(const data::FrameInfo& info) {
  constexpr std::size_t kMaxNamed = 30;
  std::vector<std::string> names;
  for (const data::ColumnInfo& c : info.columns)
    if (names.size() < kMaxNamed) names.push_back(c.name);
  std::string out = base::joined(names);
  if (info.columns.size() > kMaxNamed) out += fmt::format(" ({} more)", info.columns.size() - kMaxNamed);
  return out;
}

bool require_column(const data::FrameInfo& info, const std::string& name, bool is_number, const std::string& part,
                    KeyFaults& faults) {
  std::vector<std::string> names;
  for (const data::ColumnInfo& c : info.columns) {
    names.push_back(c.name);
    if (c.name != name) continue;
    if (!is_number || c.type != data::ColumnType::kText) return true;
    faults.error(part, fmt::format("column `{}` is text; it must be a number", name));
    return false;
  }
  const std::string suggestion = base::did_you_mean(name, names);
  faults.error(part, fmt::format("the file has no column `{}`; {}its columns are {}", name,
                                 suggestion.empty() ? "" : suggestion + " ", column_names(info)));
  return false;
}

}  // namespace orrery::points
