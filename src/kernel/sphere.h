// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace orrery::kernel {

/// A sphere in the kernel's layout: four doubles, half a cache line.
///
/// The radius is positive: `compile` turns an authored negative radius into a material with its sides swapped.
struct alignas(32) Sphere {
  double x = 0, y = 0, z = 0;  ///< centre, scene units
  double radius = 1;           ///< scene units, > 0
};

/// Id that denotes no sphere, for camera rays and for rays that hit nothing.
inline constexpr std::uint32_t kNoSphere = 0xffffffffu;

}  // namespace orrery::kernel
