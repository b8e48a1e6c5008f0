// SPDX-License-Identifier: Apache-2.0
#include "scene/validate.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <unordered_map>

#include "scene/limits.h"
#include "scene/schema.h"

namespace orrery::scene {
namespace {

/// Findings of one kind that are told one by one before only their number is told.
constexpr std::size_t kMostTold = 10;

class Problems {
 public:
  void add(base::Severity severity, std::string key, std::string text) {
    std::size_t& told = severity == base::Severity::kError ? errors_ : warnings_;
    if (++told <= kMostTold || key.rfind("points", 0) != 0) list_.push_back({severity, std::move(key), std::move(text)});
  }
  std::vector<Problem> take(const std::string& rest_key) {
    for (const auto& [count, severity] : {std::pair{errors_, base::Severity::kError}, {warnings_, base::Severity::kWarning}}) {
      const auto shown = static_cast<std::size_t>(
          std::count_if(list_.begin(), list_.end(), [s = severity](const Problem& p) { return p.severity == s; }));
      if (count > shown)
        list_.push_back({severity, rest_key, "and " + std::to_string(count - shown) + " more of this kind (" +
                                                 std::to_string(count) + " in all)"});
    }
    return std::move(list_);
  }

 private:
  std::vector<Problem> list_;
  std::size_t errors_ = 0, warnings_ = 0;
};

/// What is wrong with a radius by itself; empty where nothing is.
std::string radius_fault(double radius) {
  if (!std::isfinite(radius)) return "radius is not finite";
  if (radius == 0) return "radius is 0; allowed is " + number_text(kSmallestRadius) + ".." + number_text(kLargestLength) +
                          ", or the same below 0 for an inward normal";
  if (std::abs(radius) < kSmallestRadius || std::abs(radius) > kLargestLength)
    return "radius " + number_text(radius) + " is outside of " + number_text(kSmallestRadius) + ".." +
           number_text(kLargestLength);
  return {};
}

void check_camera(const Camera& camera, Problems& problems) {
  if (camera.look_from == camera.look_at) {
    problems.add(base::Severity::kError, "camera.look_at",
                 "look_at is the same point as look_from, so the camera has no direction");
    return;
  }
  if (camera.up == Vec3d{0, 0, 0}) {
    problems.add(base::Severity::kError, "camera.up", "up is zero; any direction that is not the view's will do");
    return;
  }
  // Compared as unit vectors: the sine of the angle between them, whatever their lengths.
  const Vec3d view = math::normalized(camera.look_at - camera.look_from), up = math::normalized(camera.up);
  constexpr double kSmallestSine = 1e-9;  // below this the picture's roll would be rounding
  if (math::length(math::cross(view, up)) < kSmallestSine)
    problems.add(base::Severity::kError, "camera.up",
                 "up is parallel to the view, so the picture has no upright; choose another direction");
}

struct PlaceHash {
  static std::uint64_t bits(double x) {
    x += 0.0;  // -0 is 0
    std::uint64_t b;
    std::memcpy(&b, &x, sizeof(b));
    return b;
  }
  std::size_t operator()(const std::pair<Vec3d, double>& p) const {
    std::uint64_t h = 0x9E3779B97F4A7C15u;
    for (const double x : {p.first.x, p.first.y, p.first.z, p.second}) h = (h ^ bits(x)) * 0xD6E8FEB86659FD93u, h ^= h >> 32;
    return static_cast<std::size_t>(h);
  }
};

/// Calls `visit(key, name, center, radius)` for every sphere of the scene.
template <class Visit>
void for_each_sphere(const Scene& scene, Visit visit) {
  for (std::size_t i = 0; i < scene.spheres.size(); ++i)
    visit([i] { return "sphere[" + std::to_string(i) + "]"; }, scene.spheres[i].center, scene.spheres[i].radius);
  for (std::size_t p = 0; p < scene.points.size(); ++p)
    for (std::size_t i = 0; i < scene.points[p].centers.size(); ++i)
      visit([p, i] { return "points[" + std::to_string(p) + "][" + std::to_string(i) + "]"; }, scene.points[p].centers[i],
            scene.points[p].radii[i]);
}

bool in_domain(Vec3d c) {
  return std::abs(c.x) <= kLargestLength && std::abs(c.y) <= kLargestLength && std::abs(c.z) <= kLargestLength;
}

void check_spheres(const Scene& scene, Problems& problems) {
  for_each_sphere(scene, [&](auto key, Vec3d center, double radius) {
    if (!in_domain(center))
      problems.add(base::Severity::kError, key() + ".center",
                   "center " + vector_text(center) + " is not finite or beyond " + number_text(kLargestLength));
    if (const std::string fault = radius_fault(radius); !fault.empty())
      problems.add(base::Severity::kError, key() + ".radius", fault);
  });
}

/// Two surfaces in exactly the same place: which of them a ray meets is decided by their order alone.
void check_coincident(const Scene& scene, Problems& problems) {
  std::size_t count = scene.spheres.size();
  for (const Points& p : scene.points) count += p.centers.size();
  std::unordered_map<std::pair<Vec3d, double>, std::string, PlaceHash> seen;
  // Ten million names would be the largest thing in memory; hashes of places are enough to find candidates.
  std::vector<std::uint64_t> hashes;
  hashes.reserve(count);
  const PlaceHash hash;
  for_each_sphere(scene, [&](auto, Vec3d c, double r) { hashes.push_back(hash({c, std::abs(r)})); });
  std::vector<std::uint64_t> sorted = hashes;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end()) return;
  std::size_t index = 0;
  for_each_sphere(scene, [&](auto key, Vec3d c, double r) {
    const auto range = std::equal_range(sorted.begin(), sorted.end(), hashes[index++]);
    if (range.second - range.first < 2) return;
    const auto [at, inserted] = seen.try_emplace({c, std::abs(r)}, key());
    if (!inserted)
      problems.add(base::Severity::kWarning, key(),
                   "has exactly the same place and size as " + at->second + "; rays meet the first of them only");
  });
}

}  // namespace

std::vector<Problem> validate(const Scene& scene) {
  Problems problems;
  check_camera(scene.camera, problems);
  check_spheres(scene, problems);
  check_coincident(scene, problems);
  return problems.take(scene.points.empty() ? "sphere" : "points");
}

}  // namespace orrery::scene
