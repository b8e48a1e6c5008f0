// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "points/copies.h"

/// The bonds of a points table. Used only within this room.
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
  std::vector<bool> are_metals = {};  ///< by label; empty: no labels are elements
};

/// Finds the bonds of points, including those to periodic images, in parallel.
///
/// Result     ascending, for any number of threads; empty if a point has more than kMaxNeighbors bonds
/// Domain     finite points
/// Cost       O(n), see docs/decisions/0037-bonds.md; up to 100 bytes per point while it runs
std::optional<BondSet> find_bonds(const scene::PointArray& points, const Reach& reach, const Lattice& lattice);

/// How the bonds of a file's particles are determined.
struct BondSource {
  bool is_file = false, is_distance = false;  ///< may be both
  std::string element;                        ///< by distance: column of elements; empty: by length
};

/// Determines the source of the bonds: that of the keys; else the file if it lists all bonds, both if it lists some, by
/// distance if it lists none or if the keys set a distance. Reports what the file lacks, and keys without effect.
BondSource bond_source(const data::FrameInfo& info, const scene::PointsBonds& bonds, KeyFaults& faults);

/// Memory that finding bonds takes, bytes per row, and bytes per bond of the file.
inline constexpr std::uint64_t kBondSearchBytes = 100, kFileBondBytes = 64;

/// Returns how close the spheres of the rows must be to be bonded. Reports elements without a covalent radius.
Reach reach_of(const data::Table& table, const Rows& rows, const BondSource& source, const scene::PointsBonds& bonds,
               KeyFaults& faults);

/// Removes the bonds between metals if other elements occur: in a salt or an oxide, cations are close, but not bonded.
void remove_metal_bonds(const Reach& reach, BondSet& bonds);

/// Returns the bonds of a file between selected rows. Those longer than half of the periodic box are to the closest
/// image of an atom.
///
/// `rows`     of the spheres, of a table with `row_count` rows
BondSet bonds_of_rows(const std::vector<data::Bond>& bonds, const Rows& rows, std::size_t row_count,
                      const scene::PointArray& centers, const Lattice& lattice);

/// Moves points by edges of the periodic box, so that those that bonds join are together, and the middle of each
/// molecule is in the box. Bonds must be found again after it.
void join_molecules(const BondSet& bonds, const Lattice& lattice, scene::PointArray& centers);

/// Adds the bonds of one set to another, without duplicates.
void merge(BondSet& bonds, BondSet more);

/// Returns the radius of the bonds before the transform: that of the keys, else 0.15 if the file has elements, else 0.3
/// times the mean radius.
double bond_radius(const data::FrameInfo& info, const scene::PointsBonds& bonds, const scene::NumberArray& radii);

/// Sets the bonds of `points`, for each copy of the spheres. Bonds to an image of the box that is not drawn become two
/// stubs. Call before make_copies(), whose order of the spheres it assumes.
///
/// `copies`   in the order of replicated(); an assembly has no bonds to other images
void copy_bonds(const BondSet& bonds, const std::vector<Copy>& copies, const Labels& chains, const Lattice& lattice,
                scene::Points& points);

/// Adds the images of the spheres on a face, an edge or a corner of a unit cell, or of a block of replicas, on all of
/// them, with the bonds between spheres. The stubs of spheres on faces are removed. Call after make_copies().
///
/// `box`      before the transform and the replication
/// `rows`     row number of each sphere, extended to the images; may be null
void complete_faces(const data::Box& box, scene::Points& points, std::vector<std::uint32_t>* rows);

}  // namespace orrery::points
