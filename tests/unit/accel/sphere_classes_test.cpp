// SPDX-License-Identifier: Apache-2.0
#include "accel/sphere_classes.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "accel/accel.h"
#include "kernel/isa.h"
#include "kernel/scene_view.h"
#include "support/accel_rays.h"

namespace orrery::accel {
namespace {

using kernel::Sphere;
using test::Random;
using test::scattered;

TEST(AccelSphereClasses, OutliersAndDuplicatesAreNotOrdinary) {
  kernel::SceneView view;
  view.sphere_count = 3;
  EXPECT_EQ(ordinary_spheres(view, {}), (std::vector<std::uint32_t>{0, 1, 2}));
  view.sphere_count = 6;
  const std::vector<std::uint32_t> duplicates = {2, 5, 7};  // the last is a rod
  view.duplicates = duplicates;
  EXPECT_EQ(ordinary_spheres(view, {0, 2}), (std::vector<std::uint32_t>{1, 3, 4}));
}

TEST(AccelSphereClasses, AGroundIsAnOutlier) {
  Random random;
  std::vector<Sphere> spheres = scattered(random, 1000, 10, 0.1, 0);
  spheres.push_back({0, -10000, 0, 9990});
  kernel::SceneView view;
  view.spheres = spheres.data();
  view.sphere_count = spheres.size();
  EXPECT_EQ(find_outliers(view), std::vector<std::uint32_t>{1000});
  view.sphere_count = 1000;
  EXPECT_TRUE(find_outliers(view).empty());
}

TEST(AccelSphereClasses, MovingSpheresAreInTheBvhUnlessTheyMoveFar) {
  Random random;
  const std::vector<Sphere> spheres = scattered(random, 200'000, 100, 0.1, 0);
  std::vector<Sphere> motion(150'000, Sphere{0.004, 0, 0, 0.001});
  motion[7] = {1, 0, 0, 0};
  kernel::SceneView view;
  view.spheres = spheres.data();
  view.sphere_count = spheres.size();
  view.motion = motion.data();
  view.moving_count = motion.size();
  EXPECT_EQ(objects_in_bvh(view).spheres, spheres.size() - 1);
  EXPECT_NEAR(enclosing_radius(view, 3), spheres[3].radius + 0.001 + 0.002, 1e-12);
  EXPECT_EQ(enclosing_radius(view, motion.size()), spheres[motion.size()].radius);
}

TEST(AccelSphereClasses, ThinLayersOfFewSpheresHaveNoBvhOfTheirOwn) {
  Random random;
  const std::vector<Sphere> cloud = scattered(random, 100'000, 100, 0.1, 0);
  for (const std::string& isa : kernel::available_isas()) {
    ASSERT_TRUE(kernel::limit_isa(isa));
    std::vector<Sphere> spheres = cloud;
    kernel::SceneView view;
    view.spheres = spheres.data();
    view.sphere_count = spheres.size();
    EXPECT_EQ(objects_in_bvh(view).spheres, spheres.size()) << isa;
    const std::size_t bytes = make_embree(view, kernel::Precision::kExact)->bytes();
    for (Sphere& s : spheres) s.y *= 0.05;
    EXPECT_EQ(objects_in_bvh(view).all(), 0u) << isa;
    EXPECT_GT(make_embree(view, kernel::Precision::kExact)->bytes(), 2 * bytes) << isa;
  }
  kernel::limit_isa("");
}

}  // namespace
}  // namespace orrery::accel
