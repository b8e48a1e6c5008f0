// SPDX-License-Identifier: Apache-2.0
// Compares Embree with the list on rods, ray by ray: the same half of the same rod, and the same bits of distance.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <memory>
#include <vector>

#include "accel/accel.h"
#include "accel/sphere_classes.h"
#include "kernel/scene_view.h"
#include "support/accel_rays.h"
#include "support/accelerators.h"

namespace orrery::accel {
namespace {

using kernel::kCamera;
using kernel::kNone;
using kernel::kPacketSize;
using kernel::Rod;
using test::Random;

struct RodScene {
  const char* name;
  std::vector<Rod> rods;
  std::vector<kernel::Sphere> spheres;
  std::vector<Rod> motion = {};
  double camera_distance = 5;
  std::vector<kernel::Bond> bonds = {};
  std::vector<float> opacity = {};  ///< of spheres and halves of rods

  kernel::SceneView view() const {
    static constexpr kernel::Sphere kReadable;
    kernel::SceneView view;
    view.spheres = spheres.empty() ? &kReadable : spheres.data();
    view.sphere_count = spheres.size();
    static constexpr double kBondRadii[] = {0.02, 0.03};
    view.rods = {rods.data(),    rods.size() + bonds.size(),
                 motion.data(),  motion.size(),
                 spheres.size(), bonds.data(),
                 bonds.size(),   kBondRadii,
                 view.spheres};
    view.opacity = opacity.empty() ? nullptr : opacity.data();
    return view;
  }

