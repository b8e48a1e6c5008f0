// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>

#include <fmt/core.h>

#include "base/error.h"
#include "base/text.h"
#include "data/text_lines.h"
#include "points/sources.h"
#include "scene/limits.h"
#include "scene/value_text.h"

namespace orrery::points {
namespace {

/// Marks spheres with the opacity of their material.
constexpr float kOfMaterial = -1;

bool is_opacity(double x) { return x >= 0 && x <= 1; }  // false for NaN

[[noreturn]] void refuse_rule(const std::string& text, const std::string& fault) {
  base::refuse(fmt::format("`{}` {}; write CONDITION:NUMBER, e.g. 'type == 2: 0.2'", text, fault));
}

}  // namespace

OpacityRule parse_opacity_rule(const std::string& text) {
  const std::size_t colon = end_of_expression(text);
  const bool has_condition = colon != std::string::npos;
  OpacityRule out;
  if (has_condition) out.condition = data::trimmed(std::string_view(text).substr(0, colon));
  const std::string_view number = std::string_view(text).substr(has_condition ? colon + 1 : 0);
  if (!base::from_text(data::trimmed(number), out.opacity) || !is_opacity(out.opacity))
    refuse_rule(text, has_condition ? "does not end in a number in 0..1" : "has no colon, and is no number in 0..1");
  if (has_condition && out.condition.empty()) refuse_rule(text, "has no condition before its colon");
  return out;
}

OpacitySource opacity_source(const data::FrameInfo& info, const scene::PointsOpacity& opacity, KeyFaults& faults) {
  OpacitySource out;
  if (!opacity.column.empty() && !opacity.types.empty()) {
    faults.error(".opacity", "only one of `column` and `type` can be set");
  } else if (!opacity.column.empty()) {
    out.column = opacity.column;
    require_column(info, opacity.column, true, ".opacity.column", faults);
  } else if (!opacity.types.empty()) {
    out.column = require_role(info, info.roles.type, "column of particle types", ".opacity.type", faults);
  }
  if (!out.column.empty()) out.needed.push_back(out.column);
  for (std::size_t i = 0; i < opacity.where.size(); ++i) {
    const std::string key = fmt::format(".opacity.where[{}]", i);
    try {
      const OpacityRule rule = parse_opacity_rule(opacity.where[i]);
      out.rules.push_back({parse_selection(rule.condition, info.columns), static_cast<float>(rule.opacity)});
      for (const std::string& column : out.rules.back().condition.columns) out.needed.push_back(column);
    } catch (const base::Error& error) {
      faults.error(key, fault_text(error));
    }
  }
  return out;
}

std::vector<float> opacities_of(const data::Table& table, const Rows& rows, const OpacitySource& source,
                                const scene::PointsKeys& points, KeyFaults& faults) {
  const scene::PointsOpacity& opacity = points.opacity;
  std::vector<float> out(rows.size(), kOfMaterial);
  std::vector<std::uint8_t> has_rule(rows.size());
  for (std::size_t r = 0; r < source.rules.size(); ++r) {
    const OpacitySource::Rule& rule = source.rules[r];
    const std::vector<std::uint8_t> mask = rule.condition.evaluate(table);
    bool matches = false;
    for (std::size_t i = 0; i < rows.size(); ++i)
      if (mask[rows[i]] != 0) {
        matches = true;
        has_rule[i] = 1;
        out[i] = rule.opacity;
      }
    if (!matches && rows.size() > 0)
      faults.warning(fmt::format(".opacity.where[{}]", r),
                     fmt::format("`{}` matches none of the particles that are drawn", opacity.where[r]));
  }
  if (source.column.empty()) return out;
  if (!opacity.types.empty()) {
    const std::optional<Labels> labels = require_labels(table, rows, source.column, kMaxTypes, ".opacity.type", faults);
    if (!labels) return out;
    std::vector<float> of_labels(labels->names.size(), kOfMaterial);
    for (std::size_t l = 0; l < of_labels.size(); ++l)
      for (const auto& [type, value] : opacity.types)
        if (type == labels->names[l]) of_labels[l] = static_cast<float>(value);
    for (std::size_t i = 0; i < rows.size(); ++i)
      if (has_rule[i] == 0) out[i] = of_labels[labels->of_rows[i]];
    return out;
  }
  std::size_t bad = 0;
  for_each_number(*table.find(source.column), rows, [&](std::size_t i, double v) {
    if (has_rule[i] != 0) return;
    if (is_opacity(v))
      out[i] = static_cast<float>(v);
    else if (++bad <= scene::kMaxReported)
      faults.error(".opacity.column", fmt::format("{} has opacity {} in column `{}`; must be in 0..1",
                                                  row_name(points, rows[i]), scene::number_text(v), source.column));
  });
  if (bad > 0)
    faults.error(".opacity.column",
                 fmt::format("{} of {} rows have opacities outside 0..1; leave them out with `select`, or set others, "
                             "e.g. `where = [\"!({} >= 0 && {} <= 1): 1\"]`",
                             bad, rows.size(), source.column, source.column));
  return out;
}

}  // namespace orrery::points
