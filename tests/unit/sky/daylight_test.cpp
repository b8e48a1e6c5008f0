// SPDX-License-Identifier: Apache-2.0
#include "sky/daylight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "scene/scene.h"
#include "sky/atmosphere.h"

namespace orrery::sky {
namespace {

using math::Vec3d;

constexpr double kPi = std::numbers::pi;

scene::Background at(double elevation, double turbidity = 3, double azimuth = 0, double albedo = 0.2) {
  scene::Background b;
  b.type = scene::BackgroundType::kSky;
  b.sun_elevation = elevation;
  b.sun_azimuth = azimuth;
  b.turbidity = turbidity;
  b.ground_albedo = {albedo, albedo, albedo};
  return b;
}

using Sky = scene::LatLongMap;

/// A small image, for speed.
Sky small_sky(const scene::Background& background) { return bake_sky(background, {64}); }

std::vector<float> values(const Sky& sky) {
  return {sky.row(0), sky.row(0) + 3 * static_cast<std::size_t>(sky.width()) * static_cast<std::size_t>(sky.height())};
}

Vec3d texel(const Sky& sky, int x, int y) {
  const float* const p = sky.row(y) + 3 * x;
  return {p[0], p[1], p[2]};
}

/// Elevation and azimuth in degrees.
Vec3d radiance(const Sky& sky, double elevation, double azimuth) {
  const int y = std::clamp(static_cast<int>((90 - elevation) / 180 * sky.height()), 0, sky.height() - 1);
  const int x = std::clamp(static_cast<int>((180 - azimuth) / 360 * sky.width()), 0, sky.width() - 1);
  return texel(sky, x, y);
}

/// Irradiance of the ground by the sky.
Vec3d irradiance(const Sky& sky) {
  Vec3d sum;
  for (int y = 0; y < sky.height() / 2; ++y) {
    const double top = std::sin(kPi / 2 - y * kPi / sky.height()),
                 bottom = std::sin(kPi / 2 - (y + 1) * kPi / sky.height());
    for (int x = 0; x < sky.width(); ++x)
      sum = sum + texel(sky, x, y) * ((top * top - bottom * bottom) * kPi / sky.width());
  }
  return sum;
}

/// Irradiance of a surface perpendicular to the sun.
Vec3d direct(const Sky& sky) { return sky.sun.radiance * (2 * kPi * sky.sun.one_minus_cos); }

// The luminance of the sun above the atmosphere is pi by definition. It is a little warmer than the white point.
TEST(SkyDaylight, WithoutAtmosphereTheSkyIsBlackAndTheSunUnattenuated) {
  const Sky sky = bake_sky(at(30), {64, 1, 0});
  EXPECT_NEAR(sky.sun.one_minus_cos, 1 - std::cos(0.533 / 2 * kPi / 180), 1e-12);
  for (int y = 0; y < sky.height() / 2; ++y)
    for (int x = 0; x < sky.width(); ++x) EXPECT_EQ(texel(sky, x, y), Vec3d());
  EXPECT_NEAR(luminance(direct(sky)), kPi, 1e-5);
  EXPECT_GT(direct(sky).x, direct(sky).y);
  EXPECT_GT(direct(sky).y, direct(sky).z);
  EXPECT_NEAR(luminance(texel(sky, 0, sky.height() - 1)), 0.2 * 0.5, 1e-5);  // albedo * sin(elevation)
}

TEST(SkyDaylight, TheSunIsWhereElevationAndAzimuthSay) {
  const auto direction = [](double elevation, double azimuth) {
    return bake_sky(at(elevation, 3, azimuth), {2, 1, 0}).sun.direction;
  };
  const auto expect_near = [](Vec3d a, Vec3d b) { EXPECT_LT(math::length(a - b), 1e-15); };
  expect_near(direction(0, -90), {-1, 0, 0});
  expect_near(direction(30, 90), {std::sqrt(0.75), 0.5, 0});
  expect_near(direction(-45, 180), {0, -std::sqrt(0.5), -std::sqrt(0.5)});
}

// Longitude decreases from pi at the left edge; the brightest texel is the one around the sun.
TEST(SkyDaylight, TheSkyIsBrightestAroundTheSun) {
  for (const double azimuth : {-135.0, 80.0, 190.0}) {
    const Sky sky = small_sky(at(40, 3, azimuth));
    const std::vector<float> all = values(sky);
    const auto pixel = static_cast<int>((std::max_element(all.begin(), all.end()) - all.begin()) / 3);
    const double longitude = kPi - (pixel % sky.width() + 0.5) / sky.width() * 2 * kPi;
    const double latitude = kPi / 2 - (pixel / sky.width() + 0.5) / sky.height() * kPi;
    const Vec3d direction{std::cos(latitude) * std::sin(longitude), std::sin(latitude),
                          std::cos(latitude) * std::cos(longitude)};
    EXPECT_GT(math::dot(direction, sky.sun.direction), std::cos(6 * kPi / 180)) << azimuth;
  }
}

TEST(SkyDaylight, IsSymmetricAboutTheAzimuthOfTheSun) {
  const Sky sky = small_sky(at(20));
  for (int y = 0; y < sky.height(); ++y)
    for (int x = 0; x < sky.width() / 2; ++x) ASSERT_EQ(texel(sky, x, y), texel(sky, sky.width() - 1 - x, y));
}

TEST(SkyDaylight, AzimuthRotatesTheImage) {
  const Sky a = small_sky(at(20, 3, 0)), b = small_sky(at(20, 3, 90));
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) {
      const Vec3d difference = texel(a, x, y) - texel(b, (x + a.width() - a.width() / 4) % a.width(), y);
      ASSERT_LT(math::length(difference), 1e-6 * math::length(texel(a, x, y)));
    }
  }
}