  /// The same with rods in place of bonds.
  RodScene without_bonds() const {
    RodScene out = *this;
    out.bonds.clear();
    for (std::size_t i = rods.size(); i < rods.size() + bonds.size(); ++i) out.rods.push_back(view().rods[i]);
    return out;
  }
};

/// Every scene, and the same scene with opacities.
std::vector<RodScene> rod_scenes() {
  Random random;
  std::vector<RodScene> list;
  list.push_back({"one rod", test::random_rods(random, 1, 1, 0.2), {}});
  list.push_back({"bonds", test::random_rods(random, 300, 0.3, 0.03), test::scattered(random, 100, 1, 0.1, 0)});
  list.push_back(
      {"long rods in pieces", test::random_rods(random, 60, 2, 0.002), test::scattered(random, 10, 1, 0.1, 0)});
  RodScene ground{"over a ground", test::random_rods(random, 50, 0.5, 0.05), test::scattered(random, 50, 1, 0.1, 0)};
  ground.spheres.push_back({0, -1001, 0, 1000});
  list.push_back(ground);
  RodScene edges{"edges of a box", {}, test::scattered(random, 100, 0.9, 0.1, 0)};
  for (int axis = 0; axis < 3; ++axis) {
    for (int corner = 0; corner < 4; ++corner) {
      Rod rod;
      const int across = (axis + 1) % 3, other = (axis + 2) % 3;
      rod.a[across] = rod.b[across] = corner % 2 == 0 ? -1 : 1;
      rod.a[other] = rod.b[other] = corner / 2 == 0 ? -1 : 1;
      rod.a[axis] = -1;
      rod.b[axis] = 1;
      rod.radius = 0.01;
      edges.rods.push_back(rod);
    }
  }
  list.push_back(edges);
  RodScene coincident{"coincident, and of length 0", test::random_rods(random, 5, 0.5, 0.1), {}};
  for (int i = 0; i < 5; ++i) {
    Rod sphere = coincident.rods[static_cast<std::size_t>(i)];
    coincident.rods.push_back(sphere);
    std::copy_n(sphere.a, 3, sphere.b);
    coincident.rods.push_back(sphere);
    coincident.spheres.push_back({sphere.a[0], sphere.a[1], sphere.a[2], sphere.radius});
  }
  list.push_back(coincident);
  RodScene far{"offset 1e6", test::random_rods(random, 50, 0.5, 0.05), {}};
  for (Rod& rod : far.rods)
    for (int k = 0; k < 3; ++k) {
      rod.a[k] += 1e6;
      rod.b[k] += 1e6;
    }
  list.push_back(far);
  RodScene many{"beside a BVH of spheres", test::random_rods(random, 200, 0.3, 0.03),
                test::scattered(random, 3000, 1, 0.04, 0)};
  list.push_back(many);
  RodScene bundle{"chains of parallel rods", {}, {}};
  for (int i = 0; i < 600; ++i) {
    Rod rod;
    rod.a[0] = i % 30 * 0.06 - 0.9;
    rod.b[0] = rod.a[0] + 0.06;
    rod.a[1] = rod.b[1] = i / 30 % 5 * 0.025;
    rod.a[2] = rod.b[2] = i / 150 * 0.025;
    rod.radius = 0.01;
    bundle.rods.push_back(rod);
  }
  list.push_back(bundle);
  RodScene bonded{"bonds", test::random_rods(random, 3, 0.3, 0.03), test::scattered(random, 400, 1, 0.05, 0)};
  for (std::uint32_t i = 0; i + 1 < 400; ++i) bonded.bonds.push_back({i, i + 1, i % 2});
  list.push_back(bonded);
  bonded.motion = test::random_rods(random, 2, 0.3, 0.03);
  list.push_back(bonded);
  RodScene moving{"moving", test::random_rods(random, 100, 0.5, 0.03), test::scattered(random, 50, 1, 0.1, 0)};
  moving.motion = test::random_rods(random, 40, 0.6, 0.01);
  list.push_back(moving);
  RodScene moving_long{"moving in pieces", test::random_rods(random, 40, 2, 0.002), {}};
  moving_long.motion = test::random_rods(random, 40, 0.6, 0.0001);
  list.push_back(moving_long);
  for (std::size_t i = 0, opaque = list.size(); i < opaque; ++i) {
    RodScene& scene = list.emplace_back(list[i]);
    const kernel::SceneView view = scene.view();
    scene.opacity = test::random_opacities(random, view.sphere_count + 2 * view.rods.count);
  }
  return list;
}

/// A ray from a rod or from afar, towards a point that lies close to the surface of a rod.
template <class Packet>
void aim_at_rod(Random& random, const RodScene& scene, Packet& packet, int lane) {
  const kernel::RodArray rods = scene.view().rods;
  const auto pick = [&] { return rods[static_cast<std::size_t>(random.uniform(0, static_cast<double>(rods.count)))]; };
  const auto near = [&](const Rod& rod, double(&base)[3], double(&offset)[3], double height) {
    const double place = std::min(std::max(random.uniform(-0.2, 1.2), 0.0), 1.0);
    double out[3] = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    test::normalize(out);
    for (int k = 0; k < 3; ++k) {
      base[k] = rod.a[k] + (rod.b[k] - rod.a[k]) * place;
      offset[k] = out[k] * rod.radius * height;
    }
  };
  double base[3], offset[3], to[3], at[3], direction[3];
  near(pick(), base, offset, 1);
  near(pick(), to, at, random.coin() ? 1 : random.uniform(0, 1.1));
  for (int k = 0; k < 3; ++k) direction[k] = (to[k] - base[k]) + (at[k] - offset[k]);
  test::normalize(direction);
  if (!std::isfinite(direction[0])) direction[0] = 1, direction[1] = direction[2] = 0;
  if (random.coin()) {
    for (int k = 0; k < 3; ++k) {
      base[k] = to[k] + at[k] - direction[k] * scene.camera_distance;
      offset[k] = 0;
    }
  }
  test::set_ray(packet, lane, base, offset, direction, kCamera);
}

template <class T>
void compare_hits(const RodScene& scene, kernel::Precision precision, const test::Way& way) {
  const kernel::SceneView view = scene.view();
  const RodScene rods = scene.without_bonds();
  const auto list = make_list(rods.view(), precision), other = way.make(view, precision);
  Random random;
  long rod_hits = 0, different = 0, rays = 0;
  for (; rays < 10000; rays += kPacketSize) {
    kernel::RayPacket<double> drawn;
    drawn.count = kPacketSize;
    for (int lane = 0; lane < kPacketSize; ++lane) {
      aim_at_rod(random, scene, drawn, lane);
      drawn.time[lane] = random.uniform(0, 1);
      drawn.threshold[lane] = static_cast<float>(random.uniform(0, 1));
    }
    kernel::RayPacket<T> a;
    test::copy_rays(drawn, a);
    for (int lane = 0; lane < kPacketSize; ++lane) {
      a.distance[lane] = std::numeric_limits<T>::max();
      a.hit[lane] = kNone;
    }
    kernel::RayPacket<T> b = a;
    kernel::trace(list->tracer(), a);
    kernel::trace(other->tracer(way.traversal), b);
    for (int lane = 0; lane < kPacketSize; ++lane) {
      rod_hits += view.rods.contains(a.hit[lane]);
      different += a.hit[lane] != b.hit[lane] || a.distance[lane] != b.distance[lane];
    }
  }
  EXPECT_EQ(different, 0) << scene.name << (scene.opacity.empty() ? ", " : ", opacities, ") << way.name
                          << (sizeof(T) == 4 ? ", fast" : "");
  EXPECT_GT(rod_hits, rays / (scene.opacity.empty() ? 50 : 100)) << scene.name;
}

TEST(AccelRods, EmbreeAndListFindTheSameHits) {
  for (const RodScene& scene : rod_scenes())
    for (const test::Way& way : test::kWaysBesideTheList) {
      compare_hits<double>(scene, kernel::Precision::kExact, way);
      compare_hits<float>(scene, kernel::Precision::kFast, way);
    }
}

TEST(AccelRods, EmbreeAndListFindTheSameOcclusion) {
  for (const RodScene& scene : rod_scenes()) {
    const kernel::SceneView view = scene.view();
    const auto list = make_list(view, kernel::Precision::kExact);
    for (const test::Way& way : test::kWaysBesideTheList) {
      const auto other = way.make(view, kernel::Precision::kExact);
      Random random;
      long occluded = 0, different = 0, rays = 0;
      for (; rays < 3200; rays += kPacketSize) {
        kernel::RayPacket<double> aimed;
        kernel::ShadowPacket<double> a;
        for (int lane = 0; lane < kPacketSize; ++lane) {
          aim_at_rod(random, scene, aimed, lane);
          aimed.time[lane] = random.uniform(0, 1);
          aimed.threshold[lane] = static_cast<float>(random.uniform(0, 1));
          a.target[lane] = kNone;
        }
        static_cast<kernel::PacketRays<double>&>(a) = aimed;
        a.count = kPacketSize;
        for (double& distance : a.distance) distance = random.uniform(0, 2 * scene.camera_distance);
        kernel::ShadowPacket<double> b = a;
        kernel::occlude(list->tracer(), a);
        kernel::occlude(other->tracer(way.traversal), b);
        for (int lane = 0; lane < kPacketSize; ++lane) {
          occluded += a.occluded[lane] != 0;
          different += a.occluded[lane] != b.occluded[lane];
        }
      }
      EXPECT_EQ(different, 0) << scene.name << (scene.opacity.empty() ? ", " : ", opacities, ") << way.name;
      EXPECT_GT(occluded, 0) << scene.name;
      EXPECT_LT(occluded, rays) << scene.name;
    }
  }
}

/// A ray from the surface of an end, which rounding may place inside, hits neither the sphere in the same place nor the
/// rod: the sphere, with the smaller id, is the surface that the ray leaves.
TEST(AccelRods, SpheresWinTies) {
  RodScene scene{"", {}, {{0.3, 0.7, -0.2, 0.1}}};
  Rod rod;
  rod.a[0] = rod.b[0] = 0.3;
  rod.a[1] = rod.b[1] = 0.7;
  rod.a[2] = rod.b[2] = -0.2;
  rod.radius = 0.1;
  scene.rods = {rod};
  rod.b[0] = 1.3;
  scene.rods.push_back(rod);
  const kernel::SceneView view = scene.view();
  for (const test::Way& way : test::kWays) {
    const auto accel = way.make(view, kernel::Precision::kExact);
    Random random;
    for (int i = 0; i < 1000; ++i) {
      kernel::RayPacket<double> p;
      p.count = kPacketSize;
      kernel::reset_hits(p);
      for (int lane = 0; lane < kPacketSize; ++lane) {
        double out[3] = {random.uniform(-1, -0.1), random.uniform(-1, 1), random.uniform(-1, 1)};
        test::normalize(out);
        const double base[3] = {0.3 + 5 * out[0], 0.7 + 5 * out[1], -0.2 + 5 * out[2]};
        const double direction[3] = {-out[0], -out[1], -out[2]};
        test::set_ray(p, lane, base, {0, 0, 0}, direction, kCamera);
      }
      kernel::trace(accel->tracer(way.traversal), p);
      for (const auto hit : p.hit) ASSERT_EQ(hit, 0u) << way.name;
    }
  }
}

/// Its frame would otherwise be that of the ground, and the padding of the boxes larger than the rods.
TEST(AccelRods, AGroundIsAnOutlier) {
  Random random;
  RodScene scene{"", test::random_rods(random, 100, 0.3, 0.03), {{0, -1001, 0, 1000}}};
  EXPECT_EQ(find_outliers(scene.view()), (std::vector<std::uint32_t>{0}));
  scene.spheres[0] = {0, 0, 0, 1};
  EXPECT_TRUE(find_outliers(scene.view()).empty());
}

TEST(AccelRods, ShortRodsAreStaticAndFillTheirSphere) {
  RodScene scene{"", {}, {}};
  for (const double length : {1.0, 1.0, 30.0, 3.0}) {
    Rod rod;
    rod.b[0] = length;
    rod.radius = length == 3.0 ? 0.001 : 0.1;
    scene.rods.push_back(rod);
  }
  scene.motion.resize(1);  // the first one moves
  const kernel::SceneView view = scene.view();
  EXPECT_FALSE(is_short(view, 0, 10));
  EXPECT_TRUE(is_short(view, 1, 10));
  EXPECT_FALSE(is_short(view, 2, 10)) << "larger than the limit";
  EXPECT_FALSE(is_short(view, 3, 10)) << "its sphere is nearly empty";
  EXPECT_EQ(short_rods(view, 10), 1u);
  EXPECT_EQ(short_rods(view, 20), 2u);
  EXPECT_EQ(short_rods(view, 0), 0u);
}

}  // namespace
}  // namespace orrery::accel
