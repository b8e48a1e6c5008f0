// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/lat_long_map.h"
#include "scene/scene.h"

namespace orrery::sky {

/// Accuracy of a sky. The defaults are measured in docs/decisions/0024-daylight-model.md.
struct SkyQuality {
  int width = 512;     ///< px, even; the height is half of it
  int refinement = 1;  ///< multiplies the numbers of quadrature nodes
  double density = 1;  ///< multiplies the density of the atmosphere; 0: vacuum
};

/// Computes the clear sky above a point at sea level by ray marching through a spherical atmosphere: single scattering,
/// plus the closed form of the infinite series of multiple scattering. Below the horizon is ground that reflects sun
/// and sky diffusely. The sun's disc is not part of the texels; its radiance is the mean over the disc, where parts
/// below the horizon count as 0.
///
/// `background`  sun_elevation, sun_azimuth, turbidity, ground_albedo, sun; not exposure and rotation
/// Space         +y up; azimuth 0 is +z, 90 degrees is +x
/// Units         lin_rec709, whatever the working space: radiance relative to the irradiance of the sun above the
///               atmosphere, whose luminance is pi. A white diffuse surface that faces the sun has luminance 1 above
///               the atmosphere, and nearly 1 on the ground at noon
/// Domain        values in the ranges of the schema
/// Result        finite and not negative. Uses only IEEE arithmetic and functions rounded from long double, so it is
///               the same on every machine
/// Precision     docs/decisions/0024-daylight-model.md
/// Cost          0.15 s
/// Reference     hillaire2020, bruneton2017
scene::LatLongMap bake_sky(const scene::Background& background, const SkyQuality& quality = {});

}  // namespace orrery::sky
