// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "plot/range.h"
#include "plot/scene_text.h"

namespace orrery::plot {
namespace {

/// Radius of the edges of the box, and length and radius of the axes, as fractions of the radius of what is shown.
constexpr double kBoxRadius = 0.004, kAxisLength = 0.15, kAxisRadius = 0.01;

}  // namespace

void Guides::surround(const Vec3d& center, double radius) {
  corner_ = {std::min(corner_.x, center.x - radius), std::min(corner_.y, center.y - radius),
             std::min(corner_.z, center.z - radius)};
  for (const double x : {center.x, center.y, center.z}) reach_ = std::max(reach_, std::abs(x) + radius);
}

void Guides::surround(const scene::Points& points) {
  for (std::size_t i = 0; i < points.centers.size(); ++i) {
    const Vec3d center = points.centers[i];
    const double radius = std::abs(points.radii[i]);
    lowest_ = std::min(lowest_, math::dot(center, up_) - radius);
    surround(center, radius);
  }
}

void Guides::add(const Vec3d& from, const Vec3d& to, double radius, std::uint32_t material) {
  rods_.push_back({from, to, radius, {material, material}, {}, {}});
  for (const Vec3d& end : {from, to}) {
    ends_.centers.push_back(end);
    ends_.radii.push_back(radius);
    lowest_ = std::min(lowest_, math::dot(end, up_) - radius);
  }
}

void Guides::add_box(const data::Box& box, const Vec3d& counts, ViewExtent& extent) {
  const Vec3d a = box.edges[0] * counts.x, b = box.edges[1] * counts.y, c = box.edges[2] * counts.z;
  const auto corner = [&](int i) { return box.origin + a * (i & 1) + b * (i >> 1 & 1) + c * (i >> 2 & 1); };
  for (int i = 0; i < 8; ++i) {
    extent.add(corner(i), 0);
    surround(corner(i), 0);
  }
  const double radius = rounded(kBoxRadius * extent.radius());
  for (int i = 0; i < 8; ++i)
    for (const int edge : {1, 2, 4})
      if ((i & edge) == 0) add(corner(i), corner(i | edge), radius, kBoxMaterial);
}

void Guides::add_axes(double size) {
  const double length = rounded(kAxisLength * size), radius = rounded(kAxisRadius * size);
  const Vec3d origin = corner_ - Vec3d{1, 1, 1} * (length + 2 * radius);
  add(origin, origin + Vec3d{1, 0, 0} * length, radius, kXMaterial);
  add(origin, origin + Vec3d{0, 1, 0} * length, radius, kYMaterial);
  add(origin, origin + Vec3d{0, 0, 1} * length, radius, kZMaterial);
}

}  // namespace orrery::plot
