// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernel/forward.h"

/// Finds the objects that do not belong into the BVHs: those that are too large or too long.
namespace orrery::accel {

/// Ids, ascending, of the spheres that are neither duplicates nor outliers.
///
/// `outliers` ascending
std::vector<std::uint32_t> ordinary_spheres(const kernel::SceneView& scene, const std::vector<std::uint32_t>& outliers);

/// Ids, ascending, of the outliers: a few spheres that are much larger than the bounds of all smaller ones and of the
/// rods, such as a ground. Duplicates are ignored.
std::vector<std::uint32_t> find_outliers(const kernel::SceneView& scene);

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

/// Whether a rod belongs into a SphereBvh: it is static and no duplicate, and the sphere around it is neither larger
/// than `largest` nor nearly empty.
bool is_short(const kernel::SceneView& scene, std::size_t rod, double largest);

/// The number of rods for which is_short() holds.
std::size_t short_rods(const kernel::SceneView& scene, double largest);

/// Whether most objects are spheres that lie in a thin layer, judged by a sample of them: packets of rays are coherent
/// there.
bool is_layer(const kernel::SceneView& scene);

/// Layers of up to this many spheres are faster with one primitive per sphere than with a SphereBvh.
inline constexpr std::size_t kMaxInSmallLayer = 100'000;

}  // namespace orrery::accel
