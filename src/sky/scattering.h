// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "sky/atmosphere.h"

namespace orrery::sky {

/// A ray through the atmosphere, to space or to the ground, in segments.
struct Ray {
  struct Segment {
    double distance;  ///< m, from the start of the ray to the segment's midpoint
    double radius;    ///< m, from the Earth's centre to the segment's midpoint
    Densities here;   ///< densities at the midpoint
    /// Fractions of the light at the segment's midpoint that are scattered within the segment and reach the start of
    /// the ray, excluding the phase function: by molecules, by aerosol, and by both without forward scattering.
    Spectrum molecules, aerosol, diffuse;
  };

  std::vector<Segment> segments;
  Spectrum transmittance;  ///< transmittance of the whole ray, for light that may also be scattered forward
};

/// Sunlight that the atmosphere scatters.
///
/// Single scattering is integrated along rays with the exact phase functions. The light of all higher orders is assumed
/// to be isotropic; its infinite series has a closed form if the light around a point is about the same as at the
/// point.
///
/// Units      all light is relative to the irradiance of the sun above the atmosphere
/// Precision  docs/decisions/0024-daylight-model.md
/// Reference  hillaire2020, section 5; nakajima1988
class Scattering {
 public:
  /// Tabulates multiple scattering.
  ///
  /// `sun_elevation`  radians, at the ground point from which the sky is seen
  /// `refinement`     multiplies the numbers of quadrature nodes
  Scattering(const Atmosphere& air, const ColumnTable& columns, double sun_elevation, const Spectrum& ground_albedo,
             int refinement);

  double sun_sine() const { return sun_sine_; }
  double sun_cosine() const { return sun_cosine_; }

  /// Returns the ray from the ground point in a direction above the horizon. `sine` is the sine of its elevation.
  Ray ray_from_ground(double sine, int steps) const;

  /// Light that reaches the ground point along a ray.
  struct Light {
    Spectrum molecules{}, aerosol{};  ///< scattered once, without phase function
    Spectrum multiple{};              ///< scattered more than once
  };
  /// Returns the light that a ray brings to the ground point.
  ///
  /// `toward_sun`  cosine between the ray and the direction to the sun
  Light toward_ground(const Ray& ray, double toward_sun) const;

 private:
  /// Returns the light of the sun at a point, 0 where it is below the horizon.
  Spectrum sunlight(double radius, double local_sine) const;
  Spectrum multiple_scattering(double radius, double local_sine) const;
  void tabulate(const Spectrum& ground_albedo);

  Atmosphere air_;
  const ColumnTable& columns_;
  double sun_sine_, sun_cosine_;
  int refinement_;

  /// Logarithm of the radiance of light that has been scattered at least once; by altitude, spaced quadratically, and
  /// by the sine of the local elevation of the sun. Twilight falls exponentially.
  std::vector<Spectrum> multiple_;
  int altitudes_, suns_;
  double lowest_sine_, highest_sine_;
};

}  // namespace orrery::sky
