// SPDX-License-Identifier: Apache-2.0
#include "accel/sphere_classes.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <limits>

#include "accel/accel.h"
#include "accel/box_frame.h"
#include "accel/sphere_bvh.h"
#include "base/stop_point.h"
#include "kernel/isa.h"
#include "kernel/scene_view.h"

namespace orrery::accel {
namespace {

/// Maximum number of outliers: every ray tests each of them.
constexpr std::size_t kMaxOutliers = 4;

/// A sphere is an outlier if it is this many times larger than the bounds of all smaller ones, such as a ground under a
/// scene. Its box would enclose every other sphere, and its size would determine their padding.
constexpr double kOutlierRatio = 4;

/// Spheres this many times larger than the median are kept out of a SphereBvh, because they would enlarge all boxes
/// around them.
constexpr double kGiantRatio = 16;

/// A SphereBvh bounds a rod by the sphere around it. Above this many radii, the boxes of Embree's primitives are so
/// much tighter that they are faster (measured: docs/decisions/0034-rods.md).
constexpr double kLongRatio = 200;

/// Above this many radii, the sphere around the path of a moving sphere is nearly empty, while Embree's primitives
/// bound the sphere at the time of a ray. Time in the BVH over that with primitives, 20,000 spheres, before its leaves
/// knew the paths: 0.7 to 0.8 with paths of 1.5 radii, 1.0 with 2, 2.5 with 6.
constexpr double kFastRatio = 1.75;

/// A layer is this many times as wide as it is thick, in both directions.
constexpr double kLayerRatio = 10;

/// Most objects in a sample that stands for all.
constexpr std::size_t kSampleSize = 4096;

}  // namespace

double enclosing_radius(const kernel::SceneView& scene, std::size_t id) {
  if (id >= scene.moving_count) return scene.spheres[id].radius;
  return enclosing_sphere(BoundedSpheres(scene.spheres, false, scene.motion, scene.moving_count), id).radius;
}

bool is_compact(const kernel::SceneView& scene, std::size_t id, double largest) {
  const double radius = enclosing_radius(scene, id);
  return radius <= largest && (id >= scene.moving_count || radius <= kFastRatio * scene.spheres[id].radius);
}

std::vector<std::uint32_t> ordinary_spheres(const kernel::SceneView& scene,
                                            const std::vector<std::uint32_t>& outliers) {
  std::vector<std::uint32_t> without, ids;
  std::ranges::set_union(outliers, scene.duplicates, std::back_inserter(without));
  ids.reserve(scene.sphere_count);
  auto next = without.begin();
  for (std::uint32_t id = 0; id < scene.sphere_count; ++id)
    if (next != without.end() && *next == id)
      ++next;
    else
      ids.push_back(id);
  return ids;
}

std::vector<std::uint32_t> find_outliers(const kernel::SceneView& scene) {
  struct OutlierCandidate {
    double radius;
    std::uint32_t id;
  };
  std::vector<OutlierCandidate> largest;  // descending, at most one more than there can be outliers
  const base::StopPoint stop;
  for (std::uint32_t id = 0; id < scene.sphere_count; ++id) {
    stop.check(id);
    const double radius = scene.spheres[id].radius;
    if ((largest.size() > kMaxOutliers && !(radius > largest.back().radius)) || scene.is_duplicate(id)) continue;
    const auto at =
        std::find_if(largest.begin(), largest.end(), [&](const OutlierCandidate& l) { return l.radius < radius; });
    largest.insert(at, {radius, id});
    if (largest.size() > kMaxOutliers + 1) largest.pop_back();
  }
  // Take the largest set whose smallest member is an outlier relative to the rest.
  for (std::size_t n = std::min(largest.size(), kMaxOutliers); n > 0; --n) {
    // The rest has a frame at least as large as its largest sphere.
    const bool may_be =
        n == largest.size() ? !scene.rods.empty() : largest[n - 1].radius > kOutlierRatio * largest[n].radius;
    if (!may_be) continue;
    std::vector<std::uint32_t> outliers;
    for (std::size_t i = 0; i < n; ++i) outliers.push_back(largest[i].id);
    std::sort(outliers.begin(), outliers.end());
    const BoxFrame frame(scene.spheres, ordinary_spheres(scene, outliers), {scene.rods});
    if (largest[n - 1].radius * frame.scale > kOutlierRatio * frame.reach) return outliers;
  }
  return {};
}

double giant_radius(const kernel::SceneView& scene) {
  const kernel::RodArray& rods = scene.rods;
  const std::size_t spheres = scene.sphere_count, all = spheres + rods.count - rods.moving_count;
  std::vector<double> radii;
  for (std::size_t i = 0; i < all; i += all / kSampleSize + 1)
    radii.push_back(i < spheres ? enclosing_radius(scene, i)
                                : enclosing_sphere(rods[rods.moving_count + i - spheres]).radius);
  const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
  std::nth_element(radii.begin(), middle, radii.end());
  return kGiantRatio * *middle;
}

bool is_short(const kernel::SceneView& scene, std::size_t rod, double largest) {
  const kernel::RodArray& rods = scene.rods;
  return !rods.moves(rod) && enclosing_sphere(rods[rod]).radius <= std::min(largest, kLongRatio * rods[rod].radius) &&
         !scene.is_duplicate(rods.id(rod));
}

std::size_t short_rods(const kernel::SceneView& scene, double largest) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < scene.rods.count; ++i) count += is_short(scene, i, largest) ? 1 : 0;
  return count;
}