/// Integrates single scattering along a ray with constant steps and exact columns, for a thin atmosphere, in which
/// there is no other scattering. The elevation of the ray is 30 degrees, towards the sun or away from it.
Vec3d thin_radiance(const Atmosphere& air, double sun_elevation, double azimuth) {
  const double ray_sine = 0.5, ray_cosine = std::sqrt(0.75);
  const double sun_sine = std::sin(sun_elevation * kPi / 180), sun_cosine = std::cos(sun_elevation * kPi / 180);
  const double toward_sun = ray_sine * sun_sine + ray_cosine * sun_cosine * std::cos(azimuth * kPi / 180);
  const double length = distance_to_space(kGroundRadius, ray_sine);
  constexpr int kSteps = 4000;
  Densities sum;
  for (int i = 0; i < kSteps; ++i) {
    const double t = length * (i + 0.5) / kSteps;
    const double radius = std::sqrt(kGroundRadius * kGroundRadius + t * t + 2 * kGroundRadius * t * ray_sine);
    sum = sum + densities(radius - kGroundRadius) * (length / kSteps);
  }
  Spectrum out;
  for (std::size_t b = 0; b < kBands; ++b)
    out[b] = sum.molecules * air.molecules[b] * molecular_phase(toward_sun) +
             sum.aerosol * air.aerosol_scattering[b] * aerosol_phase(toward_sun);
  return rgb_of(out);
}

TEST(SkyDaylight, AThinAtmosphereScattersOnce) {
  constexpr double kDensity = 1e-5;
  for (const double sun : {60.0, 10.0}) {
    for (const double azimuth : {10.0, 170.0}) {
      // One row of texels is at 30 degrees.
      const Sky sky = bake_sky(at(sun, 3, 0, 0), {540, 1, kDensity});
      const Vec3d expected = thin_radiance(Atmosphere(3, kDensity), sun, azimuth);
      const Vec3d found = radiance(sky, 29.9, azimuth), above = radiance(sky, 30.1, azimuth);
      for (const auto channel : {&Vec3d::x, &Vec3d::y, &Vec3d::z}) {
        EXPECT_NEAR((found.*channel + above.*channel) / 2 / (expected.*channel), 1, 0.01) << sun << " " << azimuth;
      }
    }
  }
}

TEST(SkyDaylight, TheGroundReceivesNoMoreThanTheSunEmits) {
  for (const double elevation : {90.0, 10.0}) {
    for (const double turbidity : {1.0, 10.0}) {
      for (const double albedo : {0.0, 1.0}) {
        const Sky sky = small_sky(at(elevation, turbidity, 0, albedo));
        const double height = std::sin(elevation * kPi / 180);
        const double absorbed = (1 - albedo) * luminance(direct(sky) * height + irradiance(sky));
        EXPECT_LE(absorbed, kPi * height);
        if (albedo == 0) {
          EXPECT_GT(absorbed, 0.2 * kPi * height) << elevation << " " << turbidity;
        }
      }
    }
  }
}

TEST(SkyDaylight, TheGroundReflectsSunAndSky) {
  const Sky sky = small_sky(at(30, 3, 0, 0.4));
  const Vec3d expected = (irradiance(sky) + direct(sky) * 0.5) * (0.4 / kPi);
  for (const double azimuth : {0.0, 120.0}) {
    const Vec3d ground = radiance(sky, -30, azimuth);
    EXPECT_LT(math::length(ground - expected), 2e-3 * math::length(expected));
  }
}

TEST(SkyDaylight, NoonIsBlueAndSunsetRed) {
  const Sky noon = small_sky(at(60, 2)), sunset = small_sky(at(1, 2));
  EXPECT_GT(radiance(noon, 80, 180).z, 1.5 * radiance(noon, 80, 180).x);
  const auto redness = [](Vec3d c) { return c.x / c.z; };
  EXPECT_GT(redness(direct(sunset)), 10 * redness(direct(noon)));
  EXPECT_GT(redness(radiance(sunset, 3, 0)), 3 * redness(radiance(noon, 3, 0)));
}

