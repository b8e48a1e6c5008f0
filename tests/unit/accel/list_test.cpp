// SPDX-License-Identifier: Apache-2.0
#include "accel/list.h"

#include <gtest/gtest.h>

#include <vector>

#include "accel/accel.h"
#include "support/accel_rays.h"
#include "support/accelerators.h"

namespace orrery::accel {
namespace {

/// The id of the sphere that a ray along -z hits, and its distance.
std::pair<std::uint64_t, double> hit_of(const Accel& accel, std::uint64_t self = kernel::kCamera) {
  kernel::RayPacket<double> packet;
  packet.count = 1;
  for (int lane = 0; lane < kernel::kPacketSize; ++lane) {
    test::set_ray(packet, lane, {0, 0, 0}, {0, 0, 0}, {0, 0, -1}, self);
    packet.threshold[lane] = 0.5F;
  }
  reset_hits(packet);
  kernel::trace(accel.tracer(), packet);
  return {packet.hit[0], packet.distance[0]};
}

TEST(AccelList, TheNearestSphereIsHitAndDuplicatesNever) {
  const std::vector<kernel::Sphere> spheres = {{0, 0, -9, 1}, {0, 0, -5, 1}, {0, 0, -5, 1}};
  kernel::SceneView view;
  view.spheres = spheres.data();
  view.sphere_count = spheres.size();
  const std::vector<std::uint32_t> duplicates = {1};
  view.duplicates = duplicates;
  for (const auto precision : {kernel::Precision::kExact, kernel::Precision::kBook}) {
    const auto list = make_list(view, precision);
    EXPECT_EQ(hit_of(*list), (std::pair<std::uint64_t, double>{2, 4}));
    EXPECT_EQ(list->name(), "list");
    EXPECT_EQ(list->bytes(), sizeof(std::uint32_t)) << "one duplicate";
  }
}

TEST(AccelList, OpacityCanChange) {
  const std::vector<kernel::Sphere> spheres = {{0, 0, -9, 1}, {0, 0, -5, 1}};
  const std::vector<float> opacity = {1, 0};
  kernel::SceneView view;
  view.spheres = spheres.data();
  view.sphere_count = spheres.size();
  const auto list = make_list(view, kernel::Precision::kExact);
  EXPECT_EQ(hit_of(*list).first, 1u);
  list->set_opacity(opacity.data());
  EXPECT_EQ(hit_of(*list).first, 0u);
  list->set_opacity(nullptr);
  EXPECT_EQ(hit_of(*list).first, 1u);
}

}  // namespace
}  // namespace orrery::accel
