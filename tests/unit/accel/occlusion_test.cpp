// SPDX-License-Identifier: Apache-2.0
// Occlusion against the list's closest hits: a ray is occluded if and only if its closest hit is nearer than its limit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "accel/accel.h"
#include "kernel/isa.h"
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
using kernel::Precision;
using kernel::Sphere;
using test::kWays;
using test::Random;
using test::Way;

/// Makes a direction `by` times as long, and its distances that many times smaller, by a power of two: exact.
template <class Packet>
void lengthen(Packet& packet, int lane, int exponent) {
  const auto by = [&](auto value, int e) { return std::ldexp(value, e); };
  for (auto& component : packet.direction) component[lane] = by(component[lane], exponent);
  packet.inverse_square[lane] = by(packet.inverse_square[lane], -2 * exponent);
  packet.distance[lane] = by(packet.distance[lane], -exponent);
}

struct View {
  std::vector<Sphere> spheres, motion;

  kernel::SceneView get() const {
    kernel::SceneView view;
    view.spheres = spheres.data();
    view.sphere_count = spheres.size();
    view.motion = motion.data();
    view.moving_count = motion.size();
    return view;
  }
};

struct Result {
  long rays = 0, occluded = 0, different = 0;
};

/// Queries both packet types of one precision, whose number type is T. Shadow packets are traced one to four at a time.
template <class T>
void compare(const test::Scene& scene, const View& view, Precision precision, const Way& way, long rays,
             Result& found) {
  const auto list = make_list(view.get(), precision), other = way.make(view.get(), precision);
  // Without one sphere: where nothing meets it.
  View rest = view;
  const auto target = static_cast<std::uint32_t>(view.spheres.size() / 2);
  rest.spheres[target] = {1e200, 1e200, 1e200, 1e-200};
  const auto list_of_rest = make_list(rest.get(), precision);
  const bool all_coincide = view.spheres.size() > 1 && view.spheres[0].x == view.spheres[1].x;
  Random random;
  using Id = kernel::IdOf<T>;
  const auto draw = [&](kernel::ShadowPacket<T>& shadow, bool* expected) {
    kernel::RayPacket<double> drawn;
    drawn.count = 1 + static_cast<int>(random.uniform(0, kPacketSize));
    for (int lane = 0; lane < kPacketSize; ++lane) {
      test::aim(random, scene, drawn, lane);
      // Far away, floats are off by more than boxes are padded by.
      if (precision == Precision::kExact && random.uniform(0, 1) < 0.05) test::step_back(random, scene, drawn, lane);
      drawn.time[lane] = std::floor(random.uniform(0, 0x1p20)) * 0x1p-20;
      // No ray leaves its light; and those that leave a sphere do so where it is at time 0.
      if (drawn.self[lane] == target || drawn.self[lane] < view.motion.size()) drawn.self[lane] = kCamera;
    }
    const bool has_target = random.coin() && !all_coincide;
    kernel::RayPacket<T> hits;
    test::copy_rays(drawn, hits);
    reset_hits(hits);
    kernel::trace(has_target ? list_of_rest->tracer() : list->tracer(), hits);
    test::copy_rays(drawn, shadow);
    for (int lane = 0; lane < kPacketSize; ++lane) {
      const bool hit = hits.hit[lane] != kNone;
      const T at = hits.distance[lane];
      T limit = std::numeric_limits<T>::max();
      const double kind = random.uniform(0, 1);
      if (hit && kind < 0.8) {
        limit = at;  // not nearer than itself
        if (kind < 0.6) limit = std::nextafter(at, std::numeric_limits<T>::max());
        if (kind < 0.4) limit = at * static_cast<T>(random.uniform(0, 2));
      }
      expected[lane] = hit && at < limit;
      shadow.distance[lane] = limit;
      shadow.target[lane] = has_target ? target : static_cast<Id>(kNone);
      shadow.occluded[lane] = 7;
      if (limit < std::numeric_limits<T>::max()) lengthen(shadow, lane, static_cast<int>(random.uniform(-9, 9)));
    }
  };
  for (int count = 1; rays > 0; rays -= count * kPacketSize, count = count % kPacketsInFlight + 1) {
    kernel::ShadowPacket<T> shadows[kPacketsInFlight];
    bool expected[kPacketsInFlight][kPacketSize];
    for (int p = 0; p < count; ++p) draw(shadows[p], expected[p]);
    kernel::occlude(other->tracer(way.traversal), shadows, count);
    for (int p = 0; p < count; ++p)
      for (int lane = 0; lane < shadows[p].count; ++lane) {
        ++found.rays;
        found.occluded += expected[p][lane];
        const Id answer = shadows[p].occluded[lane];
        found.different += answer != (expected[p][lane] ? static_cast<Id>(~Id{0}) : Id{0});
      }
  }
}

