// SPDX-License-Identifier: Apache-2.0
#include "sky/scattering.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sky/atmosphere.h"

namespace orrery::sky {
namespace {

constexpr double kNoon = std::numbers::pi / 2;

/// Light from the zenith, where the ray is `toward_sun` from the sun.
Scattering::Light light(const Scattering& scattering, double sine, double toward_sun) {
  return scattering.toward_ground(scattering.ray_from_ground(sine, 64), toward_sun);
}

TEST(SkyScattering, ARayAbsorbsLikeTheColumnToSpace) {
  const Atmosphere air(3);
  const ColumnTable columns;
  const Scattering scattering(air, columns, kNoon, Spectrum{}, 1);
  for (const double sine : {0.1, 0.5, 1.0}) {
    const Ray ray = scattering.ray_from_ground(sine, 256);
    const Spectrum expected = air.scaled_transmittance(columns.to_space(0, sine));
    for (std::size_t band = 0; band < kBands; ++band)
      EXPECT_NEAR(ray.transmittance[band], expected[band], 0.02) << sine << " " << band;
  }
}

TEST(SkyScattering, WithoutAerosolOnlyMoleculesScatter) {
  const Atmosphere air(1);
  const ColumnTable columns;
  const Scattering scattering(air, columns, kNoon, Spectrum{}, 1);
  const Scattering::Light found = light(scattering, 1, 0.5);
  EXPECT_GT(found.molecules[0], found.molecules[kBands - 1]) << "blue scatters more than red";
  for (const double v : found.aerosol) EXPECT_EQ(v, 0);
}

TEST(SkyScattering, ABrightGroundAddsMultipleScattering) {
  const Atmosphere air(3);
  const ColumnTable columns;
  Spectrum white;
  white.fill(1);
  const Scattering dark(air, columns, kNoon, Spectrum{}, 1), bright(air, columns, kNoon, white, 1);
  const Scattering::Light on_dark = light(dark, 0.5, 0.5), on_bright = light(bright, 0.5, 0.5);
  for (std::size_t band = 0; band < kBands; ++band) {
    EXPECT_GT(on_bright.multiple[band], on_dark.multiple[band]);
    EXPECT_EQ(on_bright.molecules[band], on_dark.molecules[band]);
  }
}

}  // namespace
}  // namespace orrery::sky
