// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include "base/error.h"
#include "math/scalar.h"
#include "math/vec3.h"
#include "points/copies.h"
#include "points/sources.h"

namespace orrery::points {

namespace {

/// Splits "CONDITION: TEXT" at the first colon that a space follows: ranges in conditions contain colons, too.
std::pair<std::string, std::string> parse_label(const std::string& text) {
  const std::size_t colon = text.find(": ");
  if (colon == std::string::npos || colon == 0 || colon + 2 == text.size())
    base::refuse(fmt::format("`{}` is not a label; write CONDITION: TEXT, e.g. 'id == 5: Fe'", text));
  return {text.substr(0, colon), text.substr(colon + 2)};
}

}  // namespace

std::vector<LabelRule> label_rules(const data::FrameInfo& info, const scene::PointsKeys& points, KeyFaults& faults) {
  std::vector<LabelRule> out;
  for (std::size_t i = 0; i < points.labels.size(); ++i) {
    const std::string key = fmt::format(".labels[{}]", i);
    try {
      const auto [condition, text] = parse_label(points.labels[i]);
      out.push_back({parse_selection(condition, info.columns), text});
    } catch (const base::Error& error) {
      faults.error(key, fault_text(error));
    }
  }
  return out;
}

std::vector<scene::Label> placed_labels(const data::Table& table, const Rows& rows, const scene::PointArray& centers,
                                        const std::vector<LabelRule>& rules, const Copy& first,
                                        const scene::PointsKeys& points, KeyFaults& faults) {
  std::vector<scene::Label> out;
  const data::Transform placement = transform_of(points.transform);
  for (std::size_t r = 0; r < rules.size(); ++r) {
    const std::vector<std::uint8_t> mask = rules[r].condition.evaluate(table);
    data::Vec3d low{math::kInfinity, math::kInfinity, math::kInfinity}, high = low * -1.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (mask[rows[i]] == 0) continue;
      const data::Vec3d c = centers[i];
      low = math::least(low, c);
      high = math::greatest(high, c);
    }
    if (low.x <= high.x)
      out.push_back({applied(placement, applied(first.transform, (low + high) * 0.5)), rules[r].text});
    else
      faults.warning(fmt::format(".labels[{}]", r),
                     fmt::format("`{}` matches none of the particles that are drawn", points.labels[r]));
  }
  return out;
}

}  // namespace orrery::points
