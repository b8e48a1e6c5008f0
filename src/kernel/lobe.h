// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

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

}  // namespace orrery::kernel
