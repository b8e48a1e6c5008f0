// SPDX-License-Identifier: Apache-2.0
// The kernel's sampling of images in balls, one call at a time.
#pragma once

#include <cstdint>

#include "math/vec3.h"

namespace orrery::test {

/// A point, a ball of radius 1 at the origin and a light.
struct CausticPlace {
  math::Vec3d point;            ///< outside the ball or in its glass
  math::Vec3d to_light;         ///< unit, from the origin
  double inverse_distance = 0;  ///< of the light's centre; 0: a sun
  double light_sin = 0;         ///< sine of the half angle that the light subtends at the origin
  bool is_glass = true;         ///< false: a mirror
  double eta = 1.5;
  double inner = 0;  ///< radius of the void; 0: the ball is not hollow
};

struct CausticDirection {
  math::Vec3d direction;  ///< unit
  double inverse_pdf;     ///< steradians; 0: none
  std::uint32_t events;   ///< see kernel::CausticEvent
};

/// Samples a direction in double precision.
///
/// `events`   maximum number of events of a chain
CausticDirection caustic_direction(const CausticPlace& place, int events, double u, double v, double choice);
/// The same in single precision.
CausticDirection caustic_direction_in_float(const CausticPlace& place, int events, double u, double v, double choice);

}  // namespace orrery::test
