// SPDX-License-Identifier: Apache-2.0
#include "accel/traversal.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "accel/accel.h"
#include "kernel/scene_view.h"
#include "support/accel_rays.h"

namespace orrery::accel {
namespace {

constexpr Traversals kPackets{Traversal::kPacket, Traversal::kPacket}, kMixed{Traversal::kPacket, Traversal::kSingle};

/// The traversals of a cloud of small spheres; `thickness` of its width along one axis.
Traversals of_cloud(int count, bool has_bvh, double thickness = 1) {
  test::Random random;
  std::vector<kernel::Sphere> spheres = test::scattered(random, count, 100, 0.1, 0);
  for (kernel::Sphere& s : spheres) s.y *= thickness;
  spheres.push_back({0, -1e5, 0, 1e5});  // a ground
  kernel::SceneView view;
  view.spheres = spheres.data();
  view.sphere_count = spheres.size();
  return fastest_traversals(view, has_bvh);
}

TEST(AccelTraversal, FollowsFromStructureAndCount) {
  EXPECT_EQ(of_cloud(998, false), kPackets);
  EXPECT_EQ(of_cloud(1000, false), kMixed);
  EXPECT_EQ(of_cloud(600, true), kMixed);
  for (const bool has_bvh : {false, true}) EXPECT_EQ(of_cloud(10'000, has_bvh, 0.05), kPackets);
}

TEST(AccelTraversal, ALayerWithMoreRodsThanSpheresDoesNotCount) {
  std::vector<kernel::Sphere> spheres;
  for (int i = 0; i < 1000; ++i) spheres.push_back({i % 30 * 1.0, 0, i / 30 * 1.0, 0.2});
  std::vector<kernel::Rod> rods(spheres.size(), kernel::Rod{{0, 0, 0}, 0.1, {0, 90, 0}});
  kernel::SceneView view;
  view.spheres = spheres.data();
  view.sphere_count = spheres.size();
  EXPECT_EQ(fastest_traversals(view, true), kPackets);
  view.rods.plain = rods.data();
  view.rods.count = rods.size();
  EXPECT_EQ(fastest_traversals(view, true), kMixed);
}

TEST(AccelTraversal, IsThatOfTheAccelerator) {
  test::Random random;
  const std::vector<kernel::Sphere> spheres = test::scattered(random, 100, 100, 0.1, 0);
  kernel::SceneView view;
  view.spheres = spheres.data();
  view.sphere_count = spheres.size();
  const auto name = [&](std::size_t threshold, std::optional<Traversal> requested = {}) {
    return make_embree(view, kernel::Precision::kExact, {}, threshold)->traversal_name(requested);
  };
  EXPECT_EQ(name(kNoBvh), "packet");
  EXPECT_EQ(name(1), "packet, secondary and shadow single");
  EXPECT_EQ(name(1, Traversal::kPacket), "packet");
  EXPECT_EQ(name(1, Traversal::kSingle), "single");
  EXPECT_EQ(make_list(view, kernel::Precision::kExact)->traversal_name({}), "list");
}

}  // namespace
}  // namespace orrery::accel
