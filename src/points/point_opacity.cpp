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

}  // namespace

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
  out.rules = rules_of(info, opacity.where, ".opacity.where", parse_opacity, faults);
  return out;
}

std::vector<float> opacities_of(const data::Table& table, const Rows& rows, const OpacitySource& source,
                                const scene::PointsKeys& points, KeyFaults& faults) {
  const scene::PointsOpacity& opacity = points.opacity;
  std::vector<float> out(rows.size(), kOfMaterial);
  std::vector<std::uint8_t> has_rule(rows.size());
  apply_rules(table, rows, source.rules, opacity.where, ".opacity.where", faults, [&](std::size_t i, float value) {
    has_rule[i] = 1;
    out[i] = value;
  });
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