TEST(SkyDaylight, HazeBrightensAndWhitensTheSky) {
  const Sky pure = small_sky(at(40, 1)), hazy = small_sky(at(40, 6));
  EXPECT_GT(luminance(irradiance(hazy)), 2 * luminance(irradiance(pure)));
  EXPECT_LT(luminance(direct(hazy)), luminance(direct(pure)));
  const auto blueness = [](Vec3d c) { return c.z / c.x; };
  EXPECT_GT(blueness(radiance(pure, 80, 180)), 2 * blueness(radiance(hazy, 80, 180)));
}

TEST(SkyDaylight, TwilightIsDarkAndNightFinite) {
  double brighter = luminance(irradiance(small_sky(at(3))));
  for (const double elevation : {0.0, -6.0, -12.0, -18.0}) {
    const Sky sky = small_sky(at(elevation));
    const double light = luminance(irradiance(sky));
    EXPECT_GT(light, 0);
    EXPECT_LT(light, brighter / 2);
    brighter = light;
    if (elevation < 0) {
      EXPECT_EQ(sky.sun.radiance, Vec3d());
    }
  }
  for (const double elevation : {-30.0, -90.0}) {
    for (const float value : values(small_sky(at(elevation)))) {
      ASSERT_TRUE(std::isfinite(value));
      ASSERT_GE(value, 0);
      ASSERT_LT(value, 1e-8F);
    }
  }
}

TEST(SkyDaylight, TheDiscSetsGradually) {
  double previous = luminance(bake_sky(at(0.4, 1), {2}).sun.radiance);
  for (const double elevation : {0.2, 0.0, -0.2}) {
    const double now = luminance(bake_sky(at(elevation, 1), {2}).sun.radiance);
    EXPECT_LT(now, previous);
    EXPECT_GT(now, 0);
    previous = now;
  }
  EXPECT_EQ(bake_sky(at(-0.27, 1), {2}).sun.radiance, Vec3d());
}

TEST(SkyDaylight, WithoutTheSunTheSkyIsTheSame) {
  scene::Background b = at(30);
  b.sun = false;
  const Sky without = small_sky(b), with = small_sky(at(30));
  EXPECT_EQ(without.sun.radiance, Vec3d());
  EXPECT_EQ(values(without), values(with));
}

TEST(SkyDaylight, EveryValueOfTheSchemaGivesFiniteLight) {
  for (const double elevation : {-90.0, 0.0, 90.0}) {
    for (const double turbidity : {1.0, 10.0}) {
      for (const float value : values(bake_sky(at(elevation, turbidity, 360, 1), {16}))) {
        ASSERT_TRUE(std::isfinite(value));
        ASSERT_GE(value, 0);
      }
    }
  }
}

// The illuminance of the sun above the atmosphere is 133.1 klx (astm-g173). Expected values are those of the clear sky
// of ies1984, which has an illuminance of 127.5 klx above the atmosphere, and for the end of twilight those of ams2024.
TEST(SkyDaylight, IlluminancesAreThoseOfAClearSky) {
  constexpr double kKilolux = 133.1 / kPi;
  std::printf(
      "sun elevation: direct normal, sky (clear sky of ies1984), klx; direct / sky, horizontal; zenith kcd/m2\n");
  for (const double elevation : {60.0, 45.0, 30.0, 20.0, 10.0}) {
    const Sky sky = bake_sky(at(elevation, 2), {128});
    const double height = std::sin(elevation * kPi / 180);
    const double sun = kKilolux * luminance(direct(sky)), diffuse = kKilolux * luminance(irradiance(sky));
    const double expected_sun = 127.5 * std::exp(-0.21 / height), expected_sky = 0.8 + 15.5 * std::sqrt(height);
    std::printf("%4.0f: %6.1f (%5.1f), %5.1f (%4.1f); %4.2f (%4.2f); %4.2f\n", elevation, sun, expected_sun, diffuse,
                expected_sky, sun * height / diffuse, expected_sun * height / expected_sky,
                kKilolux * luminance(radiance(sky, 89.9, 180)));
    EXPECT_NEAR(sun / expected_sun, 1, 0.1) << elevation;
    EXPECT_NEAR(diffuse / expected_sky, 1, 0.35) << elevation;
  }
  for (const double elevation : {-0.833, -6.0, -12.0}) {
    const double lux = 1000 * kKilolux * luminance(irradiance(bake_sky(at(elevation, 2), {128})));
    std::printf("%5.1f: %.3g lx\n", elevation, lux);
    if (elevation > -1) {
      EXPECT_NEAR(lux, 585, 100);
    } else if (elevation == -6) {
      EXPECT_GT(lux, 2);
      EXPECT_LT(lux, 8);
    }
  }
}

}  // namespace
}  // namespace orrery::sky
