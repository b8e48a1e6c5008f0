// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "points/bond_search.h"
#include "points/copies.h"

/// The bonds of a points table. Used only within this room.
namespace orrery::points {

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

/// Returns the bonds of a file between selected rows. Those longer than half of the periodic box are to the closest
/// image of an atom.
///
/// `rows`     of the spheres, of a table with `row_count` rows
BondSet bonds_of_rows(const std::vector<data::Bond>& bonds, const Rows& rows, std::size_t row_count,
                      const scene::PointArray& centers, const Lattice& lattice);

/// Adds the bonds of one set to another, without duplicates.
void merge(BondSet& bonds, BondSet more);

/// Returns the radius of the bonds before the transform: that of the keys, else 0.15 if the file has elements, else 0.3
/// times the mean radius.
double bond_radius(const data::FrameInfo& info, const scene::PointsBonds& bonds, const scene::NumberArray& radii);

/// Number of rods that copy_bonds() makes in a number of periodic images.
double copied_bond_count(const BondSet& bonds, double images, std::size_t copies);

/// Sets the bonds of `points`, for each copy of the spheres. Bonds to an image of the box that is not drawn become two
/// stubs. Call before make_copies(), whose order of the spheres it assumes.
///
/// `copies`   in the order of replicated(); an assembly has no bonds to other images
void copy_bonds(const BondSet& bonds, const std::vector<Copy>& copies, const Labels& chains, const Lattice& lattice,
                scene::Points& points);

}  // namespace orrery::points
