// SPDX-License-Identifier: Apache-2.0
// Compares Embree with the list, ray by ray: the same sphere and the same bits of distance.
#include "accel/accel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "base/error.h"
#include "kernel/isa.h"
#include "math/scalar.h"
#include "support/accel_rays.h"
#include "support/accelerators.h"
#include "support/comparison.h"
#include "support/intersect_batch.h"

namespace orrery::accel {
namespace {

using kernel::kCamera;
using kernel::kNone;
using kernel::kPacketsInFlight;
using kernel::kPacketSize;
using kernel::Sphere;
using test::aim;
using test::kWaysBesideTheList;
using test::normalize;
using test::Random;
using test::scattered;
using test::Scene;
using test::scenes;
using test::step_back;
using test::Way;

long ray_count() {
  const char* wanted = std::getenv("ORRERY_ACCEL_RAYS");
  return wanted != nullptr ? static_cast<long>(std::atof(wanted)) : 1'000'000;
}

/// Counts over rays traced by the list and by another accelerator.
struct Differences {
  long rays = 0, hits = 0, lost = 0, different = 0;
};

/// `motion`   of the first spheres
Differences differences(const Scene& scene, const Way& way, long ray_count, const std::vector<Sphere>& motion = {}) {
  const std::vector<std::uint32_t> materials(scene.spheres.size(), 0);
  kernel::SceneView view;
  view.spheres = scene.spheres.data();
  view.object_materials = materials.data();
  view.sphere_count = scene.spheres.size();
  view.motion = motion.data();
  view.moving_count = motion.size();
  const auto list = make_list(view, kernel::Precision::kExact), other = way.make(view, kernel::Precision::kExact);
  Random random;
  Differences found;
  for (int count = 1; found.rays < ray_count; count = count % kPacketsInFlight + 1) {
    kernel::RayPacket<double> a[kPacketsInFlight], b[kPacketsInFlight];
    for (int p = 0; p < count; ++p) {
      a[p].count = p == 1 ? kPacketSize - 5 : kPacketSize;  // one is not full
      for (int lane = 0; lane < kPacketSize; ++lane) {
        aim(random, scene, a[p], lane);
        // Distant and near origins in one packet are advanced by different lengths.
        if (random.uniform(0, 1) < 0.05) step_back(random, scene, a[p], lane);
        if (motion.empty()) continue;
        a[p].time[lane] = random.uniform(0, 1);
        if (a[p].self[lane] < motion.size()) a[p].self[lane] = kCamera;  // it starts where the sphere was
      }
      reset_hits(a[p]);
      b[p] = a[p];
    }
    kernel::trace(list->tracer(), a, count);
    kernel::trace(other->tracer(way.traversal), b, count);
    for (int p = 0; p < count; ++p) {
      found.rays += a[p].count;
      for (int lane = 0; lane < kPacketSize; ++lane) {
        const bool hit = a[p].hit[lane] != kNone;
        found.hits += hit;
        found.lost += hit && b[p].hit[lane] == kNone;
        found.different += a[p].hit[lane] != b[p].hit[lane] || (hit && a[p].distance[lane] != b[p].distance[lane]);
      }
    }
  }
  return found;
}

/// Packet and single-ray traversal of Embree's BVH and of a SphereBvh, and the SIMD list, on every available
/// instruction set. Each instance reports the instruction set it was compiled for.
TEST(AccelAccel, EmbreeAndListFindTheSameHits) {
  const std::vector<std::string> isas = kernel::available_isas();
  const std::vector<Scene> all = scenes();
  const long parts = static_cast<long>(all.size() * isas.size() * std::size(kWaysBesideTheList));
  for (const std::string& isa : isas) {
    ASSERT_TRUE(kernel::limit_isa(isa));
    for (const Way& way : kWaysBesideTheList) {
      kernel::SceneView view;
      view.spheres = all[0].spheres.data();
      view.sphere_count = 1;
      for (const auto precision : {kernel::Precision::kExact, kernel::Precision::kFast}) {
        EXPECT_EQ(kernel::isa_name(way.make(view, precision)->tracer().target), isa) << way.name;
        EXPECT_EQ(kernel::isa_name(make_list(view, precision)->tracer().target), isa);
      }
    }
    for (const Scene& scene : all)
      for (const Way& way : kWaysBesideTheList) {
        const Differences found = differences(scene, way, ray_count() / parts);
        EXPECT_EQ(found.different, 0) << scene.name << ", " << isa << ", " << way.name << ": " << found.lost
                                      << " lost of " << found.hits << " hits";
        EXPECT_GT(found.hits, found.rays / 10) << scene.name;
      }
  }
  kernel::limit_isa("");
}

/// Most spheres move by about their radius, a few across the scene; some grow, and some rest.
TEST(AccelAccel, EmbreeAndListFindTheSameMovingSpheres) {
  const std::vector<Scene> all = scenes();
  for (const std::size_t index : {std::size_t{1}, std::size_t{8}, std::size_t{9}}) {
    const Scene& scene = all[index];
    Random random;
    for (const bool is_uniform : {false, true}) {
      std::vector<Sphere> motion;
      for (std::size_t i = 0; i < scene.spheres.size() * 3 / 4; ++i) {
        const double most = is_uniform ? 0.3 : scene.spheres[i].radius * (i % 50 == 7 ? 40 : 1);
        motion.push_back({random.uniform(-most, most), random.uniform(-most, most), random.uniform(-most, most),
                          is_uniform ? 0 : scene.spheres[i].radius * random.uniform(-0.5, 0.5)});
        if (is_uniform) motion.back() = {most, most / 2, -most, 0};
      }
      for (const Way& way : kWaysBesideTheList) {
        const Differences found = differences(scene, way, 4000, motion);
        EXPECT_EQ(found.different, 0) << scene.name << ", " << way.name << ": " << found.lost << " lost";
        EXPECT_GT(found.hits, found.rays / 10) << scene.name;
      }
    }
  }
}

/// Spheres in single precision, as compile::SphereStore keeps them, with individual radii or radii from a palette.
struct Compact {
  std::vector<Sphere> plain;  ///< the same numbers, all as they are
  std::vector<float> centers, radii;
  std::vector<std::uint8_t> indices;
  std::vector<double> palette;

