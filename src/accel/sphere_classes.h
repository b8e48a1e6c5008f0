// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernel/forward.h"
#include "kernel/precision.h"

/// Finds the spheres that do not belong into the BVHs: duplicates, and those that are too large.
namespace orrery::accel {

/// Ids, ascending, of spheres that coincide with an earlier one: equal centre and radius, in the number type of this
/// precision, throughout the shutter interval.
///
/// Accelerators skip them. Root exclusion is by the id of the sphere that a ray leaves, so a coincident second sphere
/// would be hit again at a distance of a few rounding errors.
///
/// Cost       none if the scene is known to have no duplicates; else see base::find_duplicates
std::vector<std::uint32_t> duplicates(const kernel::SceneView& scene, kernel::Precision precision);

/// Ids of all spheres except those in `without`.
///
/// Domain     `without` is ascending
std::vector<std::uint32_t> complement_of(const std::vector<std::uint32_t>& without, std::size_t count);

/// Ids, ascending, of the outliers: a few spheres that are much larger than the bounds of all smaller ones, such as a
/// ground. Duplicates are ignored.
std::vector<std::uint32_t> find_outliers(const kernel::SphereArray& spheres, std::size_t count,
                                         const std::vector<std::uint32_t>& duplicates);

/// The radius above which a static sphere, or the sphere around a static rod, is kept out of a SphereBvh, derived from
/// the median radius of a sample.
///
/// Domain     at least one static sphere or rod
double giant_radius(const kernel::SceneView& view);

/// The number of static rods that are within a sphere of this radius.
std::size_t short_rods(const kernel::SceneView& view, double radius);

/// Whether the spheres are so few and lie in so thin a layer that packets of rays are coherent. One primitive per
/// sphere is then faster than a SphereBvh.
///
/// Domain     `ids` is not empty
bool is_small_layer(const kernel::SphereArray& spheres, const std::vector<std::uint32_t>& ids);

}  // namespace orrery::accel
