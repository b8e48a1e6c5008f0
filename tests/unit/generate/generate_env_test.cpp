// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/error.h"
#include "film/picture.h"
#include "generate/generate.h"
#include "scene/scene.h"
#include "sky/atmosphere.h"
#include "sky/daylight.h"

namespace orrery::generate {
namespace {

using math::Vec3d;

constexpr double kPi = std::numbers::pi;

/// Calls `visit(direction, solid angle, RGB)` for every texel.
template <class Visit>
void for_each_texel(const film::Picture& p, Visit visit) {
  std::size_t at = 0;
  for (int y = 0; y < p.height; ++y) {
    const double top = kPi / 2 - y * kPi / p.height, latitude = top - kPi / p.height / 2;
    const double solid_angle = 2 * kPi / p.width * (std::sin(top) - std::sin(top - kPi / p.height));
    for (int x = 0; x < p.width; ++x, ++at) {
      const double longitude = kPi - (x + 0.5) / p.width * 2 * kPi;
      const Vec3d d{std::cos(latitude) * std::sin(longitude), std::sin(latitude),
                    std::cos(latitude) * std::cos(longitude)};
      visit(d, solid_angle, Vec3d{p.planes[0].values[at], p.planes[1].values[at], p.planes[2].values[at]});
    }
  }
}

/// Irradiance of a surface.
Vec3d irradiance(const film::Picture& p, Vec3d normal) {
  Vec3d sum;
  for_each_texel(p, [&](Vec3d d, double solid_angle, Vec3d light) {
    sum = sum + light * (solid_angle * std::max(math::dot(d, normal), 0.0));
  });
  return sum;
}

Vec3d radiance(const film::Picture& p, Vec3d direction) {
  Vec3d out;
  double closest = -1;
  for_each_texel(p, [&](Vec3d d, double, Vec3d light) {
    if (math::dot(d, direction) <= closest) return;
    closest = math::dot(d, direction);
    out = light;
  });
  return out;
}

scene::Background sky_at(double elevation, double azimuth = 30) {
  scene::Background b;
  b.sun_elevation = elevation;
  b.sun_azimuth = azimuth;
  return b;
}

TEST(GenerateEnv, StudioHasTheDocumentedLights) {
  const film::Picture studio = make_studio(256);
  ASSERT_EQ(studio.width, 256);
  ASSERT_EQ(studio.height, 128);
  const auto light = [&](Vec3d direction) { return radiance(studio, math::normalized(direction)).x; };
  EXPECT_NEAR(light({-1.7, 1.3, 1.6}), 18, 0.1);
  EXPECT_NEAR(light({2.1, 0.5, 1.3}), 3, 0.05);
  EXPECT_NEAR(light({1.3, 0.9, -2.2}), 25, 0.5);
  EXPECT_NEAR(light({0, 1, 0}), 4, 0.5);
  EXPECT_LT(light({0, 0.1, -1}), 0.05);
  EXPECT_LT(light({0, 0.1, 1}), 0.05);
  EXPECT_GT(light({0, -1, 0}), 0.1);
}

TEST(GenerateEnv, StudioIsExposedForAWhiteBall) {
  const double toward_key = irradiance(make_studio(256), math::normalized(Vec3d{-1.7, 1.3, 1.6})).x / kPi;
  EXPECT_GT(toward_key, 1);
  EXPECT_LT(toward_key, 1.5);
}

TEST(GenerateEnv, StudioIsGrey) {
  const film::Picture studio = make_studio(64);
  EXPECT_EQ(studio.planes[0].values, studio.planes[1].values);
  EXPECT_EQ(studio.planes[0].values, studio.planes[2].values);
}

// Irradiance of a surface that faces the sun, on which texels of the sun act as the disc does.
TEST(GenerateEnv, SkyHasTheIrradianceOfSunAndSkyAtEveryWidth) {
  const auto toward_sun = [](const scene::LatLongMap& image) {
    return sky::luminance(image.sun.radiance) * 2 * kPi * image.sun.one_minus_cos;
  };
  for (const double elevation : {89.9, 0.1}) {
    for (const int width : {16, 256}) {
      const scene::Background with = sky_at(elevation);
      scene::Background without = with;
      without.sun = false;
      const scene::LatLongMap image = sky::bake_sky(with, {width});
      const Vec3d normal = image.sun.direction;
      const Vec3d difference = irradiance(make_sky(with, width), normal) - irradiance(make_sky(without, width), normal);
      // At 16 px, the sun is up to 16 degrees from the centre of its texel.
      EXPECT_NEAR(sky::luminance(difference) / toward_sun(image), 1, width == 16 ? 0.05 : 0.01)
          << elevation << " " << width;
    }
  }
}

TEST(GenerateEnv, SkyIsTheModelAwayFromTheSun) {
  const film::Picture picture = make_sky(sky_at(30), 64);
  const scene::LatLongMap image = sky::bake_sky(sky_at(30), {64});
  int different = 0;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x)
      different += picture.planes[1].values[static_cast<std::size_t>(64 * y + x)] != image.row(y)[3 * x + 1] ? 1 : 0;
  EXPECT_GE(different, 1);
  EXPECT_LE(different, 4);
}

TEST(GenerateEnv, OptionsOutOfRangeAreRefused) {
  for (const int width : {0, 15, 62, 8196}) EXPECT_THROW(make_studio(width), base::Error) << width;
  EXPECT_THROW(make_sky(sky_at(91)), base::Error);
  EXPECT_THROW(make_sky(sky_at(std::nan(""))), base::Error);
  scene::Background hazy = sky_at(30);
  hazy.turbidity = 11;
  EXPECT_THROW(make_sky(hazy), base::Error);
  hazy.turbidity = 0.5;
  EXPECT_THROW(make_sky(hazy), base::Error);
}

}  // namespace
}  // namespace orrery::generate
