// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <vector>

#include "points/bonds.h"

namespace orrery::points {
namespace {

using data::Vec3d;

/// Finds points by their place.
class PlaceIndex {
 public:
  PlaceIndex(const scene::PointArray& points, double tolerance) : points_(points), tolerance_(tolerance) {
    order_.resize(points.size());
    std::iota(order_.begin(), order_.end(), 0U);
    std::sort(order_.begin(), order_.end(), [&](auto a, auto b) { return points[a].x < points[b].x; });
  }

  std::optional<std::uint32_t> at(Vec3d place) const {
    const auto before = [&](std::uint32_t i, double x) { return points_[i].x < x; };
    for (auto i = std::lower_bound(order_.begin(), order_.end(), place.x - tolerance_, before);
         i != order_.end() && points_[*i].x <= place.x + tolerance_; ++i)
      if (math::length(points_[*i] - place) <= tolerance_) return *i;
    return std::nullopt;
  }

 private:
  const scene::PointArray& points_;
  double tolerance_;
  std::vector<std::uint32_t> order_;  ///< by x
};

}  // namespace

void complete_faces(const data::Box& box, scene::Points& points, std::vector<std::uint32_t>* rows) {
  constexpr double kOnFace = 0.02;  // ångström: coordinates in files are rounded
  const data::Transform placement = transform_of(points.transform);
  const double tolerance = kOnFace * points.transform.scale;
  const double counts[] = {points.replicate.x, points.replicate.y, points.replicate.z};
  data::Box placed{applied(placement, box.origin), {}, {true, true, true}};
  for (std::size_t axis = 0; axis < 3; ++axis)
    placed.edges[axis] = applied(placement, box.origin + box.edges[axis] * counts[axis]) - placed.origin;
  const Lattice lattice(placed);

  struct Image {
    std::uint32_t of;
    Shift shift;
  };
  std::vector<Image> images;
  std::vector<bool> is_on_face(points.centers.size());
  for (std::uint32_t i = 0; i < points.centers.size(); ++i) {
    const Vec3d f = lattice.fractional(points.centers[i]);
    const double fractions[] = {f.x, f.y, f.z};
    Shift other{};  // to the opposite face
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double width = tolerance / lattice.width(axis);
      other[axis] = std::abs(fractions[axis]) < width ? 1 : std::abs(fractions[axis] - 1) < width ? -1 : 0;
    }
    is_on_face[i] = other != Shift{};
    for (int corner = 1; corner < 8; ++corner) {
      Shift shift{};
      bool is_image = true;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool is_moved = (corner >> axis & 1) != 0;
        is_image = is_image && (!is_moved || other[axis] != 0);
        if (is_moved) shift[axis] = other[axis];
      }
      if (is_image) images.push_back({i, shift});
    }
  }

  const auto first = static_cast<std::uint32_t>(points.centers.size());
  for (const Image& image : images) {
    points.centers.push_back(points.centers[image.of] + lattice.translation(image.shift));
    points.radii.push_back(points.radii[image.of]);
    if (rows != nullptr) rows->push_back((*rows)[image.of]);
  }
  const auto repeat = [&](auto& values) {
    for (const Image& image : images) values.push_back(values[image.of]);
  };
  points.each_sphere_value(repeat);
  points.each_vector(repeat);

  // The bonds of an atom, as differences to its neighbours, are those of its images.
  std::vector<std::vector<Vec3d>> bonds(first);
  const auto to_partner = [&](const scene::BondStub& stub) { return (stub.end - points.centers[stub.sphere]) * 2.0; };
  for (const scene::SphereBond& bond : points.bond_pairs) {
    const Vec3d d = points.centers[bond.b] - points.centers[bond.a];
    bonds[bond.a].push_back(d);
    bonds[bond.b].push_back(d * -1.0);
  }
  for (const scene::BondStub& stub : points.bond_stubs) bonds[stub.sphere].push_back(to_partner(stub));
  const PlaceIndex places(points.centers, tolerance);
  const auto join = [&](std::uint32_t a, Vec3d difference) {
    const std::optional<std::uint32_t> b = places.at(points.centers[a] + difference);
    if (b && *b != a) points.bond_pairs.push_back({std::min(a, *b), std::max(a, *b)});
    return b.has_value();
  };
  for (std::uint32_t i = 0; i < images.size(); ++i)
    for (const Vec3d difference : bonds[images[i].of]) join(first + i, difference);
  std::erase_if(points.bond_stubs, [&](const scene::BondStub& stub) {
    return join(stub.sphere, to_partner(stub)) || is_on_face[stub.sphere];
  });
  std::sort(points.bond_pairs.begin(), points.bond_pairs.end());
  points.bond_pairs.erase(std::unique(points.bond_pairs.begin(), points.bond_pairs.end()), points.bond_pairs.end());
}

}  // namespace orrery::points
