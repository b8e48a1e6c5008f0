// SPDX-License-Identifier: Apache-2.0
#include "compile/sphere_store.h"

#include <cmath>
#include <optional>

#include "base/stop_point.h"

namespace orrery::compile {
namespace {

/// The radius that all spheres have; empty if they differ or there are none.
std::optional<double> common_radius(std::span<const scene::Points> sets) {
  std::optional<double> common;
  for (const scene::Points& points : sets) {
    if (points.radii.empty()) continue;
    const double radius = std::abs(points.radii[0]);
    if (!points.radii.is_uniform() || (common && *common != radius)) return {};
    common = radius;
  }
  return common;
}

void append_singles(const scene::NumberArray& numbers, std::vector<float>& out) {
  if (const float* const singles = numbers.singles())
    out.insert(out.end(), singles, singles + numbers.size());
  else if (!numbers.empty())
    out.insert(out.end(), numbers.size(), static_cast<float>(numbers[0]));
}

}  // namespace

void SphereStore::append(std::span<const scene::Points> sets) {
  const std::optional<double> common = common_radius(sets);
  const base::StopPoint stop;
  std::size_t count = 0;
  bool fits = true;
  for (const scene::Points& points : sets) {
    count += points.centers.size();
    fits = fits && points.centers.numbers().fits_single() && (common || points.radii.fits_single());
  }
  if (!fits) {
    plain_.reserve(plain_.size() + count);
    for (const scene::Points& points : sets)
      for (std::size_t i = 0; i < points.centers.size(); ++i) {
        stop.check(i);
        const math::Vec3d c = points.centers[i];
        plain_.push_back({c.x, c.y, c.z, std::abs(points.radii[i])});
      }
    return;
  }
  stop.check();
  radius_ = common.value_or(0);
  centers_.reserve(3 * count);
  if (!common) radii_.reserve(count);
  for (const scene::Points& points : sets) {
    append_singles(points.centers.numbers(), centers_);
    if (!common) append_singles(points.radii, radii_);
  }
  for (float& radius : radii_) radius = std::abs(radius);
}

}  // namespace orrery::compile
