// SPDX-License-Identifier: Apache-2.0
// Compares the daylight model with random paths through the same atmosphere, in which nothing is approximated: every
// order of scattering, with the exact phase functions and ground reflections.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <numbers>
#include <random>

#include "scene/scene.h"
#include "sky/atmosphere.h"
#include "sky/daylight.h"

namespace orrery::test {
namespace {

using math::Vec3d;
using sky::Densities;
using sky::kBands;
using sky::kGroundRadius;

constexpr double kPi = std::numbers::pi;

/// Paths per direction. ORRERY_SKY_PATHS=40000 gives the table of decision record 24.
int path_count() {
  const char* const text = std::getenv("ORRERY_SKY_PATHS");
  return text != nullptr ? std::atoi(text) : 1000;
}

/// Traces paths from the ground against the light. Each has one wavelength, chosen in proportion to the luminance of
/// sunlight, so that estimates are luminances. Scattering is sampled, the sun is connected at every vertex.
class SkyPaths {
 public:
  SkyPaths(double turbidity, double albedo, Vec3d sun, std::uint64_t seed)
      : air_(turbidity), albedo_(albedo), sun_(sun), random_(seed) {
    double sum = 0;
    for (std::size_t b = 0; b < kBands; ++b) {
      sky::Spectrum one{};
      one[b] = 1;
      up_to_[b] = sum += sky::luminance(sky::rgb_of(one));
    }
  }

  double luminance(Vec3d direction) {
    band_ = static_cast<std::size_t>(std::upper_bound(up_to_.begin(), up_to_.end() - 1, unit() * up_to_.back()) -
                                     up_to_.begin());
    Vec3d origin{0, kGroundRadius, 0};
    double light = 0, weight = 1;
    for (;;) {
      const Event event = next(origin, direction);
      const Vec3d up = math::normalized(event.position);
      if (event.kind == Event::kLost) return light * up_to_.back();
      if (event.kind == Event::kGround) {
        origin = up * kGroundRadius;
        weight *= albedo_;
        light += weight / kPi * std::max(math::dot(up, sun_), 0.0) * sunlight(origin);
        direction = turned(up, std::sqrt(unit()));
        continue;
      }
      origin = event.position;
      const bool is_aerosol = event.kind == Event::kAerosol;
      if (is_aerosol) weight *= air_.aerosol_scattering[band_] / air_.aerosol[band_];
      const double toward_sun = math::dot(direction, sun_);
      light +=
          weight * (is_aerosol ? sky::aerosol_phase(toward_sun) : sky::molecular_phase(toward_sun)) * sunlight(origin);
      direction = turned(direction, is_aerosol ? aerosol_cosine() : molecular_cosine());
    }
  }

 private:
  struct Event {
    enum Kind { kLost, kGround, kMolecules, kAerosol } kind;
    Vec3d position;
  };

  double unit() { return static_cast<double>(random_() >> 11) * 0x1p-53; }

  double extinction(Densities a) const {
    return a.molecules * air_.molecules[band_] + a.aerosol * air_.aerosol[band_] + a.ozone * air_.ozone[band_];
  }

  /// Delta tracking. The upper bound of the extinction is local, because densities fall exponentially.
  Event next(Vec3d origin, Vec3d direction) {
    constexpr double kStep = 2000;
    const double radius = std::max(math::length(origin), kGroundRadius);
    const double sine = math::dot(origin, direction) / radius;
    const double closest = radius * radius * (1 - sine * sine);
    const bool hits_ground = sine < 0 && closest < kGroundRadius * kGroundRadius;
    const double length = hits_ground ? -radius * sine - std::sqrt(kGroundRadius * kGroundRadius - closest)
                                      : sky::distance_to_space(radius, sine);
    const auto altitude = [&](double t) {
      return std::max(std::sqrt(radius * radius + t * (2 * radius * sine + t)) - kGroundRadius, 0.0);
    };
    for (double start = 0; start < length; start += kStep) {
      const double end = std::min(start + kStep, length);
      const double lowest = altitude(std::clamp(-radius * sine, start, end));
      Densities most = sky::densities(lowest);
      most.ozone = 1;
      const double bound = extinction(most);
      for (double t = start - std::log(1 - unit()) / bound; t < end; t -= std::log(1 - unit()) / bound) {
        const Densities here = sky::densities(altitude(t));
        const double molecules = here.molecules * air_.molecules[band_], choice = unit() * bound;
        if (choice >= extinction(here)) continue;
        const Vec3d position = origin + direction * t;
        if (choice < molecules) return {Event::kMolecules, position};
        if (choice < molecules + here.aerosol * air_.aerosol[band_]) return {Event::kAerosol, position};
        return {Event::kLost, position};
      }
    }
    return {hits_ground ? Event::kGround : Event::kLost, origin + direction * length};
  }

