// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/forward.h"

/// The arrows of a points table. Used only within this room.
namespace orrery::points {

class KeyFaults;

/// Spheres of the head of an arrow.
inline constexpr std::size_t kHeadSpheres = 12;

/// Adds an arrow at each sphere of `points`, along its vector: a bond as the shaft, and spheres of falling radius as
/// the head, after all other spheres. They have the colour, material and opacity of the sphere. Consumes
/// `points.sphere_vectors`, and sets `points.arrow_count` and `points.rms_vector`.
///
/// Vectors that are not finite, and those no longer than the shaft is thick, have no arrow; the former are reported.
///
/// Units      scene units: after transform.scale
/// `rows`     row number of each sphere, extended to the spheres of the heads; may be null
/// Domain     one vector per sphere; `points.bond_radius` is that of the shafts
void add_arrows(scene::Points& points, std::vector<std::uint32_t>* rows, KeyFaults& faults);

}  // namespace orrery::points