Result compare(const test::Scene& scene, const View& view, Precision precision, const Way& way, long rays) {
  Result found;
  if (precision == Precision::kFast) {
    compare<float>(scene, view, precision, way, rays, found);
  } else {
    compare<double>(scene, view, precision, way, rays, found);
  }
  return found;
}

constexpr Precision kPrecisions[] = {Precision::kExact, Precision::kFast};

TEST(AccelOcclusion, AgreesWithTheListsClosestHits) {
  for (const std::string& isa : kernel::available_isas()) {
    ASSERT_TRUE(kernel::limit_isa(isa));
    for (const test::Scene& scene : test::scenes())
      for (const Precision precision : kPrecisions)
        for (const Way& way : kWays) {
          // In the other precisions rounding makes hits of rays that miss the sphere's box.
          const std::string name = scene.name;
          if (precision != Precision::kExact &&
              (name == "offset 1e6" || name == "seen from 1e9" || name == "a ground of radius 1e9"))
            continue;
          const Result found = compare(scene, {scene.spheres, {}}, precision, way, 3200);
          EXPECT_EQ(found.different, 0) << scene.name << ", precision " << static_cast<int>(precision) << ", " << isa
                                        << ", " << way.name << ", of " << found.rays;
          // The book's epsilon is larger than the tiny scene, and floats see nothing from 1e9.
          if (precision == Precision::kExact) {
            EXPECT_GT(found.occluded, found.rays / 20) << scene.name;
            EXPECT_LT(found.occluded, found.rays) << scene.name;
          }
        }
  }
  kernel::limit_isa("");
}

TEST(AccelOcclusion, TheBooksListAgreesWithItsClosestHits) {
  const Way& list = kWays[std::size(kWays) - 1];
  for (const test::Scene& scene : test::scenes()) {
    if (scene.name == std::string("offset 1e6")) continue;
    EXPECT_EQ(compare(scene, {scene.spheres, {}}, Precision::kBook, list, 3200).different, 0) << scene.name;
  }
}

TEST(AccelOcclusion, AgreesWithTheListsClosestHitsInMotion) {
  const test::Scene cloud = test::scenes()[1];
  for (const std::size_t moving : {std::size_t{60}, cloud.spheres.size()}) {
    View view{cloud.spheres, {}};
    Random random;
    for (std::size_t i = 0; i < moving; ++i)
      view.motion.push_back({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1),
                             view.spheres[i].radius * random.uniform(-0.5, 0.5)});
    for (const Precision precision : kPrecisions)
      for (const Way& way : kWays) {
        const Result found = compare(cloud, view, precision, way, 16000);
        EXPECT_EQ(found.different, 0) << way.name << ", precision " << static_cast<int>(precision);
        EXPECT_GT(found.occluded, found.rays / 20);
      }
  }
}

