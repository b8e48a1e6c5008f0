// SPDX-License-Identifier: Apache-2.0
#include "sky/daylight.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "math/scalar.h"
#include "scene/scene.h"
#include "sky/atmosphere.h"
#include "sky/scattering.h"

namespace orrery::sky {
namespace {

using math::cosine;
using math::sine;
using math::Vec3d;

constexpr double kPi = std::numbers::pi;

/// Returns the color without negative components: mixed with the grey of the same luminance until none is left.
Vec3d inside_gamut(Vec3d c) {
  const double y = luminance(c);
  const double lowest = std::min({c.x, c.y, c.z});
  if (lowest >= 0) return c;
  if (y <= 0) return {0, 0, 0};
  const double grey = lowest / (lowest - y);
  const auto mix = [&](double v) { return std::max(v + grey * (y - v), 0.0); };
  return {mix(c.x), mix(c.y), mix(c.z)};
}

/// Light of the sun's disc on the ground, relative to the irradiance of the sun above the atmosphere. The disc is cut
/// into horizontal strips, because the transmittance changes within it near the horizon.
struct Disc {
  Spectrum radiance{};    ///< mean over the disc, times the disc's solid angle
  Spectrum irradiance{};  ///< irradiance of the ground
};

Disc disc_of(const Atmosphere& air, const ColumnTable& columns, double elevation) {
  constexpr int kStrips = 32;
  Disc out;
  double weights = 0;
  for (int i = 0; i < kStrips; ++i) {
    const double y = (2 * i + 1.0) / kStrips - 1, weight = std::sqrt(1 - y * y);
    weights += weight;
    const double up = sine(elevation + y * kSunAngularRadius);
    if (up <= 0) continue;
    const Spectrum light = air.transmittance(columns.to_space(0, up));
    for (std::size_t b = 0; b < kBands; ++b) {
      out.radiance[b] += weight * light[b];
      out.irradiance[b] += weight * light[b] * up;
    }
  }
  for (std::size_t b = 0; b < kBands; ++b) {
    out.radiance[b] /= weights;
    out.irradiance[b] /= weights;
  }
  return out;
}

/// Radiance of an elevation as a function of azimuth: everything but the phase functions is interpolated between nodes.
class SkyRow {
 public:
  /// `nodes`  intervals between the sun's azimuth and the opposite one
  explicit SkyRow(int nodes) : molecules_(nodes + 1u), aerosol_(nodes + 1u), multiple_(nodes + 1u) {
    for (int i = 0; i <= nodes; ++i) cosines_.push_back(cosine(kPi * i / nodes));
  }

  void compute(const Scattering& scattering, double elevation, int steps) {
    up_ = sine(elevation) * scattering.sun_sine();
    along_ = cosine(elevation) * scattering.sun_cosine();
    const Ray ray = scattering.ray_from_ground(sine(elevation), steps);
    for (std::size_t i = 0; i < cosines_.size(); ++i) {
      const Scattering::Light light = scattering.toward_ground(ray, up_ + along_ * cosines_[i]);
      molecules_[i] = rgb_of(light.molecules);
      aerosol_[i] = rgb_of(light.aerosol);
      multiple_[i] = rgb_of(light.multiple);
    }
  }

  /// `angle`  from the sun's azimuth, 0..pi; `angle_cosine`  its cosine
  Vec3d radiance(double angle, double angle_cosine) const {
    const auto last = cosines_.size() - 1;
    const double x = angle / kPi * static_cast<double>(last);
    const auto i = std::min(static_cast<std::size_t>(x), last - 1);
    const double f = x - static_cast<double>(i);
    const auto at = [&](const std::vector<Vec3d>& v) { return v[i] * (1 - f) + v[i + 1] * f; };
    const double toward_sun = up_ + along_ * angle_cosine;
    return at(molecules_) * molecular_phase(toward_sun) + at(aerosol_) * aerosol_phase(toward_sun) + at(multiple_);
  }

 private:
  std::vector<double> cosines_;
  std::vector<Vec3d> molecules_, aerosol_, multiple_;
  double up_ = 0, along_ = 0;
};

/// Angle between the azimuths of a column of texels and of the sun.
struct ColumnAngle {
  double angle, cosine;
};

std::vector<ColumnAngle> column_angles(int width, double sun_azimuth) {
  std::vector<ColumnAngle> out;
  for (int i = 0; i < width; ++i) {
    double angle = std::fmod(std::abs(kPi - (i + 0.5) / width * 2 * kPi - sun_azimuth), 2 * kPi);
    if (angle > kPi) angle = 2 * kPi - angle;
    out.push_back({angle, cosine(angle)});
  }
  return out;
}

void put(float* texel, Vec3d color) {
  texel[0] = static_cast<float>(color.x);
  texel[1] = static_cast<float>(color.y);
  texel[2] = static_cast<float>(color.z);
}

}  // namespace

scene::LatLongMap bake_sky(const scene::Background& background, const SkyQuality& quality) {
  const double elevation = background.sun_elevation * kPi / 180, azimuth = background.sun_azimuth * kPi / 180;
  const Atmosphere air(background.turbidity, quality.density);
  const ColumnTable columns(quality.refinement);
  const Scattering scattering(air, columns, elevation, reflectance_of(background.ground_albedo), quality.refinement);

  const int width = quality.width, height = width / 2;
  scene::LatLongMap sky(width, height);
  const std::vector<ColumnAngle> angles = column_angles(width, azimuth);
  const double texel = kPi / height;
  Vec3d irradiance;  // irradiance of the ground from the sky
  SkyRow light(24 * quality.refinement);
  for (int y = 0; y < height / 2; ++y) {
    const double up = kPi / 2 - (y + 0.5) * texel;
    light.compute(scattering, up, 40 * quality.refinement);
    const double top = sine(up + texel / 2), bottom = sine(up - texel / 2);
    const double projected = (top * top - bottom * bottom) / 2 * (2 * kPi / width);
    float* at = sky.row(y);
    for (const ColumnAngle& column : angles) {
      const Vec3d color = inside_gamut(light.radiance(column.angle, column.cosine));
      irradiance = irradiance + color * projected;
      put(at, color);
      at += 3;
    }
  }

  const Disc disc = disc_of(air, columns, elevation);
  const Vec3d ground = background.ground_albedo * (irradiance + inside_gamut(rgb_of(disc.irradiance))) / kPi;
  for (int y = height / 2; y < height; ++y)
    for (int x = 0; x < width; ++x) put(sky.row(y) + 3 * x, ground);

  const double half_sine = sine(kSunAngularRadius / 2);
  sky.sun.one_minus_cos = 2 * half_sine * half_sine;
  sky.sun.direction = {cosine(elevation) * sine(azimuth), sine(elevation), cosine(elevation) * cosine(azimuth)};
  if (background.sun) sky.sun.radiance = inside_gamut(rgb_of(disc.radiance)) / (2 * kPi * sky.sun.one_minus_cos);
  return sky;
}

}  // namespace orrery::sky
