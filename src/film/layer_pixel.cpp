// SPDX-License-Identifier: Apache-2.0
#include "film/layer_pixel.h"

#include <algorithm>
#include <cmath>

namespace orrery::film {
namespace {

using kernel::PathRecord;

bool is_good(const double (&light)[3]) {
  return std::abs(light[0]) <= kernel::kLargestSample && std::abs(light[1]) <= kernel::kLargestSample &&
         std::abs(light[2]) <= kernel::kLargestSample;
}

kernel::Int128 square(double v) {
  const double units = std::min(v * v, kLargestSquare) * (1 / kSquareUnit);
  // In two steps: a double of up to 2^96 does not fit into 64 bits.
  const double high = std::floor(units * 0x1p-48);
  return (static_cast<kernel::Int128>(high) << 48) + static_cast<std::int64_t>(units - high * 0x1p48);
}

template <class T>
void add3(kernel::Int128 (&sum)[3], const T& value, std::int64_t weight) {
  for (int k = 0; k < 3; ++k) sum[k] += kernel::to_fixed_point(static_cast<double>(value[k])) * weight;
}

void add_share(std::vector<SphereShare>& shares, std::uint32_t sphere, std::int64_t weight) {
  const auto at = std::lower_bound(shares.begin(), shares.end(), sphere,
                                   [](const SphereShare& share, std::uint32_t id) { return share.sphere < id; });
  if (at != shares.end() && at->sphere == sphere) {
    at->weight += weight;
  } else {
    shares.insert(at, {sphere, weight});
  }
}

}  // namespace

void LayerPixel::add(const LayerRequest& request, const kernel::SceneView& scene, const PathRecord& path,
                     std::int64_t path_weight) {
  weight += path_weight;
  if (is_good(path.light)) {
    lit += path_weight;
    ++paths;
    if (request.lights() || request.variance) add3(light[static_cast<int>(path.group)], path.light, path_weight);
    if (request.variance)
      for (int k = 0; k < 3; ++k) squares[k] += square(path.light[k]);
  }
  if (request.guide_albedo) add3(guide_albedo, path.guide_albedo, path_weight);
  if (request.guide_normal) add3(guide_normal, path.guide_normal, path_weight);
  if (path.sphere == kernel::kNoSphere) return;

  covered += path_weight;
  if (!request.mattes.empty()) add_share(shares, path.sphere, path_weight);
  if (request.albedo) add3(albedo, scene.materials[scene.sphere_materials[path.sphere]].albedo, path_weight);
  if (!request.normal && !request.nearest()) return;
  const kernel::Sphere& s = scene.spheres[path.sphere];
  const double center[3] = {s.x, s.y, s.z};
  double to_center = 0, from_camera[3], far = 0;
  for (int k = 0; k < 3; ++k) {
    const double away = center[k] - scene.camera.origin[k];
    from_camera[k] = away + path.offset[k];
    to_center += away * away;
    far += from_camera[k] * from_camera[k];
  }
  if (request.normal) {
    const double inward = to_center < s.radius * s.radius ? -1 / s.radius : 1 / s.radius;
    const double n[3] = {path.offset[0] * inward, path.offset[1] * inward, path.offset[2] * inward};
    add3(normal, n, path_weight);
  }
  if (!request.nearest()) return;
  const double distance = std::sqrt(far);
  if (!(distance < depth)) return;
  depth = distance;
  sphere = path.sphere;
  const double* const forward = scene.camera.forward;
  const double length = std::sqrt(forward[0] * forward[0] + forward[1] * forward[1] + forward[2] * forward[2]);
  z = (from_camera[0] * forward[0] + from_camera[1] * forward[1] + from_camera[2] * forward[2]) / length;
  for (int k = 0; k < 3; ++k) position[k] = center[k] + path.offset[k];
}

}  // namespace orrery::film
