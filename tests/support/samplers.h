// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace orrery::test {

/// Sampled distribution.
enum class Shape {
  kLambertian,  ///< directions around a tilted normal, cosine-weighted
  kHemisphere,  ///< directions around a tilted normal, uniform
  kFuzzyMetal,  ///< directions around the same normal, reflected at normal incidence with fuzz kFuzz
  kDisc,        ///< points on the unit disc; z = 0
  kPixel,       ///< positions in a pixel; z = 0
};

inline constexpr double kFuzz = 0.5;

/// The normal around which directions are sampled, and two tangents; all unit length.
inline constexpr double kNormal[3] = {0.48, 0.6, -0.64};
inline constexpr double kTangent[3] = {0.78086880944303039, -0.62469504755442429, 0};
inline constexpr double kBitangent[3] = {-0.39980483043483156, -0.49975603804353943, -0.76837490849194190};

/// Draws samples first .. first + count with the kernel's samplers and random numbers, in all SIMD lanes.
///
/// Shape      x, y, z have count elements; count is a multiple of 16
void draw(Shape shape, std::uint32_t first, std::size_t count, double* x, double* y, double* z);

}  // namespace orrery::test
