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
namespace {

using data::Vec3d;

class Checks {
 public:
  Checks(const scene::PointsKeys& points, bool may_be_hollow, const scene::PointArray& centers,
         const scene::NumberArray& radii, KeyFaults& faults)
      : points_(points), may_be_hollow_(may_be_hollow), centers_(centers), radii_(radii), faults_(faults) {}

  /// Whether all spheres are valid and within the domain of scenes: the common case, which is fast.
  bool are_good() const {
    const auto is_inside = [](double x) { return std::abs(x) <= scene::kLargestLength; };
    return base::are_all(centers_.size(), [&](std::size_t i) {
      const Vec3d center = centers_[i];
      const double radius = std::abs(radii_[i]);
      return is_inside(center.x) && is_inside(center.y) && is_inside(center.z) && is_inside(radius) &&
             radius >= scene::kSmallestRadius && (radii_[i] >= 0 || may_be_hollow_);
    });
  }

  /// Reports spheres that are outside the domain of scenes.
  void check_domain(const Rows& rows) {
    const data::Transform placement = transform_of(points_.transform);
    std::size_t bad = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (!is_valid(i)) continue;  // reported by valid_rows()
      for (const std::string& fault : scene::sphere_faults(
               applied(placement, centers_[i]), radii_[i] * points_.transform.scale, scene::Precision::kExact))
        if (++bad <= scene::kMaxReported)
          faults_.error(".file", fmt::format("{}: {}", row_name(points_, rows[i]), fault));
    }
    faults_.error_if_any(".file", scene::rest_text(bad));
  }

  /// Returns the indices of valid rows. Reports the others.
  std::vector<std::uint32_t> valid_rows(const Rows& rows) {
    std::vector<std::uint32_t> good;
    std::size_t bad = 0;
    for (std::uint32_t i = 0; i < rows.size(); ++i) {
      if (is_valid(i)) {
        good.push_back(i);
      } else if (!points_.skip_bad && ++bad <= scene::kMaxReported) {
        faults_.error(".file", fmt::format("{} has center {} and radius {}", row_name(points_, rows[i]),
                                           scene::vector_text(centers_[i]), scene::number_text(radii_[i])));
      }
    }
    const std::size_t count = rows.size() - good.size();
    if (bad > 0)
      faults_.error(".file", fmt::format("{} of {} rows have coordinates that are not finite, or a radius that is not "
                                         "above 0; `skip_bad = true`, or --skip-bad, leaves them out",
                                         count, rows.size()));
    else if (count > 0)
      faults_.warning(
          ".skip_bad",
          fmt::format("{} of {} rows were left out: their coordinates are not finite, or their radius is not above 0",
                      count, rows.size()));
    return good;
  }

 private:
  bool is_valid(std::size_t i) const {
    const double radius = radii_[i];
    return math::is_finite(centers_[i]) && std::isfinite(radius) && (radius > 0 || (radius < 0 && may_be_hollow_));
  }

  const scene::PointsKeys& points_;
  const bool may_be_hollow_;
  const scene::PointArray& centers_;
  const scene::NumberArray& radii_;
  KeyFaults& faults_;
};

}  // namespace

void keep_valid(const scene::PointsKeys& points, bool may_be_hollow, Rows& rows, scene::PointArray& centers,
                scene::NumberArray& radii, KeyFaults& faults) {
  Checks checks(points, may_be_hollow, centers, radii, faults);
  if (checks.are_good()) return;
  checks.check_domain(rows);
  const std::vector<std::uint32_t> good = checks.valid_rows(rows);
  if (faults.has_errors()) return;
  std::vector<std::uint32_t> list = rows.list();
  keep(list, good);
  keep(centers, good);
  keep(radii, good);
  rows = Rows(std::move(list));
}

}  // namespace orrery::points
