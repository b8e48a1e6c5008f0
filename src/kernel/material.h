// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace orrery::kernel {

enum class MaterialKind : std::uint32_t { kLambertian, kHemisphere, kMetal, kDielectric };
enum class FresnelKind : std::uint32_t { kSchlick, kExact, kNone };

/// A material with everything that can be computed before a ray is known; which members count depends on `kind`.
struct Material {
  double albedo[3] = {1, 1, 1};  ///< scene-linear reflectance; 1 for a dielectric
  double fuzz = 0;               ///< metal: radius of the ball around the tip of the unit reflected direction
  double eta[2] = {1, 1};        ///< dielectric: index on the ray's side / index beyond, [0] met from outside, [1] inside
  double r0[2] = {0, 0};         ///< dielectric: reflectance at normal incidence, Schlick's constant, sides as in eta
  MaterialKind kind = MaterialKind::kLambertian;
  FresnelKind fresnel = FresnelKind::kSchlick;
};

}  // namespace orrery::kernel
