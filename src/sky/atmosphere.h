// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "math/vec3.h"

/// The clear atmosphere of the Earth: density profiles, optical properties, and its spectrum as RGB.
///
/// Constituents are molecules (Rayleigh scattering), aerosol (Mie scattering and absorption) and ozone (absorption).
/// Refraction, polarisation and clouds are not modelled.
///
/// Reference  bruneton2017, hillaire2020
namespace orrery::sky {

inline constexpr double kGroundRadius = 6360e3;        ///< m
inline constexpr double kAtmosphereThickness = 100e3;  ///< m
inline constexpr double kSunAngularRadius = 0.533 / 2 * 3.14159265358979323846 / 180;

/// Wavelength bands of 20 nm from 390 nm to 710 nm.
inline constexpr int kBands = 16;
using Spectrum = std::array<double, kBands>;

/// Densities of the constituents: relative at a point, or integrated along a path in metres (column densities). 1 is
/// the density of molecules and aerosol at sea level, and of ozone in the middle of its layer.
struct Densities {
  double molecules = 0, aerosol = 0, ozone = 0;

  friend constexpr Densities operator+(Densities a, Densities b) {
    return {a.molecules + b.molecules, a.aerosol + b.aerosol, a.ozone + b.ozone};
  }
  friend constexpr Densities operator*(Densities a, double s) { return {a.molecules * s, a.aerosol * s, a.ozone * s}; }
};

/// Returns the relative densities at an altitude of 0 .. kAtmosphereThickness, in metres.
Densities densities(double altitude);

/// Returns the distance to the upper edge of the atmosphere in metres, from `radius` metres from the Earth's centre.
/// `sine` is the sine of the direction's elevation.
double distance_to_space(double radius, double sine);

/// Phase functions: probability densities over the sphere, of the cosine between the directions before and after.
double molecular_phase(double cosine);
double aerosol_phase(double cosine);

/// Optical properties by band, per metre at densities of 1.
///
/// Aerosol scatters mostly forward. For multiple scattering, the fraction `kForward` of its scattering is ignored
/// (delta scaling); the rest is nearly isotropic.
///
/// Reference  joseph1976, nakajima1988
struct Atmosphere {
  /// Computes the optical properties of an atmosphere.
  ///
  /// `turbidity`  ratio of the vertical optical depth of molecules and aerosol to that of molecules alone, at 550 nm;
  ///              1: no aerosol
  /// `density`    multiplies all densities; 0: vacuum
  explicit Atmosphere(double turbidity, double density = 1);

  Spectrum molecules;  ///< scattering
  Spectrum ozone;      ///< absorption
  Spectrum aerosol;    ///< extinction
  Spectrum aerosol_scattering;
  Spectrum scaled_aerosol;  ///< extinction, without forward scattering
  Spectrum scaled_aerosol_scattering;

  /// Returns the transmittance of a path, for unscattered light and for light that may also be scattered forward.
  Spectrum transmittance(Densities path) const { return transmittance(path, aerosol); }
  Spectrum scaled_transmittance(Densities path) const { return transmittance(path, scaled_aerosol); }

 private:
  Spectrum transmittance(Densities path, const Spectrum& aerosol_extinction) const;
};

/// Column densities along rays from points of the atmosphere to space, tabulated.
class ColumnTable {
 public:
  explicit ColumnTable(int refinement = 1);

  /// Returns the amounts along a ray that does not hit the ground; a ray below the horizon is replaced by one towards
  /// the horizon.
  ///
  /// Precision  1 %; test SkyAtmosphere.TabulatedColumnsMatchQuadrature
  Densities to_space(double altitude, double sine) const;

 private:
  double node(int i) const;  ///< altitude

  int altitudes_, directions_;
  std::vector<Densities> table_;  ///< by altitude and direction; molecules and aerosol as logarithms
};

/// Returns the fraction of the sun's disc that is above the horizon of a point, 0..1. `sine` is the sine of the
/// elevation of the disc's centre.
double visible_sun(double radius, double sine);

/// Returns scene-linear Rec.709 for radiances relative to the irradiance of the sun above the atmosphere, by band. The
/// luminance of that irradiance is pi: a white diffuse surface that the sun illuminates perpendicularly above the
/// atmosphere has luminance 1. Components may be negative: spectra can be more saturated than the primaries.
math::Vec3d rgb_of(const Spectrum& relative);

/// Returns the luminance of a Rec.709 color.
double luminance(math::Vec3d rgb);

/// Returns a spectrum for the reflectance of a surface; constant for grey surfaces.
Spectrum reflectance_of(math::Vec3d rgb);

}  // namespace orrery::sky
