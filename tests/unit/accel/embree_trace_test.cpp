// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "accel/accel.h"
#include "support/accel_rays.h"
#include "support/accelerators.h"

namespace orrery::accel {
namespace {

using kernel::kCamera;
using kernel::kNone;
using kernel::kPacketSize;
using kernel::Sphere;
using test::kWaysBesideTheList;
using test::Way;

TEST(AccelEmbreeTrace, PacketsCanBePartlyFilled) {
  const std::vector<Sphere> spheres = {{0, 0, -5, 1}, {0, 0, 5, 1}};
  kernel::SceneView view;
  view.spheres = spheres.data();
  view.sphere_count = 2;
  for (const Way& way : kWaysBesideTheList) {
    const auto embree = way.make(view, kernel::Precision::kExact);
    for (int count = 1; count <= kPacketSize; ++count) {
      kernel::RayPacket<double> p;
      p.count = count;
      for (int lane = 0; lane < kPacketSize; ++lane) {
        test::set_ray(p, lane, {0, 0, 0}, {0, 0, 0}, {0, 0, -1}, kCamera);
        p.distance[lane] = std::numeric_limits<double>::max();
        p.hit[lane] = kNone;
      }
      kernel::trace(embree->tracer(way.traversal), p);
      for (int lane = 0; lane < kPacketSize; ++lane) {
        EXPECT_EQ(p.hit[lane], lane < count ? 0u : std::uint64_t{kNone}) << count;
        if (lane < count) {
          EXPECT_EQ(p.distance[lane], 4);
        }
      }
    }
  }
}

}  // namespace
}  // namespace orrery::accel
