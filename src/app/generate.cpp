// SPDX-License-Identifier: Apache-2.0
#include "app/generate.h"

#include <cmath>
#include <random>

#include "base/error.h"

namespace orrery::app {
namespace {

using math::Vec3d;

/// Uniform numbers by our own conversion: the standard's distributions differ between libraries.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  Vec3d color(double low, double high) {
    const double r = between(low, high), g = between(low, high), b = between(low, high);
    return {r, g, b};
  }

 private:
  std::mt19937_64 engine_;
};

void check(bool good, const char* message) {
  if (!good) throw base::Error(base::ErrorKind::kUsage, message);
}

void add(scene::Scene& scene, const std::string& name, const scene::MaterialModel& model, Vec3d center, double radius) {
  scene.materials.push_back({name, model});
  scene.spheres.push_back({center, radius, static_cast<std::uint32_t>(scene.materials.size() - 1), name});
}

/// Three decimals are as good as sixteen, and a person can read them.
double rounded(double x) { return std::round(x * 1000) / 1000; }
Vec3d rounded(Vec3d v) { return {rounded(v.x), rounded(v.y), rounded(v.z)}; }

void add_small_sphere(scene::Scene& scene, Random& random, int a, int b) {
  const double choice = random.unit();
  const double x = a + 0.9 * random.unit(), z = b + 0.9 * random.unit();
  const Vec3d center = rounded(Vec3d{x, 0.2, z});
  // Always the same throws for a cell, so that leaving one out does not change the others.
  const Vec3d first = random.color(0, 1), second = random.color(0, 1);
  const double fuzz = rounded(random.between(0, 0.5));
  if (math::length(center - Vec3d{4, 0.2, 0}) <= 0.9) return;
  const std::string name = "small_" + std::to_string(a) + "_" + std::to_string(b);
  if (choice < 0.8) {
    add(scene, name, scene::Lambertian{rounded(first * second)}, center, 0.2);
  } else if (choice < 0.95) {
    add(scene, name, scene::Metal{rounded(Vec3d{0.5, 0.5, 0.5} + first * 0.5), fuzz}, center, 0.2);
  } else {
    add(scene, name, scene::Dielectric{}, center, 0.2);
  }
}

}  // namespace

scene::Scene make_final_scene(const FinalScene& options) {
  check(options.grid >= 0 && options.grid <= 1000, "--grid must be 0..1000");
  scene::Scene scene;
  scene.camera.look_from = {13, 2, 3};
  scene.camera.look_at = {0, 0, 0};
  scene.camera.vfov = 20;
  scene.camera.defocus_angle = 0.6;
  scene.camera.focus_distance = 10;
  scene.render.samples = 500;
  Random random(options.seed);
  add(scene, "ground", scene::Lambertian{}, {0, -1000, 0}, 1000);
  for (int a = -options.grid; a < options.grid; ++a)
    for (int b = -options.grid; b < options.grid; ++b) add_small_sphere(scene, random, a, b);
  add(scene, "large_glass", scene::Dielectric{}, {0, 1, 0}, 1);
  add(scene, "large_diffuse", scene::Lambertian{{0.4, 0.2, 0.1}}, {-4, 1, 0}, 1);
  add(scene, "large_mirror", scene::Metal{{0.7, 0.6, 0.5}, 0}, {4, 1, 0}, 1);
  return scene;
}

scene::Scene make_cloud(const Cloud& options, const std::filesystem::path& points_file) {
  check(options.count >= 1 && options.count <= 100'000'000, "--count must be 1..100000000");
  scene::Scene scene;
  scene.camera.look_from = {0, 1.2, 4.2};
  scene.camera.look_at = {0, 0, 0};
  scene.camera.vfov = 35;
  scene.materials = {{"ground", scene::Lambertian{{0.5, 0.5, 0.5}}},  {"clay", scene::Lambertian{{0.75, 0.35, 0.2}}},
                     {"slate", scene::Lambertian{{0.2, 0.3, 0.45}}},  {"chalk", scene::Lambertian{{0.8, 0.78, 0.7}}},
                     {"brass", scene::Metal{{0.8, 0.65, 0.35}, 0.15}}, {"glass", scene::Dielectric{}}};
  scene.spheres.push_back({{0, -101.1, 0}, 100, 0, "ground"});
  Random random(options.seed);
  scene::Points points;
  points.file = points_file;
  points.material = 1;
  const auto count = static_cast<std::size_t>(options.count);
  points.centers.reserve(count);
  points.radii.reserve(count);
  points.materials.reserve(count);
  // A tenth of the ball's volume is filled, whatever the count.
  const double radius = std::cbrt(0.1 / static_cast<double>(options.count));
  while (points.centers.size() < count) {
    const Vec3d at{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    if (math::dot(at, at) > 1) continue;
    const double kind = random.unit();
    points.centers.push_back(at);
    points.radii.push_back(radius * random.between(0.6, 1.2));
    points.materials.push_back(kind < 0.35 ? 1u : kind < 0.65 ? 2u : kind < 0.85 ? 3u : kind < 0.95 ? 4u : 5u);
  }
  scene.points.push_back(std::move(points));
  return scene;
}

}  // namespace orrery::app
