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
#include "support/intersect_batch.h"

namespace orrery::accel {
namespace {

using kernel::kNoSphere;
using kernel::kPacketSize;
using kernel::Sphere;

struct Random {
  std::mt19937_64 engine{11};
  double uniform(double a, double b) { return a + (b - a) * static_cast<double>(engine() >> 11) * 0x1p-53; }
  bool coin() { return (engine() & 1) != 0; }
};

long ray_count() {
  const char* wanted = std::getenv("ORRERY_ACCEL_RAYS");
  return wanted != nullptr ? static_cast<long>(std::atof(wanted)) : 1'000'000;
}

struct Scene {
  const char* name;
  std::vector<Sphere> spheres;
  double camera_distance;  ///< from the target sphere, scene units
};

std::vector<Sphere> scattered(Random& random, int count, double spread, double radius, double offset) {
  std::vector<Sphere> out;
  out.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i)
    out.push_back({offset + random.uniform(-spread, spread), random.uniform(-spread, spread),
                   offset + random.uniform(-spread, spread), radius * random.uniform(0.1, 1)});
  return out;
}

std::vector<Scene> scenes() {
  Random random;
  std::vector<Scene> list;
  list.push_back({"one sphere", {{0, 0, 0, 1}}, 10});
  list.push_back({"cloud", scattered(random, 200, 1, 0.2, 0), 5});
  std::vector<Sphere> book = scattered(random, 150, 8, 0.2, 0);
  book.push_back({0, -1000, 0, 1000});
  list.push_back({"a ground of radius 1000", book, 15});
  std::vector<Sphere> planet = scattered(random, 100, 2, 0.3, 0);
  planet.insert(planet.begin() + 3, {0, -1e9, 0, 1e9});
  list.push_back({"a ground of radius 1e9", planet, 6});
  list.push_back({"offset 1e6", scattered(random, 100, 3, 0.5, 1e6), 10});
  list.push_back({"tiny", scattered(random, 100, 1e-12, 2e-13, 0), 1e-11});
  list.push_back({"seen from 1e9", scattered(random, 100, 1, 0.3, 0), 1e9});
  std::vector<Sphere> mixed;
  mixed.reserve(60);
  for (int i = 0; i < 60; ++i)
    mixed.push_back(
        {random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5), std::exp(random.uniform(-12, 1))});
  list.push_back({"radii over five decades", mixed, 20});
  list.push_back({"coincident", std::vector<Sphere>(40, {1, 2, 3, 0.5}), 4});
  return list;
}

void normalize(double (&d)[3]) {
  const double length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  for (double& x : d) x /= length;
}

/// A ray tangent, or nearly so, to a sphere at one of the six points where the sphere touches its bounding box.
void graze_pole(Random& random, const Scene& scene, const Sphere& s, kernel::RayPacket& packet, int lane) {
  const int axis = static_cast<int>(random.uniform(0, 3)), across = (axis + 1) % 3, other = (axis + 2) % 3;
  const double turn = random.coin() ? 0 : random.uniform(0, 6.28);
  double direction[3] = {0, 0, 0}, base[3] = {s.x, s.y, s.z};
  direction[across] = std::cos(turn);
  direction[other] = std::sin(turn);
  base[axis] += (random.coin() ? 1 : -1) * s.radius * (1 - std::exp(random.uniform(-30, -10)));
  for (int i = 0; i < 3; ++i) base[i] -= direction[i] * scene.camera_distance;
  test::set_ray(packet, lane, base, {0, 0, 0}, direction, kNoSphere);
}

