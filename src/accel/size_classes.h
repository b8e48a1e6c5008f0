// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernel/forward.h"

/// Finds the spheres that are too large for the BVHs.
namespace orrery::accel {

/// Ids of all spheres except those in `without`.
///
/// Domain     `without` is ascending
std::vector<std::uint32_t> complement_of(const std::vector<std::uint32_t>& without, std::size_t count);

/// Ids, ascending, of the outliers: a few spheres that are much larger than the bounds of all smaller ones, such as a
/// ground. Duplicates are ignored.
std::vector<std::uint32_t> find_outliers(const kernel::SphereArray& spheres, std::size_t count,
                                         const std::vector<std::uint32_t>& duplicates);

/// The radius above which a static sphere is kept out of a SphereBvh, derived from the median radius of a sample.
///
/// Domain     at least one static sphere
double giant_radius(const kernel::SceneView& view);

}  // namespace orrery::accel
