// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kernel/environment.h"

namespace orrery::kernel {

enum class TextureKind : std::uint32_t { kChecker, kNoise, kTurbulence, kMarble, kImage };

/// Number of gradient vectors of the noise; a power of two.
inline constexpr std::uint32_t kGradients = 256;

/// Octaves of turbulence, as in the book.
inline constexpr int kOctaves = 7;

/// A compiled texture. Owns nothing.
///
/// Solid textures (all but images) are functions of the point in world space with values t in 0..1, and their colour is
/// low + (high - low) t. An image is a function of the direction from the sphere's centre, and its colour is the
/// interpolated texel times `high`.
///
/// Reference  shirley2024b
struct Texture {
  TextureKind kind = TextureKind::kChecker;
  std::uint32_t seed = 0;              ///< of the noise
  double scale = 1;                    ///< checker: edge of a cell, scene units; noise: lattice cells per scene unit
  double low[3] = {0, 0, 0};           ///< checker: colour of even cells
  double high[3] = {1, 1, 1};          ///< checker: colour of odd cells
  const double* gradients = nullptr;   ///< noise: kGradients unit vectors of four doubles, the last one unused
  const Environment* image = nullptr;  ///< its texels, seen from the centre mirrored; without sun or distribution
};

/// The textures that replace constants of a material: indices into SceneView::textures.
struct MaterialTextures {
  static constexpr std::uint32_t kNone = 0xffffffffu;

  std::uint32_t albedo = kNone;
  std::uint32_t fuzz = kNone;      ///< its red channel
  std::uint32_t radiance = kNone;  ///< of an emitter, exposure included
};

}  // namespace orrery::kernel
