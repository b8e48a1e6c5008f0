// SPDX-License-Identifier: Apache-2.0
#include "scene/coincident.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace orrery::scene {
namespace {

struct PlaceOfSphere {
  Vec3d center;
  double radius;
  friend bool operator==(const PlaceOfSphere&, const PlaceOfSphere&) = default;
};

struct PlaceHash {
  std::size_t operator()(const PlaceOfSphere& p) const {
    std::uint64_t h = 0x9E3779B97F4A7C15u;
    for (const double x : {p.center.x, p.center.y, p.center.z, p.radius}) {
      h = (h ^ std::bit_cast<std::uint64_t>(x + 0.0)) * 0xD6E8FEB86659FD93u;  // + 0.0: -0 is 0
      h ^= h >> 32;
    }
    return static_cast<std::size_t>(h);
  }
};

/// Calls `visit(place)` for every sphere of the scene, always in the same order.
template <class Visit>
void for_each_sphere(const Scene& scene, Visit visit) {
  for (const Sphere& s : scene.spheres) visit(PlaceOfSphere{s.center, std::abs(s.radius)});
  for (const Points& p : scene.points)
    for (std::size_t i = 0; i < p.centers.size(); ++i) visit(PlaceOfSphere{p.centers[i], std::abs(p.radii[i])});
}

/// The key of the sphere that is visited as the `index`-th.
std::string key_of(const Scene& scene, std::size_t index) {
  if (index < scene.spheres.size()) return "sphere[" + std::to_string(index) + "]";
  index -= scene.spheres.size();
  std::size_t p = 0;
  while (index >= scene.points[p].centers.size()) index -= scene.points[p++].centers.size();
  return "points[" + std::to_string(p) + "][" + std::to_string(index) + "]";
}

}  // namespace

Coincidents coincident_spheres(const Scene& scene, std::size_t most_told) {
  std::size_t count = scene.spheres.size();
  for (const Points& p : scene.points) count += p.centers.size();
  // A table of ten million places would be the largest thing in memory; their hashes are enough to find the few that
  // can be alike.
  std::vector<std::size_t> hashes;
  hashes.reserve(count);
  for_each_sphere(scene, [&](const PlaceOfSphere& place) { hashes.push_back(PlaceHash{}(place)); });
  std::vector<std::size_t> sorted = hashes;
  std::sort(sorted.begin(), sorted.end());
  Coincidents out;
  if (std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end()) return out;

  std::unordered_map<PlaceOfSphere, std::size_t, PlaceHash> first;
  std::size_t index = 0;
  for_each_sphere(scene, [&](const PlaceOfSphere& place) {
    const std::size_t own = index++;
    const auto [begin, end] = std::equal_range(sorted.begin(), sorted.end(), hashes[own]);
    if (end - begin < 2) return;
    const auto [found, is_first] = first.try_emplace(place, own);
    if (is_first) return;
    if (++out.count <= most_told) out.told.push_back({key_of(scene, own), key_of(scene, found->second)});
  });
  return out;
}

}  // namespace orrery::scene
