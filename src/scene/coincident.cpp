// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/core.h>

#include "base/duplicates.h"
#include "math/scalar.h"
#include "scene/validate.h"

namespace orrery::scene {
namespace {

/// Location of a sphere in the scene.
struct Place {
  std::size_t points = 0;  ///< index of the points file, unless is_table
  std::size_t index = 0;   ///< in the [[sphere]] tables or in the points file
  bool is_table = true;
};

/// Maps sphere ids to locations.
class SphereIndex {
 public:
  explicit SphereIndex(const Scene& scene) : ends_{scene.spheres.size()} {
    for (const Points& p : scene.points) ends_.push_back(ends_.back() + p.centers.size());
  }

  std::size_t count() const { return ends_.back(); }

  Place at(std::size_t id) const {
    if (id < ends_[0]) return {0, id, true};
    const auto file = static_cast<std::size_t>(std::upper_bound(ends_.begin(), ends_.end(), id) - ends_.begin()) - 1;
    return {file, id - ends_[file], false};
  }

 private:
  std::vector<std::size_t> ends_;  ///< of the ids in the [[sphere]] tables, then in each points file
};

std::string key_of(const Place& place) {
  return place.is_table ? fmt::format("sphere[{}]", place.index) : fmt::format("points[{}].file", place.points);
}

/// A sphere in the text of a message about another one.
std::string text_of(const Scene& scene, const Place& place) {
  return place.is_table ? key_of(place) : sphere_name(scene, place.points, place.index);
}

}  // namespace

std::vector<SceneDiagnostic> warn_of_coincident(const Scene& scene, const Scene* closing) {
  for (const Points& p : scene.points)
    if (p.radii.size() != p.centers.size()) return {};  // an error of validate(); the arrays must not be indexed
  const bool is_fast = scene.render.precision == Precision::kFast;
  const auto rounded = [is_fast](auto key) {
    if (is_fast)
      for (double& x : key) x = math::in_single_precision(x);
    return key;
  };
  const SphereIndex spheres(scene);
  const auto place_of = [&](std::size_t id) {
    const Place at = spheres.at(id);
    const Vec3d c = at.is_table ? scene.spheres[at.index].center : scene.points[at.points].centers[at.index];
    const double r = at.is_table ? scene.spheres[at.index].radius : scene.points[at.points].radii[at.index];
    return rounded(std::array{c.x, c.y, c.z, std::abs(r)});
  };
  const auto path_of = [&](std::size_t id) {
    const std::array<double, 4> p = place_of(id);
    Vec3d displacement;
    double growth = 0;
    if (const Place at = spheres.at(id); at.is_table) {
      const Sphere &from = scene.spheres[id], &to = closing->spheres[id];
      displacement = to.center - from.center;
      growth = std::abs(to.radius) - std::abs(from.radius);
    } else if (const Points& points = scene.points[at.points]; !points.to_next.empty()) {
      displacement = points.to_next[at.index];
    }
    return rounded(std::array{p[0], p[1], p[2], p[3], displacement.x, displacement.y, displacement.z, growth});
  };
  const std::vector<base::Duplicate> found = closing != nullptr ? base::find_duplicates<8>(spheres.count(), path_of)
                                                                : base::find_duplicates<4>(spheres.count(), place_of);
  KeyFaults faults;
  for (std::size_t i = 0; i < std::min(found.size(), kMaxReported); ++i) {
    const Place place = spheres.at(found[i].index), first = spheres.at(found[i].first);
    faults.warning(key_of(place),
                   fmt::format("{}has exactly the same centre and radius as {}; only the first is rendered",
                               place.is_table ? "" : text_of(scene, place) + " ", text_of(scene, first)));
  }
  if (found.size() > kMaxReported)
    faults.warning(
        "", fmt::format("and {} more coincident spheres ({} in all)", found.size() - kMaxReported, found.size()));
  return faults.take();
}

}  // namespace orrery::scene