/// From a point of sphere 0 to the centre of sphere 1, at the distance 1 in lengths of the direction.
bool is_occluded(const View& view, const Way& way, const double (&normal)[3], std::uint64_t target) {
  const Sphere &from = view.spheres[0], &to = view.spheres[1];
  const double center[3] = {from.x, from.y, from.z}, light[3] = {to.x, to.y, to.z};
  double offset[3], direction[3];
  for (int k = 0; k < 3; ++k) {
    offset[k] = from.radius * normal[k];
    direction[k] = light[k] - center[k] - offset[k];
  }
  kernel::ShadowPacket<double> packet;
  packet.count = 1;
  for (int lane = 0; lane < kPacketSize; ++lane) {
    kernel::RayPacket<double> ray;
    test::set_ray(ray, lane, center, offset, direction, 0);
    if (lane > 0) continue;
    ray.count = 1;
    std::fill_n(ray.time, kPacketSize, 0.0);
    test::copy_rays(ray, packet);
  }
  packet.distance[0] = 1;
  packet.target[0] = target;
  const auto accel = way.make(view.get(), Precision::kExact);
  kernel::occlude(accel->tracer(way.traversal), packet);
  return packet.occluded[0] != 0;
}

TEST(AccelOcclusion, ASphereOccludesItselfOnlyThroughItself) {
  for (const Way& way : kWays) {
    for (const double scale : {1.0, 1e-9, 1e9}) {
      const View view{{{0, 0, 0, scale}, {0, 5 * scale, 0, scale}}, {}};
      EXPECT_FALSE(is_occluded(view, way, {0, 1, 0}, 1)) << way.name;
      EXPECT_TRUE(is_occluded(view, way, {0, -1, 0}, 1)) << way.name;
      EXPECT_TRUE(is_occluded(view, way, {0, 1, 0}, kNone)) << "the light's own surface";
    }
  }
}

TEST(AccelOcclusion, AHollowSphereOccludesWhatLiesBehindItsWall) {
  const double in = 2;  // from the inner wall of sphere 0 to a light inside, and to one outside
  for (const Way& way : kWays) {
    const View inside{{{0, 0, 0, in}, {0, 0.5, 0, 0.1}}, {}}, outside{{{0, 0, 0, in}, {0, 5, 0, 0.1}}, {}};
    EXPECT_FALSE(is_occluded(inside, way, {0, -1, 0}, 1)) << way.name;
    EXPECT_TRUE(is_occluded(outside, way, {0, -1, 0}, 1)) << way.name;
    // A shell around the light: the shadow ray hits its outer wall, then its inner one.
    View shell = inside;
    shell.spheres.push_back({0, 0.5, 0, 0.3});
    EXPECT_TRUE(is_occluded(shell, way, {0, -1, 0}, 1)) << way.name;
  }
}

TEST(AccelOcclusion, NativePointsTestTheSameSpheres) {
  const test::Scene cloud = test::scenes()[1];
  const View view{cloud.spheres, {}};
  const auto points = make_native_points(view.get()), list = make_list(view.get(), Precision::kFast);
  Random random;
  int occluded = 0, different = 0;
  for (int n = 0; n < 1000; ++n) {
    kernel::ShadowPacket<float> a{};
    a.count = kPacketSize;
    for (int lane = 0; lane < kPacketSize; ++lane) {
      a.origin[2][lane] = 5;
      double direction[3] = {random.uniform(-1, 1), random.uniform(-1, 1), -5};
      test::normalize(direction);
      for (int axis = 0; axis < 3; ++axis) a.direction[axis][lane] = static_cast<float>(direction[axis]);
      a.inverse_square[lane] = 1;
      a.self[lane] = a.target[lane] = kNone;
      a.distance[lane] = static_cast<float>(random.uniform(3, 8));
    }
    kernel::ShadowPacket<float> b = a;
    kernel::occlude(points->tracer(), a);
    kernel::occlude(list->tracer(), b);
    for (int lane = 0; lane < kPacketSize; ++lane) {
      occluded += b.occluded[lane] != 0;
      different += a.occluded[lane] != b.occluded[lane];
    }
  }
  EXPECT_GT(occluded, 4000);
  EXPECT_LT(different, occluded / 500) << "rims may differ";
}

}  // namespace
}  // namespace orrery::accel
