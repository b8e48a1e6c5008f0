// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace orrery::kernel {

enum class MaterialKind : std::uint32_t { kLambertian, kHemisphere, kMetal, kDielectric, kEmitter };
enum class FresnelKind : std::uint32_t { kSchlick, kExact, kNone };

/// A compiled material: everything that does not depend on the ray. `kind` determines which members are used.
struct Material {
  double albedo[3] = {1, 1, 1};  ///< scene-linear reflectance; 1 for a dielectric
  double fuzz = 0;               ///< metal, dielectric: radius of the sphere around the tip of the unit direction
  double eta[2] = {
      1, 1};  ///< dielectric: index on the ray's side / index beyond; [0] for rays from outside, [1] from inside
  double r0[2] = {0, 0};  ///< dielectric: reflectance at normal incidence, Schlick's constant, sides as in eta
  MaterialKind kind = MaterialKind::kLambertian;
  FresnelKind fresnel = FresnelKind::kSchlick;
};

// Shading loads albedo with fuzz, and eta with r0, as four consecutive doubles.
static_assert(offsetof(Material, fuzz) == offsetof(Material, albedo) + 3 * sizeof(double));
static_assert(offsetof(Material, r0) == offsetof(Material, eta) + 2 * sizeof(double));

}  // namespace orrery::kernel
