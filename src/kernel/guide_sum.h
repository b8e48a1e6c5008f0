// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kernel/pixel_sum.h"

namespace orrery::kernel {

/// Sums of a pixel's denoiser guides over its paths, in fixed point like PixelSum.
struct GuideSum {
  /// Reciprocal distances of the first hits from the ray origins, 1 / scene units, in units of 2^-60; 0 for a miss.
  Int128 inverse_depth = 0;
  std::int64_t weight = 0;  ///< total weight of the paths, including those with bad samples
  /// The albedo of the first non-delta surface times the throughput before it, and the surface's unit normal facing the
  /// ray in world space, in units of kGuideUnit. A path that leaves the scene adds the background's radiance, clamped
  /// to 1, and no normal.
  std::int64_t albedo[3] = {0, 0, 0}, normal[3] = {0, 0, 0};

  GuideSum& operator+=(const GuideSum& other) noexcept {
    inverse_depth += other.inverse_depth;
    weight += other.weight;
    for (int k = 0; k < 3; ++k) {
      albedo[k] += other.albedo[k];
      normal[k] += other.normal[k];
    }
    return *this;
  }
};

/// Fixed-point unit: 32 bits hold the guides of a path, 64 bits the sums over 2^31 paths.
inline constexpr double kGuideUnit = 0x1p-30;

/// Upper bound of reciprocal distances: a camera can be arbitrarily close to a surface.
inline constexpr double kLargestInverseDepth = 0x1p28;

}  // namespace orrery::kernel