/// Aims most rays at points where boxes and spheres separate: poles, rims, corners of boxes.
void aim(Random& random, const Scene& scene, kernel::RayPacket& packet, int lane) {
  const auto pick = [&] {
    return static_cast<std::size_t>(random.uniform(0, static_cast<double>(scene.spheres.size())));
  };
  const Sphere& target = scene.spheres[pick()];
  if (random.uniform(0, 1) < 0.4) return graze_pole(random, scene, target, packet, lane);
  const double center[3] = {target.x, target.y, target.z};
  double base[3], offset[3] = {0, 0, 0}, direction[3], point[3];
  std::uint64_t self = kNoSphere;
  if (random.coin()) {  // starts on a sphere
    self = pick();
    const Sphere& s = scene.spheres[self];
    const double c[3] = {s.x, s.y, s.z};
    double n[3] = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    normalize(n);
    for (int i = 0; i < 3; ++i) {
      base[i] = c[i];
      offset[i] = n[i] * s.radius;
    }
  } else {
    double away[3] = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    normalize(away);
    for (int i = 0; i < 3; ++i) base[i] = center[i] + away[i] * scene.camera_distance;
  }
  double side[3] = {0, 0, 0};
  const double kind = random.uniform(0, 1);
  if (kind < 0.25) {  // a pole, where the sphere touches its box
    side[static_cast<int>(random.uniform(0, 3))] = random.coin() ? 1 : -1;
    for (double& x : side) x *= 1 + random.uniform(-1e-9, 1e-9);
  } else if (kind < 0.5) {  // a rim or a corner
    for (double& x : side) x = random.coin() ? 1 : -1;
    if (random.coin()) normalize(side);
  } else {
    for (double& x : side) x = random.uniform(-1, 1);
  }
  for (int i = 0; i < 3; ++i) {
    point[i] = center[i] + side[i] * target.radius;
    direction[i] = (point[i] - base[i]) - offset[i];
  }
  normalize(direction);
  if (!std::isfinite(direction[0])) direction[0] = 1, direction[1] = direction[2] = 0;
  test::set_ray(packet, lane, base, offset, direction, self);
}

/// Moves a ray's origin backwards by up to a thousand times the camera distance.
void step_back(Random& random, const Scene& scene, kernel::RayPacket& packet, int lane) {
  const double by = scene.camera_distance * std::exp(random.uniform(0, 7));
  double base[3], direction[3];
  for (int i = 0; i < 3; ++i) {
    direction[i] = packet.direction[i][lane];
    base[i] = packet.origin[i][lane] - direction[i] * by;
  }
  test::set_ray(packet, lane, base, {0, 0, 0}, direction, kNoSphere);
}

/// An accelerator and traversal whose hits must agree with the list's.
struct Way {
  const char* name;
  std::unique_ptr<Accel> (*make)(const kernel::SceneView&, kernel::Precision);
  Traversal traversal;
};
std::unique_ptr<Accel> embree(const kernel::SceneView& view, kernel::Precision precision) {
  return make_embree(view, precision);
}
constexpr Way kWays[] = {{"packet", embree, Traversal::kPacket},
                         {"single", embree, Traversal::kSingle},
                         {"SIMD list", make_simd_list, Traversal::kPacket}};

/// Counts over rays traced by the list and by another accelerator.
struct Differences {
  long rays = 0, hits = 0, lost = 0, different = 0;
};

Differences differences(const Scene& scene, const Way& way, long ray_count) {
  const std::vector<std::uint32_t> materials(scene.spheres.size(), 0);
  kernel::SceneView view;
  view.spheres = scene.spheres.data();
  view.sphere_materials = materials.data();
  view.sphere_count = scene.spheres.size();
  const auto list = make_list(view, kernel::Precision::kExact), other = way.make(view, kernel::Precision::kExact);
  other->use({way.traversal, way.traversal});
  Random random;
  Differences found;
  for (; found.rays < ray_count; found.rays += kPacketSize) {
    kernel::RayPacket a;
    a.count = kPacketSize;
    for (int lane = 0; lane < kPacketSize; ++lane) {
      aim(random, scene, a, lane);
      // Distant and near origins in one packet are advanced by different lengths.
      if (random.uniform(0, 1) < 0.05) step_back(random, scene, a, lane);
      a.distance[lane] = std::numeric_limits<double>::max();
      a.hit[lane] = kNoSphere;
    }
    kernel::RayPacket b = a;
    list->tracer().trace(list->tracer().self, a);
    other->tracer().trace(other->tracer().self, b);
    for (int lane = 0; lane < kPacketSize; ++lane) {
      const bool hit = a.hit[lane] != kNoSphere;
      found.hits += hit;
      found.lost += hit && b.hit[lane] == kNoSphere;
      found.different += a.hit[lane] != b.hit[lane] || (hit && a.distance[lane] != b.distance[lane]);
    }
  }
  return found;
}

