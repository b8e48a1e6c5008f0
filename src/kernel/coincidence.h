// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "kernel/precision.h"

namespace orrery::kernel {

struct SceneView;

/// True if the scene is known to have no coincident spheres in the number type of this precision.
bool is_distinct(const SceneView& scene, Precision precision) noexcept;

/// Centre and radius of a sphere and, if N is 8, their change until the shutter closes, in the number type of this
/// precision. Spheres coincide if all of these numbers are equal.
///
/// Domain     N is 4 or 8, and 8 if a sphere of the scene moves
template <std::size_t N>
std::array<double, N> coincidence_key(const SceneView& scene, std::size_t id, Precision precision) noexcept;

}  // namespace orrery::kernel
