// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kernel/sphere.h"
#include "math/vec3.h"

namespace orrery::kernel {

/// Classification of light paths by the first scattering event seen from the camera, and by whether the light reached
/// that surface straight from its source (direct) or from another surface (indirect). Light that only passes through
/// glass counts as direct.
enum class Lobe : std::uint8_t {
  kBackground,  ///< no surface: the camera sees the source itself
  kDiffuseDirect,
  kDiffuseIndirect,
  kSpecularDirect,
  kSpecularIndirect,
  kTransmissionDirect,
  kTransmissionIndirect,
  kEmission,  ///< no surface but the emitter's own: the camera sees it directly
};
inline constexpr int kLobes = 8;

/// Data of one path for all layers except the beauty and the denoiser guides. Computed only for tiles that request
/// records. For a path without a first hit, only `object` and `light` are set.
struct PathRecord {
  double light[3] = {0, 0, 0};   ///< total radiance of the path, the sum of its light events; indexed by channel
  math::Vec3d offset;            ///< first hit: from the sphere's centre, or end a of the rod, scene units
  math::Vec3d direction;         ///< direction of the camera ray that hit it, unit
  std::uint32_t object = kNone;  ///< first hit; kNone: the background
  float albedo[3] = {0, 0, 0};   ///< at the first hit; only in scenes with features.rich_materials
  double time = 0;               ///< 0..1 within the shutter
};

/// One contribution to a path's radiance: emission of the background or a light, times path throughput.
struct LightEvent {
  double value[3];          ///< emitted radiance times the path's throughput; indexed by channel
  std::uint32_t path;       ///< index of the path's record within the tile
  std::uint16_t group = 0;  ///< light group of the source; 0: the default group
  Lobe lobe = Lobe::kBackground;
};

/// The buffer for a tile's light events, in no particular order.
struct LightEvents {
  LightEvent* next = nullptr;
  LightEvent* end = nullptr;
  /// Called when a packet's events might not fit. Must leave room for kPacketSize more and keep those before `next`.
  void (*make_room)(LightEvents& events) = nullptr;
};

}  // namespace orrery::kernel
