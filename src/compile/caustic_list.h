// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernel/caustics.h"
#include "kernel/forward.h"
#include "kernel/precision.h"

namespace orrery::compile {

/// Sine of the half angle that a light subtends at a ball below which `fast` would find a part of its images only.
inline constexpr double kSmallestLightInFast = 1e-3;

/// Maximum number of lights, besides the sun, from which pairs are formed: those with the greatest power.
inline constexpr std::size_t kMaxCausticLights = 256;

/// The balls and lights whose images are sampled, see kernel::Caustics.
struct CausticList {
  std::vector<kernel::CausticBall> balls;
  std::vector<kernel::CausticLight> lights;
  std::uint64_t pairs = 0;  ///< number of pairs of a sharp ball and a light in the scene, listed or not
  double strongest = 0;     ///< largest power / radius^2 of a ball

  std::size_t bytes() const noexcept { return balls.size() * sizeof(balls[0]) + lights.size() * sizeof(lights[0]); }

  /// Valid until the list is modified or destroyed.
  kernel::Caustics view() const noexcept;
};

/// Finds the pairs of sharp balls, which are perfect mirrors or clear glass, with emitters and with the sun. Motion
/// between shutter open and close is included.
///
/// A ball of glass is hollow if a sphere in it has the same centre, moves with it, is smaller and has the reciprocal
/// index: clear glass of a negative radius, or of an index below 1.
///
/// Not listed: glass of an index below 1; textured materials and emitters; invisible objects; lights that touch the
/// ball or are inside it; in `fast`, lights below kSmallestLightInFast; balls beyond the kMaxBalls of greatest power.
/// If these have less than half of the power of all, the list is empty, since it would cost more than it gains.
///
/// Domain     the view has its lights and its environment
/// Errors     base::Error(kStopped) in a base::StopScope
/// Cost       linear in the number of spheres, and in that of sharp balls times that of lights up to kMaxCausticLights;
///            memory for kMaxBalls balls with their lights
CausticList caustic_list(const kernel::SceneView& scene, kernel::Precision precision);

}  // namespace orrery::compile
