// SPDX-License-Identifier: Apache-2.0
// Scenes and rays that are hard for an accelerator.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <random>
#include <type_traits>
#include <vector>

#include "kernel/ray_packet.h"
#include "kernel/rod.h"
#include "kernel/sphere.h"
#include "support/intersect_batch.h"

namespace orrery::test {

using kernel::kCamera;
using kernel::Sphere;

struct Random {
  std::mt19937_64 engine{11};
  double uniform(double a, double b) { return a + (b - a) * static_cast<double>(engine() >> 11) * 0x1p-53; }
  bool coin() { return (engine() & 1) != 0; }
};

struct Scene {
  const char* name;
  std::vector<Sphere> spheres;
  double camera_distance;  ///< from the first small sphere, scene units
};

inline std::vector<Sphere> scattered(Random& random, int count, double spread, double radius, double offset) {
  std::vector<Sphere> out;
  for (int i = 0; i < count; ++i)
    out.push_back({offset + random.uniform(-spread, spread), random.uniform(-spread, spread),
                   offset + random.uniform(-spread, spread), radius * random.uniform(0.1, 1)});
  return out;
}

inline std::vector<float> random_opacities(Random& random, std::size_t count) {
  constexpr float kValues[] = {0, 0.05F, 0.3F, 0.5F, 0.9F, 1};
  std::vector<float> out;
  for (std::size_t i = 0; i < count; ++i)
    out.push_back(kValues[static_cast<std::size_t>(random.uniform(0, std::size(kValues)))]);
  return out;
}

inline void normalize(double (&d)[3]) {
  const double length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  for (double& x : d) x /= length;
}

/// Rods of any direction, with coordinates in -1..1.
inline std::vector<kernel::Rod> random_rods(Random& random, int count, double length, double radius) {
  std::vector<kernel::Rod> out;
  for (int i = 0; i < count; ++i) {
    kernel::Rod rod;
    double along[3] = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    test::normalize(along);
    for (int k = 0; k < 3; ++k) {
      rod.a[k] = random.uniform(-1, 1) - along[k] * length / 2;
      rod.b[k] = rod.a[k] + along[k] * length;
    }
    rod.radius = radius * random.uniform(0.3, 1);
    out.push_back(rod);
  }
  return out;
}

inline std::vector<Scene> scenes() {
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
  for (int i = 0; i < 60; ++i)
    mixed.push_back(
        {random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5), std::exp(random.uniform(-12, 1))});
  list.push_back({"radii over five decades", mixed, 20});
  list.push_back({"three levels of a SphereBvh", scattered(random, 5000, 1, 0.05, 0), 3});
  std::vector<Sphere> crystal;
  for (int i = 0; i < 13 * 13 * 13; ++i) crystal.push_back({i % 13 * 1.0, i / 13 % 13 * 1.0, i / 169 * 1.0, 0.5});
  list.push_back({"touching, of one radius", crystal, 20});
  list.push_back({"coincident", std::vector<Sphere>(40, {1, 2, 3, 0.5}), 4});
  return list;
}

/// Copies rays to a packet of another type.
template <class To, class From>
void copy_rays(const From& from, To& to) {
  using T = std::remove_reference_t<decltype(to.distance[0])>;
  const auto copy3 = [](const auto& a, auto& b) {
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < kernel::kPacketSize; ++i) b[k][i] = static_cast<T>(a[k][i]);
  };
  copy3(from.origin, to.origin);
  copy3(from.origin_low, to.origin_low);
  copy3(from.offset, to.offset);
  copy3(from.direction, to.direction);
  for (int i = 0; i < kernel::kPacketSize; ++i) {
    to.inverse_square[i] = static_cast<T>(from.inverse_square[i]);
    to.self[i] = static_cast<std::remove_reference_t<decltype(to.self[0])>>(from.self[i]);
    to.time[i] = static_cast<T>(from.time[i]);
    to.threshold[i] = from.threshold[i];
  }
  to.count = from.count;
}

/// A ray that is tangent to a sphere at one of the six places where it touches its box, or a little inside.
inline void graze_pole(Random& random, const Scene& scene, const Sphere& s, kernel::RayPacket<double>& packet,
                       int lane) {
  const int axis = static_cast<int>(random.uniform(0, 3)), across = (axis + 1) % 3, other = (axis + 2) % 3;
  const double turn = random.coin() ? 0 : random.uniform(0, 6.28);
  double direction[3] = {0, 0, 0}, base[3] = {s.x, s.y, s.z};
  direction[across] = std::cos(turn);
  direction[other] = std::sin(turn);
  base[axis] += (random.coin() ? 1 : -1) * s.radius * (1 - std::exp(random.uniform(-30, -10)));
  for (int i = 0; i < 3; ++i) base[i] -= direction[i] * scene.camera_distance;
  set_ray(packet, lane, base, {0, 0, 0}, direction, kCamera);
}

/// Half of the rays aim at places where boxes and spheres part: poles, rims, corners of boxes.
inline void aim(Random& random, const Scene& scene, kernel::RayPacket<double>& packet, int lane) {
  const auto pick = [&] {
    return static_cast<std::size_t>(random.uniform(0, static_cast<double>(scene.spheres.size())));
  };
  const Sphere& target = scene.spheres[pick()];
  if (random.uniform(0, 1) < 0.4) return graze_pole(random, scene, target, packet, lane);
  const double center[3] = {target.x, target.y, target.z};
  double base[3], offset[3] = {0, 0, 0}, direction[3], point[3];
  std::uint64_t self = kCamera;
  if (random.coin()) {  // from a sphere
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
  set_ray(packet, lane, base, offset, direction, self);
}

/// Moves a ray's origin back along it, as far as a thousand times the camera's distance.
inline void step_back(Random& random, const Scene& scene, kernel::RayPacket<double>& packet, int lane) {
  const double by = scene.camera_distance * std::exp(random.uniform(0, 7));
  double base[3], direction[3];
  for (int i = 0; i < 3; ++i) {
    direction[i] = packet.direction[i][lane];
    base[i] = packet.origin[i][lane] - direction[i] * by;
  }
  set_ray(packet, lane, base, {0, 0, 0}, direction, kCamera);
}

}  // namespace orrery::test