  /// `begin`   number of spheres that remain unchanged
  Compact(const std::vector<Sphere>& spheres, std::size_t begin, bool has_palette) : plain(spheres) {
    for (Sphere& s : plain)
      for (double* x : {&s.x, &s.y, &s.z}) *x = math::in_single_precision(*x);
    for (std::size_t i = begin; i < plain.size(); ++i) {
      Sphere& s = plain[i];
      for (const double x : {s.x, s.y, s.z}) centers.push_back(static_cast<float>(x));
      if (has_palette) {
        if (palette.size() < 200) palette.push_back(s.radius);
        indices.push_back(static_cast<std::uint8_t>((i - begin) % 200));
        s.radius = palette[indices.back()];
      } else {
        radii.push_back(static_cast<float>(s.radius));
        s.radius = static_cast<double>(radii.back());
      }
    }
    centers.push_back(0);
  }
  kernel::SphereArray array() const {
    kernel::SphereArray a(plain.data());
    a.plain_count = plain.size() - centers.size() / 3;
    a.centers = centers.data();
    a.radii = radii.empty() ? nullptr : radii.data();
    a.radius_indices = indices.data();
    a.radius_palette = palette.data();
    return a;
  }
};

TEST(AccelAccel, CompactSpheresAreHitAsPlainOnes) {
  for (const Scene& scene : scenes())
    for (int way_and_kind = 0; way_and_kind < 2 * static_cast<int>(std::size(kWaysBesideTheList)); ++way_and_kind) {
      const Way& way = kWaysBesideTheList[way_and_kind / 2];
      const Compact spheres(scene.spheres, scene.spheres.size() / 3, way_and_kind % 2 != 0);
      kernel::SceneView plain;
      plain.spheres = spheres.plain.data();
      plain.sphere_count = spheres.plain.size();
      kernel::SceneView compact = plain;
      compact.spheres = spheres.array();
      const auto list = make_list(plain, kernel::Precision::kExact),
                 other = way.make(compact, kernel::Precision::kExact);
      const Scene rounded{scene.name, spheres.plain, scene.camera_distance};
      Random random;
      int different = 0;
      for (int i = 0; i < 200; ++i) {
        kernel::RayPacket<double> a;
        a.count = kPacketSize;
        for (int lane = 0; lane < kPacketSize; ++lane) aim(random, rounded, a, lane);
        reset_hits(a);
        kernel::RayPacket<double> b = a;
        kernel::trace(list->tracer(), a);
        kernel::trace(other->tracer(way.traversal), b);
        for (int lane = 0; lane < kPacketSize; ++lane)
          different += a.hit[lane] != b.hit[lane] || (a.hit[lane] != kNone && a.distance[lane] != b.distance[lane]);
      }
      EXPECT_EQ(different, 0) << scene.name << ", " << way.name;
    }
}

TEST(AccelAccel, NativePointsFindTheSameSpheres) {
  const Scene cloud = scenes()[1];
  kernel::SceneView view;
  view.spheres = cloud.spheres.data();
  view.sphere_count = cloud.spheres.size();
  const auto points = make_native_points(view), embree = make_embree(view, kernel::Precision::kFast);
  Random random;
  int hits = 0, different = 0;
  for (int i = 0; i < 1000; ++i) {
    kernel::RayPacket<float> a{};
    a.count = kPacketSize;
    for (int lane = 0; lane < kPacketSize; ++lane) {
      a.origin[2][lane] = 5;
      double direction[3] = {random.uniform(-1, 1), random.uniform(-1, 1), -5};
      normalize(direction);
      for (int axis = 0; axis < 3; ++axis) a.direction[axis][lane] = static_cast<float>(direction[axis]);
      a.inverse_square[lane] = 1;
      a.self[lane] = kCamera;
      a.distance[lane] = std::numeric_limits<float>::max();
      a.hit[lane] = kNone;
    }
    kernel::RayPacket<float> b = a;
    kernel::trace(points->tracer(), a);
    kernel::trace(embree->tracer(), b);
    for (int lane = 0; lane < kPacketSize; ++lane) {
      hits += b.hit[lane] != kNone;
      different += a.hit[lane] != b.hit[lane];
    }
  }
  EXPECT_GT(hits, 4000);
  EXPECT_LT(different, hits / 1000) << "hits may differ at silhouettes only";
}

TEST(AccelAccel, TangentHitsCountAndTheRayOriginDoesNot) {
  const std::vector<Sphere> spheres = {{0, 1, 0, 1}};
  kernel::SceneView view;
  view.spheres = spheres.data();
  view.sphere_count = 1;
  const auto list = make_list(view, kernel::Precision::kExact);
  kernel::RayPacket<double> p;
  p.count = 2;
  test::set_ray(p, 0, {0, 0, 5}, {0, 0, 0}, {0, 0, -1}, kCamera);  // tangent at the world origin
  test::set_ray(p, 1, {0, 2, 0}, {0, 0, 0}, {0, 1, 0}, kCamera);   // starts on the surface, pointing outward
  for (int lane = 0; lane < 2; ++lane) {
    p.distance[lane] = std::numeric_limits<double>::max();
    p.hit[lane] = kNone;
  }
  kernel::trace(list->tracer(), p);
  EXPECT_EQ(p.hit[0], 0u);
  EXPECT_EQ(p.distance[0], 5);
  EXPECT_EQ(p.hit[1], std::uint64_t{kNone});
}

}  // namespace
}  // namespace orrery::accel
