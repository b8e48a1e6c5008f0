// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include "base/error.h"
#include "math/scalar.h"
#include "math/vec3.h"
#include "points/copies.h"
#include "points/sources.h"

namespace orrery::points {

std::string parse_label(const std::string& text) {
  if (text.empty()) base::refuse("a label has no text; write CONDITION: TEXT, e.g. 'id == 5: Fe'");
  return text;
}

std::vector<scene::Label> placed_labels(const data::Table& table, const Rows& rows, const scene::PointArray& centers,
                                        const std::vector<Rule<std::string>>& rules, const Copy& first,
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
      out.push_back({applied(placement, applied(first.transform, (low + high) * 0.5)), rules[r].value});
    else
      faults.warning(fmt::format(".labels[{}]", r),
                     fmt::format("`{}` matches none of the particles that are drawn", points.labels[r]));
  }
  return out;
}

}  // namespace orrery::points
