// SPDX-License-Identifier: Apache-2.0
// Which objects are visible to a ray, in all accelerators and traversals alike: those whose opacity is greater than its
// threshold.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>
#include <memory>
#include <vector>

#include "accel/accel.h"
#include "kernel/scene_view.h"
#include "support/accel_rays.h"
#include "support/accelerators.h"

namespace orrery::accel {
namespace {

using kernel::kCamera;
using kernel::kNone;
using kernel::kPacketSize;
using kernel::Precision;
using test::Random;

kernel::SceneView view_of(const std::vector<kernel::Sphere>& spheres, const std::vector<float>& opacity) {
  kernel::SceneView view;
  view.spheres = spheres.data();
  view.sphere_count = spheres.size();
  view.opacity = opacity.empty() ? nullptr : opacity.data();
  return view;
}

float random_threshold(Random& random) { return static_cast<float>(random.uniform(0, 1)); }

kernel::RayPacket<double> random_rays(Random& random, const test::Scene& scene) {
  kernel::RayPacket<double> packet;
  packet.count = kPacketSize;
  kernel::reset_hits(packet);
  for (int lane = 0; lane < kPacketSize; ++lane) {
    test::aim(random, scene, packet, lane);
    packet.threshold[lane] = random_threshold(random);
  }
  return packet;
}

kernel::ShadowPacket<double> shadows_of(const kernel::RayPacket<double>& rays) {
  kernel::ShadowPacket<double> out;
  static_cast<kernel::PacketRays<double>&>(out) = rays;
  std::fill_n(out.target, kPacketSize, std::uint64_t{kNone});
  return out;
}

/// Number of rays with different hits or occlusion.
long differences(const kernel::Tracer& one, const kernel::Tracer& other, const kernel::RayPacket<double>& rays) {
  kernel::RayPacket<double> a = rays, b = rays;
  kernel::trace(one, a);
  kernel::trace(other, b);
  kernel::ShadowPacket<double> c = shadows_of(rays), e = shadows_of(rays);
  kernel::occlude(one, c);
  kernel::occlude(other, e);
  long out = 0;
  for (int lane = 0; lane < kPacketSize; ++lane)
    out += a.hit[lane] != b.hit[lane] || a.distance[lane] != b.distance[lane] || c.occluded[lane] != e.occluded[lane];
  return out;
}

TEST(AccelOpacity, AllWaysFindTheSameHitsAndOcclusion) {
  for (const test::Scene& scene : test::scenes()) {
    Random random;
    const std::vector<float> opacity = test::random_opacities(random, scene.spheres.size());
    const kernel::SceneView view = view_of(scene.spheres, opacity);
    const auto list = make_list(view, Precision::kExact);
    for (const test::Way& way : test::kWaysBesideTheList) {
      const auto other = way.make(view, Precision::kExact);
      long different = 0;
      for (int i = 0; i < 100; ++i)
        different += differences(list->tracer(), other->tracer(way.traversal), random_rays(random, scene));
      EXPECT_EQ(different, 0) << scene.name << ", " << way.name;
    }
  }
}

/// The hits are those of a scene without the invisible objects, which are known by tracing each alone.
TEST(AccelOpacity, InvisibleObjectsAreNotThere) {
  const test::Scene scene = test::scenes()[1];
  Random random;
  const std::size_t count = scene.spheres.size();
  const std::vector<float> opacity = test::random_opacities(random, count);
  const auto list = make_list(view_of(scene.spheres, opacity), Precision::kExact);
  long hits = 0, changed = 0;
  for (int i = 0; i < 50; ++i) {
    const kernel::RayPacket<double> rays = random_rays(random, scene);
    kernel::RayPacket<double> all = rays, nearest = rays;
    kernel::trace(list->tracer(), all);
    for (std::size_t id = 0; id < count; ++id) {
      // The others are out of reach, and the ids are the same.
      std::vector<kernel::Sphere> alone(count, kernel::Sphere{1e9, 1e9, 1e9, 1e-9});
      alone[id] = scene.spheres[id];
      kernel::RayPacket<double> one = rays;
      kernel::trace(make_list(view_of(alone, opacity), Precision::kExact)->tracer(), one);
      for (int lane = 0; lane < kPacketSize; ++lane)
        if (one.hit[lane] == id && one.distance[lane] < nearest.distance[lane]) {
          nearest.hit[lane] = id;
          nearest.distance[lane] = one.distance[lane];
        }
    }
    kernel::RayPacket<double> opaque = rays;
    kernel::trace(make_list(view_of(scene.spheres, {}), Precision::kExact)->tracer(), opaque);
    for (int lane = 0; lane < kPacketSize; ++lane) {
      EXPECT_EQ(all.hit[lane], nearest.hit[lane]);
      hits += all.hit[lane] != kNone;
      changed += all.hit[lane] != opaque.hit[lane];
    }
  }
  EXPECT_GT(hits, 200);
  EXPECT_GT(changed, 200);
}

TEST(AccelOpacity, CanChangeAfterTheBuild) {
  for (const test::Scene& scene : test::scenes()) {
    Random random;
    const std::vector<float> opacity = test::random_opacities(random, scene.spheres.size());
    const auto list = make_list(view_of(scene.spheres, {}), Precision::kExact),
               translucent_list = make_list(view_of(scene.spheres, opacity), Precision::kExact);
    for (const test::Way& way : test::kWays) {
      const auto accel = way.make(view_of(scene.spheres, {}), Precision::kExact);
      accel->set_opacity(opacity.data());
      long different = 0;
      for (int i = 0; i < 20; ++i)
        different += differences(translucent_list->tracer(), accel->tracer(way.traversal), random_rays(random, scene));
      accel->set_opacity(nullptr);
      for (int i = 0; i < 20; ++i)
        different += differences(list->tracer(), accel->tracer(way.traversal), random_rays(random, scene));
      EXPECT_EQ(different, 0) << scene.name << ", " << way.name;
    }
  }
}

TEST(AccelOpacity, OneGivesTheHitsOfASceneWithoutOpacities) {
  for (const test::Scene& scene : test::scenes()) {
    const std::vector<float> opacity(scene.spheres.size(), 1);
    const auto list = make_list(view_of(scene.spheres, {}), Precision::kExact);
    for (const test::Way& way : test::kWays) {
      const auto other = way.make(view_of(scene.spheres, opacity), Precision::kExact);
      Random random;
      long different = 0;
      for (int i = 0; i < 20; ++i)
        different += differences(list->tracer(), other->tracer(way.traversal), random_rays(random, scene));
      EXPECT_EQ(different, 0) << scene.name << ", " << way.name;
    }
  }
}

/// A rod along x in front of rays along z, which hit its halves in turn.
TEST(AccelOpacity, TheHalfThatARayEntersDecidesAboutARod) {
  kernel::Rod rod;
  rod.a[0] = -2;
  rod.b[0] = 2;
  rod.radius = 1;
  const kernel::Sphere unused;
  const auto half_of_lane = [](int lane) { return static_cast<std::uint64_t>(lane % 2); };
  for (const std::vector<float>& opacity : {std::vector<float>{0.4F, 0.4F}, {0.2F, 0.7F}, {0, 1}, {1, 0}}) {
    kernel::SceneView view;
    view.spheres = &unused;
    view.rods = {&rod, 1, nullptr, 0, 0};
    view.opacity = opacity.data();
    for (const test::Way& way : test::kWays) {
      const auto accel = way.make(view, Precision::kExact);
      Random random;
      long hits[2] = {0, 0}, both = 0, split = 0, wrong = 0;
      constexpr long kPackets = 500;
      for (long i = 0; i < kPackets; ++i) {
        kernel::RayPacket<double> packet;
        packet.count = kPacketSize;
        kernel::reset_hits(packet);
        for (int lane = 0; lane < kPacketSize; ++lane) {
          test::set_ray(packet, lane, {half_of_lane(lane) == 0 ? -1.0 : 1.0, 0.1, 5}, {0, 0, 0}, {0, 0, -1}, kCamera);
          packet.threshold[lane] = lane % 2 == 0 ? random_threshold(random) : packet.threshold[lane - 1];
        }
        kernel::trace(accel->tracer(way.traversal), packet);
        for (int lane = 0; lane < kPacketSize; lane += 2) {
          const bool first = packet.hit[lane] != kNone, second = packet.hit[lane + 1] != kNone;
          hits[0] += first;
          hits[1] += second;
          both += first && second;
          split += first != second;
          wrong += (first && packet.hit[lane] != 0) || (second && packet.hit[lane + 1] != 1);
        }
      }
      const double rays = static_cast<double>(kPackets) * kPacketSize / 2;
      for (const int half : {0, 1})
        EXPECT_NEAR(static_cast<double>(hits[half]) / rays, double{opacity[static_cast<std::size_t>(half)]}, 0.03)
            << way.name;
      EXPECT_EQ(both, std::min(hits[0], hits[1])) << way.name;  // one decision about the whole rod
      if (opacity[0] == opacity[1]) {
        EXPECT_EQ(split, 0) << way.name;
      }
      EXPECT_EQ(wrong, 0) << way.name;
    }
  }
}

}  // namespace
}  // namespace orrery::accel
