// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace orrery::kernel {

/// One sphere as every inner loop reads it: four doubles, half a cache line.
///
/// The radius is positive: an authored negative radius has become a material that is turned inside out (compile).
struct alignas(32) Sphere {
  double x = 0, y = 0, z = 0;  ///< centre, scene units
  double radius = 1;           ///< scene units, > 0
};

/// The id of no sphere: a ray that leaves the camera, a ray that hits nothing.
inline constexpr std::uint32_t kNoSphere = 0xffffffffu;

}  // namespace orrery::kernel
