// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/core.h>

#include "base/text.h"
#include "data/columns.h"
#include "data/elements.h"
#include "points/sources.h"
#include "scene/value_text.h"

namespace orrery::points {
namespace {

/// The radius of an element: "vdw", "covalent" or "ball".
double radius_of(const data::Element& element, const std::string& kind) {
  constexpr double kBallScale = 0.25;  // viewers draw balls and sticks with 0.2 to 0.3
  if (kind == "covalent") return element.covalent;
  return kind == "ball" ? kBallScale * element.van_der_waals : element.van_der_waals;
}

/// Returns the radius of each label; reports labels without a radius, all in one message.
std::vector<double> radii_of_labels(const Labels& labels, const RadiusSource& source, const scene::PointsRadius& radius,
                                    KeyFaults& faults) {
  std::vector<double> out;
  std::vector<std::string> missing;
  for (const std::string& name : labels.names) {
    double r = 0;
    if (source.kind == RadiusSource::Kind::kElement) {
      if (const data::Element* element = data::find_element(name))
        r = radius_of(*element, radius.element) * source.scale;
    } else {
      for (const auto& [type, value] : radius.types)
        if (type == name) r = value;
    }
    if (!(r > 0)) missing.push_back(fmt::format("`{}`", name));
    out.push_back(r);
  }
  if (missing.empty()) return out;
  constexpr std::size_t kMaxNamed = 10;
  const std::size_t count = missing.size();
  missing.resize(std::min(count, kMaxNamed));
  const std::string names = base::joined(missing) + (count > kMaxNamed ? " ..." : "");
  if (source.kind == RadiusSource::Kind::kElement)
    faults.error(
        ".radius.element",
        fmt::format(
            "no radius is known for {} in column `{}`; leave these rows out with `select`, or set another radius",
            names, source.column));
  else
    faults.error(".radius.type", fmt::format("type {} has no radius; add it, e.g. `type = {{ {} = 0.5 }}`", names,
                                             labels.names.back()));
  return out;
}

}  // namespace

RadiusSource radius_source(const data::FrameInfo& info, const scene::PointsRadius& radius, KeyFaults& faults) {
  RadiusSource out;
  out.scale = radius.scale;
  const int set = (radius.value ? 1 : 0) + (radius.column.empty() ? 0 : 1) + (radius.element.empty() ? 0 : 1) +
                  (radius.types.empty() ? 0 : 1);
  if (set > 1) {
    faults.error(".radius", "only one of `column`, `element` and `type` can be set");
  } else if (radius.value) {
    out.kind = RadiusSource::Kind::kValue;
  } else if (!radius.column.empty()) {
    out.kind = RadiusSource::Kind::kColumn;
    out.column = radius.column;
    const bool is_table = base::contains({"vdw", "covalent", "ball"}, radius.column);
    if (is_table && data::find_named(info.columns, radius.column) == nullptr)
      faults.error(".radius.column", fmt::format("the file has no column `{0}`; radii by chemical element are "
                                                 "`radius.element = \"{0}\"`, or --element-radii {0}",
                                                 radius.column));
    else
      require_column(info, radius.column, true, ".radius.column", faults);
    if (radius.column == info.roles.radius && info.roles.radius_scale != 1 && radius.scale == 1)
      faults.warning(".radius.column", fmt::format("column `{}` holds diameters; set the scale to {}", radius.column,
                                                   scene::number_text(info.roles.radius_scale)));
  } else if (!radius.element.empty()) {
    out.kind = RadiusSource::Kind::kElement;
    out.column = require_role(info, info.roles.element, "column of chemical elements", ".radius.element", faults);
  } else if (!radius.types.empty()) {
    out.kind = RadiusSource::Kind::kType;
    out.column = require_role(info, info.roles.type, "column of particle types", ".radius.type", faults);
  } else if (!info.roles.radius.empty()) {
    out.kind = RadiusSource::Kind::kColumn;
    out.column = info.roles.radius;
    out.scale = radius.scale * info.roles.radius_scale;
  } else {
    faults.error(
        ".radius",
        "the file has no radius; set `radius` to a number, or to a column, an element table or types, e.g. `radius "
        "= { column = \"size\", scale = 0.5 }`; its columns are " +
            data::listed(info.columns));
  }
  out.rules = rules_of(info, radius.where, ".radius.where", parse_radius, faults);
  return out;
}

namespace {

scene::NumberArray radii_of_source(const data::Table& table, const Rows& rows, const RadiusSource& source,
                                   const scene::PointsRadius& radius, KeyFaults& faults) {
  if (source.kind == RadiusSource::Kind::kValue) return scene::NumberArray(rows.size(), radius.value.value_or(1));
  scene::NumberArray out;
  out.reserve(rows.size());
  if (source.kind == RadiusSource::Kind::kColumn) {
    for_each_number(*table.find(source.column), rows, [&](std::size_t, double v) { out.push_back(v * source.scale); });
    return out;
  }
  const std::optional<Labels> labels = require_labels(table, rows, source.column, kMaxTypes, ".radius", faults);
  if (!labels) return out;
  const std::vector<double> of_labels = radii_of_labels(*labels, source, radius, faults);
  for (std::size_t i = 0; i < rows.size(); ++i) out.push_back(of_labels[labels->of_rows[i]]);
  return out;
}

}  // namespace

scene::NumberArray radii_of(const data::Table& table, const Rows& rows, const RadiusSource& source,
                            const scene::PointsRadius& radius, KeyFaults& faults) {
  scene::NumberArray out = radii_of_source(table, rows, source, radius, faults);
  if (out.size() == rows.size())
    apply_rules(table, rows, source.rules, radius.where, ".radius.where", faults,
                [&](std::size_t i, double value) { out.set(i, value); });
  return out;
}

}  // namespace orrery::points
