// SPDX-License-Identifier: Apache-2.0
#include "sky/atmosphere.h"

#include <gtest/gtest.h>

#include <cmath>

namespace orrery::sky {
namespace {

TEST(SkyAtmosphere, TabulatedColumnsMatchQuadrature) {
  const ColumnTable columns;
  for (const double altitude : {0.0, 300.0, 5e3, 22e3, 60e3}) {
    const double radius = kGroundRadius + altitude;
    const double horizon = -std::sqrt(altitude * (radius + kGroundRadius)) / radius;
    for (const double part : {0.0, 0.01, 0.1, 0.5, 1.0}) {
      const double sine = horizon + (1 - horizon) * part, length = distance_to_space(radius, sine);
      constexpr int kSteps = 100000;
      Densities expected;
      for (int i = 0; i < kSteps; ++i) {
        const double t = length * (i + 0.5) / kSteps;
        const double h = std::sqrt(radius * radius + t * t + 2 * radius * t * sine) - kGroundRadius;
        expected = expected + densities(h) * (length / kSteps);
      }
      const Densities found = columns.to_space(altitude, sine);
      EXPECT_NEAR(found.molecules / expected.molecules, 1, 0.01) << altitude << " " << part;
      if (altitude < 30e3) {
        EXPECT_NEAR(found.aerosol / expected.aerosol, 1, 0.01) << altitude << " " << part;
      }
      EXPECT_NEAR(found.ozone, expected.ozone, 0.01 * expected.ozone + 1) << altitude << " " << part;
    }
  }
}

TEST(SkyAtmosphere, GreyReflectancesAreConstant) {
  for (const double value : reflectance_of({0.3, 0.3, 0.3})) EXPECT_DOUBLE_EQ(value, 0.3);
  const Spectrum green = reflectance_of({0, 1, 0});
  EXPECT_EQ(green.front(), 0);
  EXPECT_EQ(green[kBands / 2 - 1], 1);
  EXPECT_EQ(green.back(), 0);
}

}  // namespace
}  // namespace orrery::sky