/// Packet and single-ray BVH traversal and the SIMD list, on every available instruction set. Each instance reports the
/// instruction set it was compiled for.
TEST(AccelAccel, EmbreeAndListFindTheSameHits) {
  const std::vector<std::string> isas = kernel::available_isas();
  const std::vector<Scene> all = scenes();
  const long parts = static_cast<long>(all.size() * isas.size() * std::size(kWays));
  for (const std::string& isa : isas) {
    ASSERT_TRUE(kernel::limit_isa(isa));
    for (const Way& way : kWays) {
      kernel::SceneView view;
      view.spheres = all[0].spheres.data();
      view.sphere_count = 1;
      for (const auto precision : {kernel::Precision::kExact, kernel::Precision::kFast, kernel::Precision::kBook}) {
        EXPECT_EQ(kernel::isa_name(way.make(view, precision)->tracer().target), isa) << way.name;
        EXPECT_EQ(kernel::isa_name(make_list(view, precision)->tracer().target), isa);
      }
    }
    for (const Scene& scene : all)
      for (const Way& way : kWays) {
        const Differences found = differences(scene, way, ray_count() / parts);
        EXPECT_EQ(found.different, 0) << scene.name << ", " << isa << ", " << way.name << ": " << found.lost
                                      << " lost of " << found.hits << " hits";
        EXPECT_GT(found.hits, found.rays / 10) << scene.name;
      }
  }
  kernel::limit_isa("");
}

TEST(AccelAccel, BuildReportsProgressAndCanBeStopped) {
  Random random;
  const std::vector<Sphere> spheres = scattered(random, 200'000, 100, 0.1, 0);
  kernel::SceneView view;
  view.spheres = spheres.data();
  view.sphere_count = spheres.size();
  std::atomic<int> calls{0};
  std::atomic<bool> outside{false};
  make_embree(view, kernel::Precision::kExact, [&](double fraction) {
    ++calls;
    if (!(fraction >= 0 && fraction <= 1)) outside = true;
    return true;
  });
  EXPECT_GT(calls, 1);
  EXPECT_FALSE(outside);
  try {
    make_embree(view, kernel::Precision::kExact, [](double) { return false; });
    FAIL() << "the build was not stopped";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kStopped);
  }
}

TEST(AccelAccel, PacketsCanBePartlyFilled) {
  const std::vector<Sphere> spheres = {{0, 0, -5, 1}, {0, 0, 5, 1}};
  kernel::SceneView view;
  view.spheres = spheres.data();
  view.sphere_count = 2;
  const auto embree = make_embree(view, kernel::Precision::kExact);
  for (int count = 1; count <= kPacketSize; ++count) {
    kernel::RayPacket p;
    p.count = count;
    for (int lane = 0; lane < kPacketSize; ++lane) {
      test::set_ray(p, lane, {0, 0, 0}, {0, 0, 0}, {0, 0, -1}, kNoSphere);
      p.distance[lane] = std::numeric_limits<double>::max();
      p.hit[lane] = kNoSphere;
    }
    embree->tracer().trace(embree->tracer().self, p);
    for (int lane = 0; lane < kPacketSize; ++lane) {
      EXPECT_EQ(p.hit[lane], lane < count ? 0u : std::uint64_t{kNoSphere}) << count;
      if (lane < count) {
        EXPECT_EQ(p.distance[lane], 4);
      }
    }
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
    kernel::RayPacketFast a{};
    a.count = kPacketSize;
    for (int lane = 0; lane < kPacketSize; ++lane) {
      a.origin[2][lane] = 5;
      double direction[3] = {random.uniform(-1, 1), random.uniform(-1, 1), -5};
      normalize(direction);
      for (int axis = 0; axis < 3; ++axis) a.direction[axis][lane] = static_cast<float>(direction[axis]);
      a.inverse_square[lane] = 1;
      a.self[lane] = kNoSphere;
      a.distance[lane] = std::numeric_limits<float>::max();
      a.hit[lane] = kNoSphere;
    }
    kernel::RayPacketFast b = a;
    points->tracer().trace_fast(points->tracer().self, a);
    embree->tracer().trace_fast(embree->tracer().self, b);
    for (int lane = 0; lane < kPacketSize; ++lane) {
      hits += b.hit[lane] != kNoSphere;
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
  kernel::RayPacket p;
  p.count = 2;
  test::set_ray(p, 0, {0, 0, 5}, {0, 0, 0}, {0, 0, -1}, kNoSphere);  // tangent at the world origin
  test::set_ray(p, 1, {0, 2, 0}, {0, 0, 0}, {0, 1, 0}, kNoSphere);   // starts on the surface, pointing outward
  for (int lane = 0; lane < 2; ++lane) {
    p.distance[lane] = std::numeric_limits<double>::max();
    p.hit[lane] = kNoSphere;
  }
  list->tracer().trace(list->tracer().self, p);
  EXPECT_EQ(p.hit[0], 0u);
  EXPECT_EQ(p.distance[0], 5);
  EXPECT_EQ(p.hit[1], std::uint64_t{kNoSphere});
}

}  // namespace
}  // namespace orrery::accel
