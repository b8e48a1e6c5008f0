// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/parallel.h"
#include "points/copies.h"
#include "points/sources.h"
#include "scene/limits.h"
#include "scene/validate.h"
#include "scene/value_text.h"

namespace orrery::points {

void keep_valid(const scene::PointsKeys& points, bool may_be_hollow, Rows& rows, scene::PointArray& centers,
                scene::NumberArray& radii, KeyFaults& faults) {
  const auto is_near = [](double x) { return std::abs(x) <= scene::kLargestLength; };
  const auto is_in_domain = [&](std::size_t i) {
    const data::Vec3d center = centers[i];
    const double radius = radii[i];
    return is_near(center.x) && is_near(center.y) && is_near(center.z) && is_near(radius) &&
           std::abs(radius) >= scene::kSmallestRadius && (radius >= 0 || may_be_hollow);
  };
  if (base::are_all(centers.size(), is_in_domain)) return;  // the common case, which is fast
  const auto is_valid = [&](std::size_t i) {
    const double radius = radii[i];
    return math::is_finite(centers[i]) && std::isfinite(radius) && (radius > 0 || (radius < 0 && may_be_hollow));
  };

  const data::Transform placement = transform_of(points.transform);
  std::size_t outside = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!is_valid(i)) continue;  // reported below
    for (const std::string& fault : scene::sphere_faults(applied(placement, centers[i]),
                                                         radii[i] * points.transform.scale, scene::Precision::kExact))
      if (++outside <= scene::kMaxReported)
        faults.error(".file", fmt::format("{}: {}", row_name(points, rows[i]), fault));
  }
  faults.error_if_any(".file", scene::rest_text(outside));

  std::vector<std::uint32_t> good;
  std::size_t bad = 0;
  for (std::uint32_t i = 0; i < rows.size(); ++i) {
    if (is_valid(i))
      good.push_back(i);
    else if (!points.skip_bad && ++bad <= scene::kMaxReported)
      faults.error(".file", fmt::format("{} has center {} and radius {}", row_name(points, rows[i]),
                                        scene::vector_text(centers[i]), scene::number_text(radii[i])));
  }
  const std::size_t count = rows.size() - good.size();
  if (bad > 0)
    faults.error(".file", fmt::format("{} of {} rows have coordinates that are not finite, or a radius that is not "
                                      "above 0; `skip_bad = true`, or --skip-bad, leaves them out",
                                      count, rows.size()));
  else if (count > 0)
    faults.warning(
        ".skip_bad",
        fmt::format("{} of {} rows were left out: their coordinates are not finite, or their radius is not above 0",
                    count, rows.size()));
  if (faults.has_errors()) return;
  std::vector<std::uint32_t> list = rows.list();
  keep(list, good);
  keep(centers, good);
  keep(radii, good);
  rows = Rows(std::move(list));
}

}  // namespace orrery::points
