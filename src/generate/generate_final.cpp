// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "generate/generate.h"
#include "generate/generate_random.h"

namespace orrery::generate {
namespace {

using math::Vec3d;

constexpr double kSmallRadius = 0.2;

/// Rounds to four decimals, which makes no visible difference.
double rounded(double x) { return std::round(x * 1e4) / 1e4; }
Vec3d rounded(Vec3d v) { return {rounded(v.x), rounded(v.y), rounded(v.z)}; }

std::uint32_t add_material(scene::Scene& scene, const std::string& name, const scene::MaterialModel& model) {
  scene.materials.push_back({name, model});
  return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

/// Draws materials with the book's probabilities. All glass is one material; every other one is new.
class SmallMaterials {
 public:
  SmallMaterials(GenerateRandom& random, scene::Scene& scene, std::uint32_t glass)
      : random_(random), scene_(scene), glass_(glass) {}

  /// Returns the material index for a random number in 0..1.
  std::uint32_t next(double choice) {
    if (choice < 0.8) {
      const Vec3d a = random_.unit3(), b = random_.unit3();
      return add_numbered("diffuse", ++diffuse_, scene::Lambertian{rounded(a * b)});
    }
    if (choice < 0.95) {
      const Vec3d albedo = rounded(Vec3d{0.5, 0.5, 0.5} + 0.5 * random_.unit3());
      return add_numbered("metal", ++metal_, scene::Metal{albedo, rounded(random_.between(0, 0.5))});
    }
    return glass_;
  }

 private:
  std::uint32_t add_numbered(const char* kind, int number, const scene::MaterialModel& model) {
    char name[32];
    std::snprintf(name, sizeof(name), "%s-%03d", kind, number);
    return add_material(scene_, name, model);
  }

  GenerateRandom& random_;
  scene::Scene& scene_;
  std::uint32_t glass_;
  int diffuse_ = 0, metal_ = 0;
};

/// Calls `place(choice, center)` for every small sphere, cell by cell.
template <class Place>
void for_each_small_sphere(int grid, GenerateRandom& random, Place place) {
  constexpr Vec3d kKeepClear{4, kSmallRadius, 0};  // position of the large metal sphere
  constexpr double kClearance = 0.9;
  for (int a = -grid; a < grid; ++a) {
    for (int b = -grid; b < grid; ++b) {
      const double choice = random.unit();
      const double x = a + 0.9 * random.unit();
      const double z = b + 0.9 * random.unit();
      const Vec3d center = rounded(Vec3d{x, kSmallRadius, z});
      if (math::length(center - kKeepClear) > kClearance) place(choice, center);
    }
  }
}

/// Adds the small spheres to the scene, each with its own material.
void add_written_spheres(int grid, GenerateRandom& random, SmallMaterials& materials, scene::Scene& scene) {
  for_each_small_sphere(grid, random, [&](double choice, Vec3d center) {
    scene.spheres.push_back({center, kSmallRadius, materials.next(choice), ""});
  });
}

/// Adds the small spheres as points with materials from a random palette, which keeps the fractions of diffuse, metal
/// and glass.
void add_points(int grid, GenerateRandom& random, SmallMaterials& materials, const std::filesystem::path& file,
                scene::Scene& scene) {
  std::vector<std::uint32_t> palette;
  for (std::uint32_t i = 0; i < kFinalPaletteSize; ++i) palette.push_back(materials.next(random.unit()));
  scene::Points points;
  points.file = file;
  points.material = palette.front();
  for_each_small_sphere(grid, random, [&](double choice, Vec3d center) {
    points.centers.push_back(center);
    points.materials.push_back(palette[static_cast<std::size_t>(choice * kFinalPaletteSize)]);
  });
  points.radii.assign(points.centers.size(), kSmallRadius);
  scene.points.push_back(std::move(points));
}

void set_view(scene::Scene& scene) {
  scene.image = {1200, 675};
  scene.camera.look_from = {13, 2, 3};
  scene.camera.look_at = {0, 0, 0};
  scene.camera.vfov = 20;
  scene.camera.defocus_angle = 0.6;
  scene.camera.focus_distance = 10;
  scene.render.samples = 500;
  scene.render.max_depth = 50;
}

}  // namespace

scene::Scene make_final_scene(const FinalScene& options, const std::filesystem::path& points_file) {
  scene::Scene scene;
  set_view(scene);
  const std::uint32_t ground = add_material(scene, "ground", scene::Lambertian{{0.5, 0.5, 0.5}});
  const std::uint32_t glass = add_material(scene, "glass", scene::Dielectric{1.5, scene::Fresnel::kSchlick});
  const std::uint32_t brown = add_material(scene, "brown", scene::Lambertian{{0.4, 0.2, 0.1}});
  const std::uint32_t mirror = add_material(scene, "mirror", scene::Metal{{0.7, 0.6, 0.5}, 0});
  GenerateRandom random(options.seed);
  SmallMaterials small(random, scene, glass);

  scene.spheres.push_back({{0, -1000, 0}, 1000, ground, "ground"});
  if (options.grid <= kLargestWrittenGrid) {
    add_written_spheres(options.grid, random, small, scene);
  } else {
    add_points(options.grid, random, small, points_file, scene);
  }
  scene.spheres.push_back({{0, 1, 0}, 1, glass, "large-glass"});
  scene.spheres.push_back({{-4, 1, 0}, 1, brown, "large-brown"});
  scene.spheres.push_back({{4, 1, 0}, 1, mirror, "large-mirror"});
  return scene;
}

}  // namespace orrery::generate
