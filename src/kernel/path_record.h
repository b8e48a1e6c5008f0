// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kernel/sphere.h"

namespace orrery::kernel {

/// How a path's light came to the camera: what the first surface did with it, and whether the light came there straight
/// (direct) or by way of another surface (indirect). Light that does no more than pass through glass comes straight.
enum class LightGroup : std::uint8_t {
  kBackground,  ///< no surface at all
  kDiffuseDirect,
  kDiffuseIndirect,
  kSpecularDirect,
  kSpecularIndirect,
  kTransmissionDirect,
  kTransmissionIndirect,
};
inline constexpr int kLightGroups = 7;

/// One path, as layers beside the beauty want to know it. Only a tile that asks for records pays for them.
struct PathRecord {
  double light[3] = {0, 0, 0};        ///< what it brought to its pixel: nothing, unless it left the scene
  double offset[3] = {0, 0, 0};       ///< first hit: from the sphere's centre to the point, scene units
  double direction[3] = {0, 0, 0};    ///< of the camera ray that hit it, unit
  float guide_albedo[3] = {0, 0, 0};  ///< of the first surface that is no sharp mirror or glass, tinted by those before
  float guide_normal[3] = {0, 0, 0};  ///< its normal, unit, against the ray; world space
  std::uint32_t sphere = kNoSphere;   ///< first hit; kNoSphere: the background
  LightGroup group = LightGroup::kBackground;
  double time = 0;  ///< 0..1 within the shutter
};

}  // namespace orrery::kernel
