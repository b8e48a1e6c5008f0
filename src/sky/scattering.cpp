// SPDX-License-Identifier: Apache-2.0
#include "sky/scattering.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "math/scalar.h"

namespace orrery::sky {
namespace {

using math::cosine;
using math::sine;

/// Positive nodes and weights of Gauss-Legendre quadrature over -1..1 with eight nodes.
constexpr std::array<double, 4> kGaussNodes{0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                            0.9602898564975363};
constexpr std::array<double, 4> kGaussWeights{0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                              0.1012285362903763};

struct Node {
  double x, weight;
};
/// Returns nodes over from..to.
std::array<Node, 8> gauss(double from, double to) {
  std::array<Node, 8> out{};
  for (std::size_t i = 0; i < 4; ++i) {
    const double middle = (from + to) / 2, half = (to - from) / 2;
    out[2 * i] = {middle - half * kGaussNodes[i], half * kGaussWeights[i]};
    out[2 * i + 1] = {middle + half * kGaussNodes[i], half * kGaussWeights[i]};
  }
  return out;
}

/// Returns the mean of e^-t for t in 0..depth.
double mean_transmittance(double depth) {
  return depth > 1e-8 ? (1 - math::exp_nonpositive(-depth)) / depth : 1 - depth / 2;
}

/// End points of the segments of a ray, for u in 0..1: segments grow with the distance from the ground, or are short at
/// both ends.
double from_ground(double u) { return u * u; }
double smoothstep(double u) { return u * u * (3 - 2 * u); }

/// Returns a ray from an altitude to a distance `length`. `sine` is the sine of its elevation.
Ray march(const Atmosphere& air, double altitude, double sine, double length, int steps, double (*end_of)(double)) {
  Ray ray;
  ray.segments.reserve(static_cast<std::size_t>(steps));
  const double start_radius = kGroundRadius + altitude;
  Densities path;
  ray.transmittance = air.scaled_transmittance(path);
  double start = 0;
  for (int i = 0; i < steps; ++i) {
    const double end = length * end_of((i + 1.0) / steps), across = end - start;
    Ray::Segment s;
    s.distance = (start + end) / 2;
    const double change = s.distance * (2 * start_radius * sine + s.distance);  // of the squared radius
    const double rise = change / (start_radius + std::sqrt(start_radius * start_radius + change));
    const double here = std::clamp(altitude + rise, 0.0, kAtmosphereThickness);
    s.radius = kGroundRadius + here;
    s.here = densities(here);
    for (std::size_t b = 0; b < kBands; ++b) {
      const double molecules = s.here.molecules * air.molecules[b];
      const double depth = (molecules + s.here.aerosol * air.scaled_aerosol[b] + s.here.ozone * air.ozone[b]) * across;
      const double reach = ray.transmittance[b] * across * mean_transmittance(depth);
      s.molecules[b] = reach * molecules;
      s.aerosol[b] = reach * s.here.aerosol * air.aerosol_scattering[b];
      s.diffuse[b] = reach * (molecules + s.here.aerosol * air.scaled_aerosol_scattering[b]);
    }
    ray.segments.push_back(s);
    path = path + s.here * across;
    ray.transmittance = air.scaled_transmittance(path);
    start = end;
  }
  return ray;
}

/// Negligible radiance, far below that of a moonless night sky.
constexpr double kDarkest = 1e-20;

}  // namespace

Scattering::Scattering(const Atmosphere& air, const ColumnTable& columns, double sun_elevation,
                       const Spectrum& ground_albedo, int refinement)
    : air_(air),
      columns_(columns),
      sun_sine_(sine(sun_elevation)),
      sun_cosine_(cosine(sun_elevation)),
      refinement_(refinement),
      altitudes_(24 * refinement),
      suns_(16 * refinement) {
  // A ray from the ground leaves the atmosphere where the local elevation of the sun differs by at most this angle.
  const double reach =
      static_cast<double>(std::acos(static_cast<long double>(kGroundRadius) / (kGroundRadius + kAtmosphereThickness)));
  const double lowest = std::max(sun_elevation - reach, -std::numbers::pi / 2),
               highest = std::min(sun_elevation + reach, std::numbers::pi / 2);
  lowest_sine_ = sine(lowest);
  highest_sine_ = sine(highest);
  tabulate(ground_albedo);
}

Ray Scattering::ray_from_ground(double ray_sine, int steps) const {
  return march(air_, 0, ray_sine, distance_to_space(kGroundRadius, ray_sine), steps, from_ground);
}

Scattering::Light Scattering::toward_ground(const Ray& ray, double toward_sun) const {
  Light out;
  for (const Ray::Segment& s : ray.segments) {
    const double local_sine = (kGroundRadius * sun_sine_ + s.distance * toward_sun) / s.radius;
    const Spectrum sun = sunlight(s.radius, local_sine);
    const Spectrum multiple = multiple_scattering(s.radius, local_sine);
    for (std::size_t b = 0; b < kBands; ++b) {
      out.molecules[b] += s.molecules[b] * sun[b];
      out.aerosol[b] += s.aerosol[b] * sun[b];
      out.multiple[b] += s.diffuse[b] * multiple[b];
    }
  }
  return out;
}

Spectrum Scattering::sunlight(double radius, double local_sine) const {
  const double visible = visible_sun(radius, local_sine);
  if (visible == 0) return {};
  Spectrum out = air_.scaled_transmittance(columns_.to_space(radius - kGroundRadius, local_sine));
  for (double& value : out) value *= visible;
  return out;
}

Spectrum Scattering::multiple_scattering(double radius, double local_sine) const {
  const double x = std::sqrt((radius - kGroundRadius) / kAtmosphereThickness) * (altitudes_ - 1);
  const double y = (local_sine - lowest_sine_) / (highest_sine_ - lowest_sine_) * (suns_ - 1);
  const int i = std::clamp(static_cast<int>(x), 0, altitudes_ - 2);
  const int j = std::clamp(static_cast<int>(y), 0, suns_ - 2);
  const double fx = x - i, fy = std::clamp(y - j, 0.0, 1.0);
  const Spectrum* const at = &multiple_[static_cast<std::size_t>(i * suns_ + j)];
  const Spectrum &a = at[0], &b = at[1], &c = at[suns_], &d = at[suns_ + 1];
  Spectrum out;
  for (std::size_t k = 0; k < kBands; ++k)
    out[k] = math::exp_nonpositive((a[k] * (1 - fy) + b[k] * fy) * (1 - fx) + (c[k] * (1 - fy) + d[k] * fy) * fx);
  return out;
}

// Reference  hillaire2020, section 5.5. `returned` is f_ms: the radiance at a point if the radiance in its surroundings
//            is 1. Light from the ground is not isotropic; it belongs to a second series, whose terms are repeated
//            reflections by the ground.
void Scattering::tabulate(const Spectrum& ground_albedo) {
  // In twilight, only air towards the sun is illuminated.
  const int azimuths = (sun_sine_ < 0 ? 4 : 2) * refinement_, steps = 24 * refinement_;
  const auto suns = static_cast<std::size_t>(suns_);
  std::vector<double> azimuth_cosines;
  for (int i = 0; i < azimuths; ++i) azimuth_cosines.push_back(cosine((i + 0.5) / azimuths * std::numbers::pi));
  std::vector<double> sun_sines, sun_cosines;
  for (int i = 0; i < suns_; ++i) {
    sun_sines.push_back(lowest_sine_ + (highest_sine_ - lowest_sine_) * i / (suns_ - 1));
    sun_cosines.push_back(std::sqrt(1 - sun_sines.back() * sun_sines.back()));
  }
  // The light above black ground, and its part per radiance of the ground.
  multiple_.assign(static_cast<std::size_t>(altitudes_) * suns, Spectrum{});
  std::vector<Spectrum> of_ground(static_cast<std::size_t>(altitudes_));
  for (int i = 0; i < altitudes_; ++i) {
    const double u = static_cast<double>(i) / (altitudes_ - 1), altitude = kAtmosphereThickness * u * u;
    const double radius = kGroundRadius + altitude;
    const double horizon = -std::sqrt(altitude * (radius + kGroundRadius)) / radius;
    Spectrum returned{};
    Spectrum* const row = &multiple_[static_cast<std::size_t>(i) * suns];
    Spectrum& ground = of_ground[static_cast<std::size_t>(i)];
    const auto add_ray = [&](double ray_sine, double part, double length) {
      const Ray ray = march(air_, altitude, ray_sine, length, steps, smoothstep);
      for (const Ray::Segment& s : ray.segments)
        for (std::size_t b = 0; b < kBands; ++b) returned[b] += part * s.diffuse[b];
      const double ray_cosine = std::sqrt(1 - ray_sine * ray_sine);
      for (std::size_t sun = 0; sun < suns; ++sun) {
        for (const double azimuth_cosine : azimuth_cosines) {
          const double toward_sun = ray_sine * sun_sines[sun] + ray_cosine * sun_cosines[sun] * azimuth_cosine;
          for (const Ray::Segment& s : ray.segments) {
            const double local_sine = (radius * sun_sines[sun] + s.distance * toward_sun) / s.radius;
            const Spectrum light = sunlight(s.radius, local_sine);
            for (std::size_t b = 0; b < kBands; ++b)
              row[sun][b] += part / azimuths / (4 * std::numbers::pi) * s.diffuse[b] * light[b];
          }
        }
      }
      return ray.transmittance;
    };
    for (const Node& node : gauss(horizon, 1)) add_ray(node.x, node.weight / 2, distance_to_space(radius, node.x));
    for (const Node& node : gauss(-1, horizon)) {
      const double below = std::max(kGroundRadius * kGroundRadius - radius * radius * (1 - node.x * node.x), 0.0);
      const Spectrum reached = add_ray(node.x, node.weight / 2, -radius * node.x - std::sqrt(below));
      for (std::size_t b = 0; b < kBands; ++b) ground[b] += node.weight / 2 * reached[b];
    }
    for (std::size_t b = 0; b < kBands; ++b) {
      ground[b] /= 1 - returned[b];
      for (std::size_t sun = 0; sun < suns; ++sun) row[sun][b] /= 1 - returned[b];
    }
  }

  // Irradiance of the ground: from the light above black ground, and from the fraction of its own light that returns.
  std::vector<Spectrum> irradiance(suns);
  Spectrum back{};
  for (const Node& node : gauss(0, 1)) {
    const Ray ray = march(air_, 0, node.x, distance_to_space(kGroundRadius, node.x), steps, from_ground);
    const double projected = 2 * std::numbers::pi * node.weight * node.x;
    for (const Ray::Segment& s : ray.segments) {
      const double x = std::sqrt((s.radius - kGroundRadius) / kAtmosphereThickness) * (altitudes_ - 1);
      const auto at = static_cast<std::size_t>(std::clamp(static_cast<int>(x), 0, altitudes_ - 2));
      const double f = x - static_cast<double>(at);
      for (std::size_t b = 0; b < kBands; ++b)
        back[b] += projected * s.diffuse[b] * (of_ground[at][b] * (1 - f) + of_ground[at + 1][b] * f);
      for (std::size_t sun = 0; sun < suns; ++sun) {
        const Spectrum light = sunlight(s.radius, sun_sines[sun]);
        const Spectrum &low = multiple_[at * suns + sun], &high = multiple_[(at + 1) * suns + sun];
        for (std::size_t b = 0; b < kBands; ++b)
          irradiance[sun][b] +=
              projected * s.diffuse[b] * (light[b] / (4 * std::numbers::pi) + low[b] * (1 - f) + high[b] * f);
      }
    }
  }
  for (std::size_t sun = 0; sun < suns; ++sun) {
    const Spectrum light = sunlight(kGroundRadius, sun_sines[sun]);
    for (std::size_t b = 0; b < kBands; ++b) {
      const double direct = light[b] * std::max(sun_sines[sun], 0.0), albedo = ground_albedo[b] / std::numbers::pi;
      const double radiance = albedo * (direct + irradiance[sun][b]) / (1 - albedo * back[b]);
      for (std::size_t i = 0; i < of_ground.size(); ++i) {
        double& value = multiple_[i * suns + sun][b];
        value = math::logarithm(std::max(value + radiance * of_ground[i][b], kDarkest));
      }
    }
  }
}

}  // namespace orrery::sky
