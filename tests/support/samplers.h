// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace orrery::test {

/// What is sampled.
enum class Shape {
  kLambertian,  ///< directions around a tilted normal, cosine-weighted
  kHemisphere,  ///< directions around a tilted normal, uniform
  kFuzzyMetal,  ///< directions around the same normal, reflected at normal incidence with the fuzz kFuzz
  kDisc,        ///< points of the unit disc; z = 0
  kPixel,       ///< places in a pixel; z = 0
};

inline constexpr double kFuzz = 0.5;

/// The normal that directions are sampled around, and two axes across it; all unit.
inline constexpr double kNormal[3] = {0.48, 0.6, -0.64};
inline constexpr double kTangent[3] = {0.78086880944303039, -0.62469504755442429, 0};
inline constexpr double kBitangent[3] = {-0.39980483043483156, -0.49975603804353943, -0.76837490849194190};

/// Samples first .. first + count by the kernel's own text and random numbers, all lanes of this processor.
///
/// Shape      x, y, z each as long as count, a multiple of 16
void draw(Shape shape, std::uint32_t first, std::size_t count, double* x, double* y, double* z);

}  // namespace orrery::test
