// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

#include "accel/list.h"
#include "math/scalar.h"
#include "support/accel_rays.h"

namespace orrery::accel {
namespace {

/// Rays from the origin: the list finds the spheres that a loop over all of them finds.
TEST(AccelListTrace, TheNearestOfAllSpheresIsHit) {
  test::Random random;
  const std::vector<kernel::Sphere> spheres = test::scattered(random, 300, 10, 0.5, 0);
  DistinctObjects scene;
  scene.view.spheres = spheres.data();
  scene.view.sphere_count = spheres.size();
  kernel::Tracer list = list_tracer(kernel::Precision::kExact);
  list.self = &scene;
  int hits = 0;
  for (int trial = 0; trial < 100; ++trial) {
    kernel::RayPacket<double> packet;
    packet.count = kernel::kPacketSize - trial % 3;
    double directions[kernel::kPacketSize][3];
    for (int lane = 0; lane < kernel::kPacketSize; ++lane) {
      for (double& x : directions[lane]) x = random.uniform(-1, 1);
      test::set_ray(packet, lane, {0, 0, 0}, {0, 0, 0}, directions[lane], kernel::kCamera);
    }
    reset_hits(packet);
    kernel::trace(list, packet);
    for (int lane = 0; lane < packet.count; ++lane) {
      double nearest = std::numeric_limits<double>::infinity();
      std::uint64_t found = kernel::kNone;
      for (std::size_t i = 0; i < spheres.size(); ++i) {
        const kernel::Sphere& s = spheres[i];
        const double(&d)[3] = directions[lane];
        const double a = d[0] * d[0] + d[1] * d[1] + d[2] * d[2], b = d[0] * s.x + d[1] * s.y + d[2] * s.z;
        const double c = s.x * s.x + s.y * s.y + s.z * s.z - s.radius * s.radius, root = b * b - a * c;
        if (root < 0) continue;
        for (const double t : {(b - std::sqrt(root)) / a, (b + std::sqrt(root)) / a})
          if (t > 0 && t < nearest) nearest = t, found = i;
      }
      ASSERT_EQ(packet.hit[lane], found);
      if (found != kernel::kNone) {
        ++hits;
        EXPECT_NEAR(packet.distance[lane], nearest, 1e-9 * nearest);
      }
    }
  }
  EXPECT_GT(hits, 100);
}

}  // namespace
}  // namespace orrery::accel
