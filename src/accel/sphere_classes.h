// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernel/forward.h"
#include "kernel/precision.h"
#include "kernel/rod.h"

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

/// Ids, ascending, of the outliers: a few spheres that are much larger than the bounds of all smaller ones and of the
/// rods, such as a ground. Duplicates are ignored.
std::vector<std::uint32_t> find_outliers(const kernel::SceneView& scene, const std::vector<std::uint32_t>& duplicates);

/// The radius of the sphere that encloses a sphere while the shutter is open.
double enclosing_radius(const kernel::SceneView& scene, std::size_t id);

/// Whether a sphere belongs into a SphereBvh: the sphere that encloses it while the shutter is open is neither larger
/// than `largest` nor nearly empty.
bool is_compact(const kernel::SceneView& scene, std::size_t id, double largest);

/// The radius above which the sphere that encloses a sphere or a static rod is kept out of a SphereBvh, derived from
/// the median radius of a sample.
///
/// Domain     at least one sphere or static rod
double giant_radius(const kernel::SceneView& scene);

/// Whether a rod belongs into a SphereBvh: it is static, and the sphere around it is neither larger than `largest` nor
/// nearly empty.
bool is_short(const kernel::RodArray& rods, std::size_t rod, double largest);

/// The number of rods for which is_short() holds.
std::size_t short_rods(const kernel::RodArray& rods, double largest);

/// Whether most objects are spheres that lie in a thin layer, judged by a sample of them: packets of rays are coherent
/// there.
bool is_layer(const kernel::SceneView& scene);

/// Layers of up to this many spheres are faster with one primitive per sphere than with a SphereBvh.
inline constexpr std::size_t kMaxInSmallLayer = 100'000;

}  // namespace orrery::accel
