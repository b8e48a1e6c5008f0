// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "math/vec3.h"
#include "scene/scene.h"

namespace orrery::compile {

/// The sun of a sky. Its disc is not part of the image.
struct Sun {
  math::Vec3d direction;            ///< unit, towards the centre of the disc
  double angular_diameter = 0.533;  ///< degrees
  math::Vec3d radiance;             ///< mean over the disc; parts below the horizon count as 0. 0 without the sun
};

/// A daylight sky: latitude-longitude image and sun.
struct Sky {
  int width = 0, height = 0;  ///< px
  std::vector<float> texels;  ///< R, G, B of rows from top to bottom
  Sun sun;
};

/// Accuracy of a sky. The defaults are measured in docs/decisions/0024-daylight-model.md.
struct SkyQuality {
  int width = 512;     ///< px, even; the height is half of it
  int refinement = 1;  ///< factor of all numbers of quadrature nodes
  double density = 1;  ///< factor of the density of the atmosphere; 0: vacuum
};

/// Computes the clear sky above a point at sea level by ray marching through a spherical atmosphere: single scattering,
/// plus the closed form of the infinite series of multiple scattering. Below the horizon there is ground that reflects
/// sun and sky diffusely.
///
/// `background`  sun_elevation, sun_azimuth, turbidity, ground_albedo, sun; `exposure` and `rotation` are not applied
/// Space         +y up; azimuth 0 is +z, 90 degrees is +x. Longitude decreases from left to right, from pi at the left
///               edge to -pi at the right edge; the poles are on the upper and lower edges
/// Units         scene-linear Rec.709, of radiance relative to the irradiance of the sun above the atmosphere, whose
///               luminance is pi: a white diffuse surface that the sun illuminates perpendicularly has luminance 1
///               above the atmosphere, and nearly 1 on the ground at noon
/// Domain        values in the ranges of the schema
/// Result        finite and not negative. Depends on IEEE arithmetic alone, and on functions that are rounded from long
///               double: the same on every machine
/// Precision     docs/decisions/0024-daylight-model.md
/// Cost          about 0.1 s
/// Reference     hillaire2020, bruneton2017
Sky bake_sky(const scene::Background& background, const SkyQuality& quality = {});

}  // namespace orrery::compile
