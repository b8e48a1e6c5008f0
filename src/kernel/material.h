// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernel/sphere.h"

namespace orrery::kernel {

/// Kinds of materials, in the order of the alternatives of scene::MaterialModel.
enum class MaterialKind : std::uint32_t { kLambertian, kHemisphere, kMetal, kDielectric, kEmitter, kPlastic };

/// What a kind of material does to light, besides the directions and densities in scatter-inl.h.
struct MaterialTraits {
  const char* name;
  bool absorbs = false;     ///< ends paths
  bool is_diffuse = false;  ///< has a diffuse lobe, at which light by way of balls is sampled
  bool is_specular =
      false;               ///< scatters around the mirror or the refracted direction, up to an angle of twice the fuzz
  bool transmits = false;  ///< some directions pass through the surface
  bool is_delta = false;   ///< only BSDF sampling finds its light
  bool is_sharp_delta = false;  ///< the same if fuzz is 0
  bool is_rich = false;         ///< needs Features::rich_materials
};

/// The table of all materials: a row for each MaterialKind.
inline constexpr MaterialTraits kMaterialTraits[] = {
    {.name = "lambertian", .is_diffuse = true},
    {.name = "hemisphere", .is_diffuse = true},
    {.name = "metal", .is_specular = true, .is_sharp_delta = true},
    {.name = "dielectric", .is_specular = true, .transmits = true, .is_delta = true},
    {.name = "emitter", .absorbs = true},
    {.name = "plastic", .is_diffuse = true, .is_rich = true}};

constexpr const MaterialTraits& traits_of(MaterialKind kind) { return kMaterialTraits[static_cast<std::size_t>(kind)]; }

enum class FresnelKind : std::uint32_t { kSchlick, kExact, kZero };

/// A compiled material: everything that does not depend on the ray. `kind` determines which members are used.
struct Material {
  double albedo[3] = {1, 1, 1};  ///< scene-linear reflectance; 1 for a dielectric; of plastic's base
  /// Metal, dielectric: radius of the sphere around the tip of the unit direction. Plastic: see rim_of_coat.
  double fuzz = 0;
  double eta[2] = {
      1, 1};  ///< dielectric: index on the ray's side / index beyond; [0] for rays from outside, [1] from inside
  double r0[2] = {0, 0};  ///< dielectric, plastic: reflectance at normal incidence, Schlick's constant, sides as in eta
  MaterialKind kind = MaterialKind::kLambertian;
  FresnelKind fresnel = FresnelKind::kSchlick;
};

// Shading loads albedo with fuzz, and eta with r0, as four consecutive doubles.
static_assert(offsetof(Material, fuzz) == offsetof(Material, albedo) + 3 * sizeof(double));
static_assert(offsetof(Material, r0) == offsetof(Material, eta) + 2 * sizeof(double));

enum class TextureKind : std::uint32_t { kChecker, kNoise, kTurbulence, kMarble, kImage };

/// Number of gradient vectors of the noise; a power of two.
inline constexpr std::uint32_t kGradients = 256;

/// Octaves of turbulence, as in the book.
inline constexpr int kOctaves = 7;

/// Texels of a latitude-longitude image at one resolution, in the layout of Environment.
struct TextureLevel {
  const float* texels = nullptr;  ///< R, G, B; rows from the top; one more float at the end can be read
  std::uint32_t width = 0;        ///< texels
  std::uint32_t height = 0;       ///< texels
};

/// Non-owning view of an image texture for the kernel.
struct TextureImage {
  static constexpr std::size_t kMaxLevels = 13;

  TextureLevel
      levels[kMaxLevels];  ///< the mip map: the image, then each level about half as wide and high as the one before
  std::uint32_t level_count = 0;
  double turn = 0;  ///< rotation about +y, turns, 0..1
};

/// Non-owning view of a compiled texture.
///
/// Solid textures (all but images) are functions of the point in world space with values t in 0..1, and their colour is
/// low + (high - low) t. An image is a function of the direction from the sphere's centre, and its colour is the
/// interpolated texel times `high`.
///
/// Reference  shirley2024b
struct Texture {
  TextureKind kind = TextureKind::kChecker;
  std::uint32_t seed = 0;               ///< seed of the noise
  double scale = 1;                     ///< checker: edge of a cell, scene units; noise: lattice cells per scene unit
  double low[3] = {0, 0, 0};            ///< checker: colour of even cells
  double high[3] = {1, 1, 1};           ///< checker: colour of odd cells
  const double* gradients = nullptr;    ///< noise: kGradients unit vectors of four doubles, the last one unused
  const TextureImage* image = nullptr;  ///< appears mirrored from the sphere's centre
};

/// The textures that replace constants of a material: indices into SceneView::textures.
struct MaterialTextures {
  std::uint32_t albedo = kNone;
  std::uint32_t fuzz = kNone;      ///< texture whose red channel is the fuzz
  std::uint32_t radiance = kNone;  ///< texture of an emitter's radiance, including exposure
};

}  // namespace orrery::kernel