bool is_layer(const kernel::SceneView& scene) {
  if (scene.sphere_count <= scene.rods.count) return false;
  const std::size_t stride = scene.sphere_count / kSampleSize + 1;
  std::vector<double> radii;
  for (std::size_t id = 0; id < scene.sphere_count; id += stride) radii.push_back(scene.spheres[id].radius);
  const auto median = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
  std::nth_element(radii.begin(), median, radii.end());
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  double lower[3] = {kInfinite, kInfinite, kInfinite}, upper[3] = {-kInfinite, -kInfinite, -kInfinite}, extent[3];
  for (std::size_t id = 0; id < scene.sphere_count; id += stride) {
    const kernel::Sphere s = scene.spheres[id];
    if (s.radius > kGiantRatio * *median) continue;  // a ground, whose centre is far from the layer
    const double center[3] = {s.x, s.y, s.z};
    for (int k = 0; k < 3; ++k) {
      lower[k] = std::min(lower[k], center[k]);
      upper[k] = std::max(upper[k], center[k]);
    }
  }
  for (int k = 0; k < 3; ++k) extent[k] = upper[k] - lower[k];
  std::sort(extent, extent + 3);
  return kLayerRatio * extent[0] < extent[1];
}

std::size_t bvh_threshold() {
  // Measured in clouds and crystals (docs/benchmarks.md). A register of AVX-512 holds a bound of all children of a
  // node.
  return kernel::isa_name() == "avx512" ? 1000 : 100'000;
}

ObjectCounts objects_in_bvh(const kernel::SceneView& scene) {
  const std::size_t least = bvh_threshold();
  if (scene.sphere_count + scene.rods.count - scene.rods.moving_count < least) return {};
  const double limit = giant_radius(scene);
  const std::size_t rods = short_rods(scene, limit);
  std::size_t count = 0;
  double smallest = limit, largest = 0;
  for (std::size_t id = 0; id < scene.sphere_count; ++id) {
    if (!is_compact(scene, id, limit)) continue;
    const double radius = enclosing_radius(scene, id);
    ++count;
    smallest = std::min(smallest, radius);
    largest = std::max(largest, radius);
  }
  const bool fits = count + rods >= least && count + rods <= SphereBvh::kMaxSpheres;
  if (!fits || (count <= kMaxInSmallLayer && is_layer(scene))) return {};
  return {count, rods, rods == 0 && smallest == largest, scene.moving_count > 0};
}

}  // namespace orrery::accel