  /// Transmittance to the sun, by quadrature from the lowest point of the ray.
  double sunlight(Vec3d origin) const {
    const double radius = std::max(math::length(origin), kGroundRadius), sine = math::dot(origin, sun_) / radius;
    if (sine < 0 && radius * radius * (1 - sine * sine) < kGroundRadius * kGroundRadius) return 0;
    const double lowest = std::max(-radius * sine, 0.0), length = sky::distance_to_space(radius, sine);
    Densities sum;
    const auto add = [&](double to) {
      constexpr int kSteps = 60;
      for (int i = 0; i < kSteps; ++i) {
        const double u = (i + 0.5) / kSteps, t = lowest + (to - lowest) * u * u * u;
        sum = sum + sky::densities(math::length(origin + sun_ * t) - kGroundRadius) *
                        (std::abs(to - lowest) * 3 * u * u / kSteps);
      }
    };
    add(length);
    if (lowest > 0) add(0);
    return std::exp(-extinction(sum));
  }

  double molecular_cosine() {
    for (;;) {
      const double c = 2 * unit() - 1;
      if (2 * unit() < 1 + c * c) return c;
    }
  }
  /// Cornette and Shanks's function is the one of Henyey and Greenstein times 1 + cos^2.
  double aerosol_cosine() {
    constexpr double g = 0.8;
    for (;;) {
      const double f = (1 - g * g) / (1 - g + 2 * g * unit()), c = (1 + g * g - f * f) / (2 * g);
      if (2 * unit() < 1 + c * c) return c;
    }
  }

  Vec3d turned(Vec3d axis, double cosine) {
    const Vec3d other = std::abs(axis.x) > 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
    const Vec3d u = math::normalized(math::cross(other, axis)), v = math::cross(axis, u);
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine)), angle = 2 * kPi * unit();
    return math::normalized(u * (sine * std::cos(angle)) + v * (sine * std::sin(angle)) + axis * cosine);
  }

  sky::Atmosphere air_;
  double albedo_;
  Vec3d sun_;
  std::size_t band_ = 0;
  std::array<double, kBands> up_to_{};
  std::mt19937_64 random_;
};

struct Case {
  double turbidity, albedo;
  double expected;  ///< relative error of the model, root mean square over directions
};

TEST(StatisticalDaylight, MultipleScatteringMatchesRandomPaths) {
  // Elevation, and azimuth relative to the sun.
  constexpr double kDirections[][2] = {{90, 0}, {45, 0}, {45, 90}, {45, 180}, {10, 60}, {10, 180}, {2, 90}};
  std::uint64_t seed = 0;
  std::printf("error of the luminance, percent (standard error of the reference)\n");
  std::printf("turb. alb.  sun    zenith    45/0   45/90  45/180   10/60  10/180    2/90\n");
  for (const Case& c : {Case{1, 0.2, 0.02}, Case{1, 0.8, 0.02}, Case{3, 0.2, 0.09}, Case{6, 0.2, 0.15}}) {
    double weighted = 0, weights = 0;
    // Without aerosol, the model is more accurate than the reference.
    const int paths = path_count() * (c.turbidity == 1 ? 3 : 1);
    for (const double sun : {60.0, 30.0, 5.0}) {
      scene::Background background;
      background.sun_elevation = sun;
      background.turbidity = c.turbidity;
      background.ground_albedo = {c.albedo, c.albedo, c.albedo};
      const scene::LatLongMap sky = sky::bake_sky(background, {256});
      std::printf("%4.0f %5.1f %5.0f   ", c.turbidity, c.albedo, sun);
      double relative_squares = 0;  // errors, as parts of what model and reference are expected to have
      for (const auto& at : kDirections) {
        const int y = std::min(static_cast<int>((90 - at[0]) / 180 * sky.height()), sky.height() / 2 - 1);
        const int x = std::min(static_cast<int>((180 - at[1]) / 360 * sky.width()), sky.width() - 1);
        const double elevation = kPi / 2 - (y + 0.5) / sky.height() * kPi;
        const double azimuth = kPi - (x + 0.5) / sky.width() * 2 * kPi;
        const Vec3d direction{std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                              std::cos(elevation) * std::cos(azimuth)};
        SkyPaths reference(c.turbidity, c.albedo, sky.sun.direction, ++seed);
        double sum = 0, squares = 0;
        for (int i = 0; i < paths; ++i) {
          const double light = reference.luminance(direction);
          sum += light;
          squares += light * light;
        }
        const double mean = sum / paths, error = std::sqrt((squares / paths - mean * mean) / paths) / mean;
        const float* const texel = sky.row(y) + 3 * x;
        const double found = sky::luminance({texel[0], texel[1], texel[2]}) / mean - 1;
        std::printf(" %+3.0f (%.1f)", 100 * found, 100 * error);
        EXPECT_LT(std::abs(found), 3 * c.expected + 4 * error) << c.turbidity << " " << sun << " " << at[0];
        weighted += found / (error * error);
        weights += 1 / (error * error);
        relative_squares += found * found / (c.expected * c.expected + error * error) / std::size(kDirections);
      }
      std::printf("\n");
      EXPECT_LT(relative_squares, 3) << c.turbidity << " " << sun;
    }
    EXPECT_LT(std::abs(weighted / weights), c.expected + 2 / std::sqrt(weights)) << c.turbidity << " " << c.albedo;
  }
}

}  // namespace
}  // namespace orrery::test
