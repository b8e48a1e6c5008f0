// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/error.h"
#include "film/picture.h"
#include "generate/generate.h"
#include "math/vec3.h"

namespace orrery::generate {
namespace {

using math::Vec3d;

Vec3d texel(const film::Picture& p, int x, int y) {
  const auto at = static_cast<std::size_t>(y * p.width + x);
  return {static_cast<double>(p.planes[0].values[at]), static_cast<double>(p.planes[1].values[at]),
          static_cast<double>(p.planes[2].values[at])};
}
double brightness(Vec3d c) { return (c.x + c.y + c.z) / 3; }

TEST(GeneratePlanet, ValuesAreReflectances) {
  const film::Picture p = make_planet(3, 128);
  EXPECT_EQ(p.height, 64);
  for (const film::Plane& plane : p.planes)
    for (const float v : plane.values) ASSERT_TRUE(v >= 0 && v <= 1) << v;
}

TEST(GeneratePlanet, HasSeaLandIceAtThePolesAndClouds) {
  const film::Picture p = make_planet(1, 256);
  int sea = 0, land = 0, white = 0, all = 0;
  for (int y = p.height / 3; y < p.height * 2 / 3; ++y)
    for (int x = 0; x < p.width; ++x, ++all) {
      const Vec3d c = texel(p, x, y);
      if (brightness(c) > 0.55) {
        ++white;
      } else if (c.z > 1.2 * c.x && c.z > c.y) {
        ++sea;
      } else if (c.x > c.z || c.y > c.z) {
        ++land;
      }
    }
  EXPECT_GT(sea, all / 4);
  EXPECT_GT(land, all / 8);
  EXPECT_GT(white, all / 100);
  EXPECT_LT(white, all / 4);
  for (int x = 0; x < p.width; ++x) {
    EXPECT_GT(brightness(texel(p, x, 1)), 0.6);
    EXPECT_GT(brightness(texel(p, x, p.height - 2)), 0.6);
  }
}

TEST(GeneratePlanet, TheEdgesOfTheMapMatch) {
  const film::Picture p = make_planet(1, 1024);
  const auto difference = [&](int x, int next) {
    double sum = 0;
    for (int y = 0; y < p.height; ++y) sum += std::abs(brightness(texel(p, x, y)) - brightness(texel(p, next, y)));
    return sum / p.height;
  };
  double inside = 0;
  for (int x = 100; x < 200; ++x) inside = std::max(inside, difference(x, x + 1));
  EXPECT_LT(difference(p.width - 1, 0), 1.5 * inside);
}

TEST(GeneratePlanet, TheSeedChangesIt) {
  EXPECT_EQ(make_planet(1, 32).planes[0].values, make_planet(1, 32).planes[0].values);
  EXPECT_NE(make_planet(1, 32).planes[0].values, make_planet(2, 32).planes[0].values);
}

TEST(GeneratePlanet, OtherWidthsAreRefused) {
  for (const int width : {0, 18, 8196}) EXPECT_THROW(make_planet(1, width), base::Error) << width;
}

}  // namespace
}  // namespace orrery::generate
