// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "data/table.h"
#include "scene/scene.h"

/// Bonds between particles that are close. Used only within this room.
namespace orrery::points {

/// Maximum number of neighbours of a particle that are bonded to it by distance. Close packing has 12; with more than
/// three shells of neighbours, bonds show nothing.
inline constexpr std::size_t kMaxNeighbors = 64;

/// Numbers of edges of a periodic box, along a, b and c.
using Shift = std::array<std::int32_t, 3>;

/// The images of a periodic box. A box without volume, or none, has a single image.
class Lattice {
 public:
  explicit Lattice(const std::optional<data::Box>& box);

  bool is_periodic(std::size_t axis) const { return box_.periodic[axis]; }
  bool is_periodic() const { return is_periodic(0) || is_periodic(1) || is_periodic(2); }
  /// Distance between opposite faces of the box. Without a box: 1.
  double width(std::size_t axis) const { return 1 / math::length(reciprocal_[axis]); }

  /// Coordinates of a point in units of the edges.
  data::Vec3d fractional(data::Vec3d p) const;
  /// The image of the box that contains a point.
  Shift image_of(data::Vec3d p) const;
  data::Vec3d translation(const Shift& shift) const;
  /// Returns the shift of `to` to its image that is closest to `from`.
  Shift shift_to_nearest(data::Vec3d from, data::Vec3d to) const;

 private:
  void set_free_edges();
  bool set_reciprocal();

  data::Box box_;
  std::array<data::Vec3d, 3> reciprocal_;
};

/// A bond between `a` and the image of `b` in another box.
struct CrossingBond {
  std::uint32_t a = 0, b = 0;  ///< a <= b
  Shift shift = {0, 0, 0};     ///< of b; not 0

  auto operator<=>(const CrossingBond&) const = default;
};

/// Bonds between points, each listed once.
struct BondSet {
  std::vector<scene::SphereBond> pairs;
  std::vector<CrossingBond> crossing;
};

/// How close two points must be to be bonded: closer than the sum of their reaches.
struct Reach {
  std::vector<double> of_label;
  std::vector<std::uint32_t> labels;  ///< one per point; empty: all have the first label
  double smallest = 0;                ///< smallest length of a bond as a fraction of the largest
};

/// Finds the bonds of points, including those to periodic images, in parallel.
///
/// Result     ascending, for any number of threads; empty if a point has more than kMaxNeighbors bonds
/// Domain     finite points
/// Cost       O(n), see docs/decisions/0037-bonds.md; up to 100 bytes per point while it runs
std::optional<BondSet> find_bonds(const scene::PointArray& points, const Reach& reach, const Lattice& lattice);

}  // namespace orrery::points
