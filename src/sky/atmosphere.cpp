// SPDX-License-Identifier: Apache-2.0
#include "sky/atmosphere.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "math/scalar.h"

namespace orrery::sky {
namespace {

using math::Vec3d;

constexpr int kFirstWavelength = 390, kBandWidth = 20;  // nm

double wavelength(int band) { return kFirstWavelength + (band + 0.5) * kBandWidth; }

// Means over 10 nm, from 390 nm on.
constexpr int kBins = 2 * kBands;
/// Spectral irradiance of the sun above the atmosphere, W / (m^2 nm). Reference  astm-g173, after bruneton2017
constexpr std::array<double, kBins> kSolarIrradiance{
    1.14716, 1.72765, 1.73054, 1.6887, 1.61253, 1.91198, 2.03474, 2.02042, 2.02212, 1.93377, 1.95809,
    1.91686, 1.8298,  1.8685,  1.8931, 1.85149, 1.8504,  1.8341,  1.8345,  1.8147,  1.78158, 1.7533,
    1.6965,  1.68194, 1.64654, 1.6048, 1.52143, 1.55622, 1.5113,  1.474,   1.4482,  1.41018};
/// Absorption cross-section of ozone at 233 K, 1e-25 m^2. Reference  serdyuchenko2014, after bruneton2017
constexpr std::array<double, kBins> kOzoneCrossSection{
    0.006636, 0.01527, 0.02763, 0.0552, 0.08451, 0.1582, 0.2316, 0.3669, 0.4924, 0.7752, 0.9016,
    1.48,     1.602,   2.139,   2.755,  3.091,   3.5,    4.266,  4.672,  4.398,  4.701,  5.019,
    4.305,    3.74,    3.215,   2.662,  2.238,   1.852,  1.473,  1.209,  0.9423, 0.7455};

// Reference  bruneton2017
constexpr double kMolecularScattering = 1.24062e-6;                                // 1/m at 1 um, sea level
constexpr double kMolecularHeight = 8000, kAerosolHeight = 1200;                   // m, scale heights
constexpr double kOzoneBottom = 10e3, kOzoneMiddle = 25e3, kOzoneTop = 40e3;       // m
constexpr double kOzoneColumn = 300 * 2.687e20;                                    // 1/m^2: 300 Dobson units
constexpr double kOzoneDensity = kOzoneColumn / ((kOzoneTop - kOzoneBottom) / 2);  // 1/m^3
constexpr double kAerosolAlbedo = 0.9;
constexpr double kAsymmetry = 0.8;
constexpr double kForward = kAsymmetry * kAsymmetry;  // Reference  joseph1976

/// Decrease of the optical depth of aerosol with wavelength. Reference  angstrom1929, preetham1999
constexpr double kAngstromExponent = 1.3;

double power(double x, double exponent) {
  return static_cast<double>(std::pow(static_cast<long double>(x), static_cast<long double>(exponent)));
}

// Limits of the amounts along rays, m: a negligible amount, and the length of the longest ray.
constexpr double kTrace = 1e-30, kLargest = 3e6;

/// A Gaussian with different inverse widths to the left and to the right of its maximum.
double lobe(double x, double maximum, double left, double right) {
  const double t = (x - maximum) * (x < maximum ? left : right);
  return math::exp_nonpositive(-t * t / 2);
}

/// Returns the colour matching functions of the CIE standard observer, 1931. Reference  wyman2013, section 2.2
Vec3d color_matching(double nm) {
  return {0.362 * lobe(nm, 442.0, 0.0624, 0.0374) + 1.056 * lobe(nm, 599.8, 0.0264, 0.0323) -
              0.065 * lobe(nm, 501.1, 0.0490, 0.0382),
          0.821 * lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * lobe(nm, 530.9, 0.0613, 0.0322),
          1.217 * lobe(nm, 437.0, 0.0845, 0.0278) + 0.681 * lobe(nm, 459.0, 0.0385, 0.0725)};
}

/// Reference  IEC 61966-2-1
Vec3d rec709_from_xyz(Vec3d c) {
  return {3.2404542 * c.x - 1.5371385 * c.y - 0.4985314 * c.z, -0.9692660 * c.x + 1.8760108 * c.y + 0.0415560 * c.z,
          0.0556434 * c.x - 0.2040259 * c.y + 1.0572252 * c.z};
}

/// Returns the RGB irradiance of the sun above the atmosphere in every band.
std::array<Vec3d, kBands> solar_rgb() {
  std::array<Vec3d, kBands> out{};
  double luminance = 0;
  for (int bin = 0; bin < kBins; ++bin) {
    const auto at = static_cast<std::size_t>(bin);
    const Vec3d xyz = kSolarIrradiance[at] * color_matching(kFirstWavelength + 10 * bin + 5);
    luminance += xyz.y;
    out[at / 2] = out[at / 2] + rec709_from_xyz(xyz);
  }
  for (Vec3d& rgb : out) rgb = rgb * (std::numbers::pi / luminance);
  return out;
}

/// Adds the amounts along a part of a ray, which starts where the ray is horizontal or ascending. Nodes are densest at
/// the start.
void add_densities(Densities& sum, double altitude, double sine, double length, int steps) {
  const double radius = kGroundRadius + altitude;
  for (int i = 0; i < steps; ++i) {
    const double u = (i + 0.5) / steps, t = length * u * u * u;
    const double change = t * (2 * radius * sine + t);  // of the squared radius
    const double here = altitude + change / (radius + std::sqrt(radius * radius + change));
    sum = sum + densities(here) * (3 * u * u * length / steps);
  }
}

/// Returns the amounts along a ray to space by quadrature.
Densities integrate(double altitude, double sine, int steps) {
  const double radius = kGroundRadius + altitude, length = distance_to_space(radius, sine);
  Densities sum;
  if (sine >= 0) {
    add_densities(sum, altitude, sine, length, steps);
    return sum;
  }
  // Forwards and backwards from the lowest point.
  const double descent = -radius * sine, lowest = std::sqrt(radius * radius - descent * descent) - kGroundRadius;
  add_densities(sum, lowest, 0, descent, steps);
  add_densities(sum, lowest, 0, length - descent, steps);
  return sum;
}

double horizon_sine(double radius) {
  return -std::sqrt(std::max((radius - kGroundRadius) * (radius + kGroundRadius), 0.0)) / radius;
}

}  // namespace

Densities densities(double altitude) {
  const double h = std::max(altitude, 0.0);
  const double rising = (h - kOzoneBottom) / (kOzoneMiddle - kOzoneBottom);
  const double falling = (kOzoneTop - h) / (kOzoneTop - kOzoneMiddle);
  return {math::exp_nonpositive(-h / kMolecularHeight), math::exp_nonpositive(-h / kAerosolHeight),
          std::max(std::min(rising, falling), 0.0)};
}

double distance_to_space(double radius, double sine) {
  constexpr double kTop = kGroundRadius + kAtmosphereThickness;
  return std::sqrt(std::max(radius * radius * (sine * sine - 1) + kTop * kTop, 0.0)) - radius * sine;
}

double molecular_phase(double cosine) { return 3 / (16 * std::numbers::pi) * (1 + cosine * cosine); }

/// Reference  cornette1992
double aerosol_phase(double cosine) {
  constexpr double g = kAsymmetry;
  const double d = 1 + g * g - 2 * g * cosine;
  return 3 / (8 * std::numbers::pi) * (1 - g * g) / (2 + g * g) * (1 + cosine * cosine) / (d * std::sqrt(d));
}

Atmosphere::Atmosphere(double turbidity, double density) {
  const auto scattering = [](double nm) { return kMolecularScattering * power(nm / 1000, -4); };
  const double haze = (turbidity - 1) * scattering(550) * kMolecularHeight / kAerosolHeight;
  for (int band = 0; band < kBands; ++band) {
    const auto b = static_cast<std::size_t>(band);
    const double nm = wavelength(band);
    molecules[b] = density * scattering(nm);
    ozone[b] = density * kOzoneDensity * 1e-25 * (kOzoneCrossSection[2 * b] + kOzoneCrossSection[2 * b + 1]) / 2;
    aerosol[b] = density * haze * power(nm / 550, -kAngstromExponent);
    aerosol_scattering[b] = kAerosolAlbedo * aerosol[b];
    scaled_aerosol[b] = aerosol[b] - kForward * aerosol_scattering[b];
    scaled_aerosol_scattering[b] = (1 - kForward) * aerosol_scattering[b];
  }
}

Spectrum Atmosphere::transmittance(Densities path, const Spectrum& aerosol_extinction) const {
  Spectrum out;
  for (std::size_t b = 0; b < kBands; ++b)
    out[b] = math::exp_nonpositive(
        -(path.molecules * molecules[b] + path.aerosol * aerosol_extinction[b] + path.ozone * ozone[b]));
  return out;
}

// Altitudes are spaced quadratically. Directions are spaced evenly in the distance to space, from straight up to the
// horizon, which makes them dense near the horizon. Reference  bruneton2017, "Transmittance", "Precomputation"
ColumnTable::ColumnTable(int refinement) : altitudes_(48 * refinement), directions_(128 * refinement) {
  table_.reserve(static_cast<std::size_t>(altitudes_) * static_cast<std::size_t>(directions_));
  for (int i = 0; i < altitudes_; ++i) {
    const double altitude = node(i), radius = kGroundRadius + altitude, shortest = kAtmosphereThickness - altitude;
    const double longest = distance_to_space(radius, horizon_sine(radius));
    for (int j = 0; j < directions_; ++j) {
      // The sine follows from the distance by the law of cosines. At the upper edge of the atmosphere, distances of
      // ascending rays are 0.
      const double d = std::max(shortest + (longest - shortest) * j / (directions_ - 1), 1.0);
      const double sine = (shortest * (2 * kGroundRadius + kAtmosphereThickness + altitude) - d * d) / (2 * radius * d);
      const Densities a = integrate(altitude, std::clamp(sine, -1.0, 1.0), 64 * refinement);
      table_.push_back({math::logarithm((a.molecules + kTrace) / kLargest),
                        math::logarithm((a.aerosol + kTrace) / kLargest), a.ozone});
    }
  }
}

double ColumnTable::node(int i) const {
  const double u = static_cast<double>(i) / (altitudes_ - 1);
  return kAtmosphereThickness * u * u;
}

Densities ColumnTable::to_space(double altitude, double sine) const {
  const double radius = kGroundRadius + altitude, shortest = kAtmosphereThickness - altitude;
  const double lowest = horizon_sine(radius), longest = distance_to_space(radius, lowest);
  const double d = distance_to_space(radius, std::max(sine, lowest));
  const double x = std::sqrt(altitude / kAtmosphereThickness) * (altitudes_ - 1);
  const double y = (d - shortest) / (longest - shortest) * (directions_ - 1);
  const int i = std::clamp(static_cast<int>(x), 0, altitudes_ - 2);
  const int j = std::clamp(static_cast<int>(y), 0, directions_ - 2);
  const double fx = (altitude - node(i)) / (node(i + 1) - node(i)), fy = y - j;
  const Densities* const at =
      &table_[static_cast<std::size_t>(i) * static_cast<std::size_t>(directions_) + static_cast<std::size_t>(j)];
  const Densities low = at[0] * (1 - fy) + at[1] * fy;
  const Densities high = at[directions_] * (1 - fy) + at[directions_ + 1] * fy;
  const Densities a = low * (1 - fx) + high * fx;
  return {kLargest * math::exp_nonpositive(a.molecules), kLargest * math::exp_nonpositive(a.aerosol), a.ozone};
}

double visible_sun(double radius, double sine) {
  const double cosine = kGroundRadius / radius;  // of the horizon's elevation
  const double x = std::clamp((sine - horizon_sine(radius)) / (cosine * kSunAngularRadius) / 2 + 0.5, 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

Vec3d rgb_of(const Spectrum& relative) {
  static const std::array<Vec3d, kBands> solar = solar_rgb();
  Vec3d sum;
  for (std::size_t b = 0; b < kBands; ++b) sum = sum + solar[b] * relative[b];
  return sum;
}

double luminance(Vec3d rgb) { return 0.2126729 * rgb.x + 0.7151522 * rgb.y + 0.0721750 * rgb.z; }

Spectrum reflectance_of(Vec3d rgb) {
  Spectrum out;
  for (int band = 0; band < kBands; ++band) {
    const double nm = wavelength(band);
    const double green_from_blue = std::clamp((nm - 480) / 30, 0.0, 1.0);
    const double red_from_green = std::clamp((nm - 570) / 30, 0.0, 1.0);
    out[static_cast<std::size_t>(band)] =
        rgb.z * (1 - green_from_blue) + rgb.y * (green_from_blue - red_from_green) + rgb.x * red_from_green;
  }
  return out;
}

}  // namespace orrery::sky
