// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "generate/generate.h"
#include "generate/generate_random.h"

namespace orrery::generate {
namespace {

using math::Vec3d;

/// One of the balls that form the cloud: flat below, high in the middle, tapering to the right.
struct Puff {
  Vec3d center;
  double radius;
};
constexpr std::array<Puff, 8> kPuffs{{{{-1.45, 0.00, 0.05}, 0.50},
                                      {{-0.85, 0.22, -0.10}, 0.68},
                                      {{-0.15, 0.48, 0.10}, 0.86},
                                      {{0.25, 0.05, 0.45}, 0.60},
                                      {{0.60, 0.28, -0.15}, 0.72},
                                      {{1.15, 0.05, 0.10}, 0.55},
                                      {{1.65, -0.12, -0.05}, 0.38},
                                      {{2.00, -0.20, 0.05}, 0.24}}};

/// Total cross-section of all spheres, scene units^2: about 2.5 times the silhouette of the cloud.
constexpr double kCrossSection = 12;
/// Maximum mean radius by default, so that three spheres do not merge into one ball.
constexpr double kLargestDefaultRadius = 0.3;
/// Scale of the sum of two points in the unit ball.
constexpr double kSpread = 0.65;
/// Range of a sphere's radius, relative to the mean that gives the total cross-section.
constexpr double kSmallestShare = 0.5, kLargestShare = 1.4;

double mean_radius(std::uint64_t count) {
  // Mean square of a relative radius that is uniform between the two.
  constexpr double kMeanSquare =
      (kSmallestShare * kSmallestShare + kSmallestShare * kLargestShare + kLargestShare * kLargestShare) / 3;
  const double r = std::sqrt(kCrossSection / (std::numbers::pi * kMeanSquare * static_cast<double>(count)));
  return std::min(r, kLargestDefaultRadius);
}

/// Chooses puffs in proportion to volume, so that the density is about uniform where they do not overlap.
class PuffChoice {
 public:
  PuffChoice() {
    double sum = 0;
    for (std::size_t i = 0; i < kPuffs.size(); ++i)
      up_to_[i] = sum += kPuffs[i].radius * kPuffs[i].radius * kPuffs[i].radius;
    for (double& share : up_to_) share /= sum;
  }
  const Puff& operator()(double u) const {
    const auto at = std::upper_bound(up_to_.begin(), up_to_.end() - 1, u);
    return kPuffs[static_cast<std::size_t>(at - up_to_.begin())];
  }

 private:
  std::array<double, kPuffs.size()> up_to_{};
};

/// Returns a material index, in the order of the scene's materials: mostly white, some tinted, few metal.
std::uint32_t pick_material(double u) { return u < 0.75 ? 0 : u < 0.87 ? 1 : u < 0.95 ? 2 : 3; }

}  // namespace

scene::Scene make_cloud(const Cloud& options, const std::filesystem::path& points_file) {
  scene::Scene scene;
  scene.camera.look_from = {0.3, 0.1, 9};
  scene.camera.look_at = {0.15, 0.3, 0};
  scene.camera.vfov = 20;
  // Light from above: white tops and dark undersides against a medium blue, the visible part of the sky.
  scene.background.bottom = {0, 0.05, 0.2};
  scene.background.top = {0.8, 0.95, 1.2};
  scene.materials = {{"white", scene::Lambertian{{0.95, 0.95, 0.95}}},
                     {"rose", scene::Lambertian{{0.9, 0.6, 0.55}}},
                     {"blue", scene::Lambertian{{0.3, 0.45, 0.8}}},
                     {"silver", scene::Metal{{0.9, 0.9, 0.92}, 0.1}}};

  GenerateRandom random(options.seed);
  const PuffChoice choose;
  const double mean = mean_radius(options.count);
  const auto count = static_cast<std::size_t>(options.count);
  scene::Points points;
  points.file = points_file;
  points.centers.reserve(count);
  points.radii.reserve(count);
  points.materials.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Puff& puff = choose(random.unit());
    // The density of the sum of two points falls off towards the rim; with one point, single puffs would stand out.
    const Vec3d a = random.in_ball(), b = random.in_ball();
    points.centers.push_back(puff.center + kSpread * puff.radius * (a + b));
    const double share = random.between(kSmallestShare, kLargestShare);
    points.radii.push_back(options.radius ? *options.radius : mean * share);
    points.materials.push_back(pick_material(random.unit()));
  }
  scene.points.push_back(std::move(points));
  return scene;
}

}  // namespace orrery::generate
