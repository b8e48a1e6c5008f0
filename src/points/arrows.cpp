// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/stop_point.h"
#include "points/copies.h"

namespace orrery::points {
namespace {

using math::Vec3d;

/// The head is a cone: length and radius of its base, in radii of the shaft.
constexpr double kHeadLength = 5.5, kHeadRadius = 2.2;
/// The head of a short arrow is smaller: at most this fraction of the arrow.
constexpr double kMaxHeadFraction = 0.7;
/// Ratio of the radii of successive spheres. They touch one cone and overlap so far that its surface looks smooth.
constexpr double kSphereRatio = 0.84;

/// Spheres that touch a cone, as distances from the point of the arrow and radii, in radii of the shaft.
struct HeadSphere {
  double from_tip, radius;
};

std::vector<HeadSphere> head() {
  std::vector<HeadSphere> out;
  double factor = 1;
  for (std::size_t i = 0; i < kHeadSpheres; ++i, factor *= kSphereRatio)
    out.push_back({kHeadLength * factor, kHeadRadius * factor});
  // The last sphere, not the apex of the cone, is at the point of the arrow.
  const double gap = out.back().from_tip - out.back().radius;
  for (HeadSphere& sphere : out) sphere.from_tip -= gap;
  return out;
}

}  // namespace

void add_arrows(scene::Points& points, std::vector<std::uint32_t>* rows, KeyFaults& faults) {
  const std::vector<HeadSphere> spheres = head();
  const scene::PointArray vectors = std::move(points.sphere_vectors);
  points.sphere_vectors.clear();
  points.arrow_count = points.arrow_spheres = 0;
  points.rms_vector = 0;
  const base::StopPoint stop;
  std::size_t finite = 0;
  double sum = 0;  // of squared lengths
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    stop.check(i);
    const Vec3d vector = vectors[i];
    const double length = math::length(vector), shaft = points.bond_radius;
    if (!std::isfinite(length)) continue;
    ++finite;
    sum += length * length;
    if (length <= 2 * shaft) continue;
    const Vec3d center = points.centers[i], direction = vector * (1 / length);
    const double size = std::min(shaft, length * kMaxHeadFraction / spheres.front().from_tip);
    points.bond_pairs.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(points.centers.size())});
    for (const HeadSphere& sphere : spheres) {
      points.centers.push_back(center + direction * (length - sphere.from_tip * size));
      points.radii.push_back(sphere.radius * size);
    }
    const auto repeat = [i](auto& values) {
      const auto value = values[i];
      for (std::size_t sphere = 0; sphere < kHeadSpheres; ++sphere) values.push_back(value);
    };
    points.each_sphere_value(repeat);
    points.each_vector(repeat);
    // Arrows of faint particles are not faint: they have the opacity of the material.
    if (!points.opacities.empty()) std::fill_n(points.opacities.rbegin(), kHeadSpheres, -1.0F);
    if (rows != nullptr) repeat(*rows);
    ++points.arrow_count;
    points.arrow_spheres += kHeadSpheres;
  }
  if (finite > 0) points.rms_vector = std::sqrt(sum / static_cast<double>(finite));
  if (finite < vectors.size())
    faults.warning(".vectors.columns", fmt::format("{} of {} vectors are not finite and have no arrow",
                                                   vectors.size() - finite, vectors.size()));
}

}  // namespace orrery::points
