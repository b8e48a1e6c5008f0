// SPDX-License-Identifier: Apache-2.0
#include "generate/generate.h"

#include <gtest/gtest.h>

#include <set>

#include "scene/validate.h"
#include "unit/generate/expectations.h"

namespace orrery::generate {
namespace {

TEST(GenerateCloud, HasExactlyTheRequestedNumberOfSpheres) {
  for (const std::uint64_t count : {1u, 2u, 10u, 1000u, 12345u}) {
    const scene::Scene s = make_cloud({1, count});
    EXPECT_TRUE(s.spheres.empty());
    ASSERT_EQ(s.points.size(), 1u);
    EXPECT_EQ(s.points[0].centers.size(), count);
    EXPECT_EQ(s.points[0].radii.size(), count);
    EXPECT_EQ(s.points[0].materials.size(), count);
    EXPECT_TRUE(scene::validate(s).empty()) << count;
  }
}

TEST(GenerateCloud, SeedDeterminesTheCloud) {
  const auto centers = [](std::uint64_t seed) { return make_cloud({seed, 100}).points[0].centers; };
  EXPECT_EQ(centers(1), centers(1));
  EXPECT_NE(centers(1), centers(2));
}

TEST(GenerateCloud, TotalCrossSectionDoesNotDependOnTheCount) {
  const auto cross_section = [](std::uint64_t count) {
    const scene::Scene s = make_cloud({1, count});
    double sum = 0;
    for (const double r : s.points[0].radii) sum += r * r;
    return sum;
  };
  // The cross-section of a sphere has a relative spread of about one half, so that of 1000 is good to a few percent.
  EXPECT_NEAR(cross_section(1000) / cross_section(200'000), 1.0, 0.08);
}

TEST(GenerateCloud, AGivenRadiusAppliesToEverySphere) {
  const scene::Scene s = make_cloud({1, 100, 0.0625});
  for (const double r : s.points[0].radii) EXPECT_EQ(r, 0.0625);
}

TEST(GenerateCloud, UsesAllItsMaterials) {
  const scene::Scene s = make_cloud({1, 1000});
  const std::set<std::uint32_t> used(s.points[0].materials.begin(), s.points[0].materials.end());
  EXPECT_EQ(used.size(), s.materials.size());
}

}  // namespace
}  // namespace orrery::generate
