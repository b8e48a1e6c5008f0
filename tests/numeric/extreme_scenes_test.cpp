// SPDX-License-Identifier: Apache-2.0
// Extreme scenes: no bad samples, the same bits with Embree and the list, and exactly 1 in a white furnace.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "math/vec3.h"
#include "render/render.h"
#include "render/result.h"
#include "render/settings.h"
#include "scene/scene.h"

namespace orrery::test {
namespace {

struct ExtremeScene {
  std::string name;
  scene::Scene scene;
  bool absorbs = false;  ///< paths may be absorbed although every material is white
};

/// A white, a glass and a mirror sphere under a white sky.
scene::Scene furnace() {
  scene::Scene s;
  s.image = {24, 16};
  s.camera.look_from = {0, 0.5, 4};
  s.camera.look_at = {0, 0, 0};
  s.camera.vfov = 60;
  s.background.bottom = s.background.top = {1, 1, 1};
  s.render.samples = 8;
  s.render.max_depth = 10000;
  s.materials = {{"white", scene::Lambertian{{1, 1, 1}}},
                 {"glass", scene::Dielectric{1.5, scene::Fresnel::kExact}},
                 {"mirror", scene::Metal{{1, 1, 1}, 0}}};
  s.spheres = {{{-1, 0, 0}, 0.5, 0, ""}, {{0, 0, 0}, 0.5, 1, ""}, {{1, 0, 0}, 0.5, 2, ""}};
  return s;
}

scene::Scene with_ground(double radius) {
  scene::Scene s = furnace();
  s.spheres.push_back({{0, -0.5 - radius, 0}, radius, 0, ""});
  return s;
}

scene::Scene with_glass(double ior, scene::Fresnel fresnel) {
  scene::Scene s = furnace();
  s.materials[1].model = scene::Dielectric{ior, fresnel};
  return s;
}

std::vector<ExtremeScene> extreme_scenes() {
  std::vector<ExtremeScene> list;
  for (const double radius : {1e3, 1e5, 1e7, 1e9})
    list.push_back({"ground " + std::to_string(radius), with_ground(radius)});
  for (const double ior : {1e-3, 0.5, 1.0, 1.5, 10.0, 1e3}) {
    list.push_back({"exact Fresnel, ior " + std::to_string(ior), with_glass(ior, scene::Fresnel::kExact)});
    list.push_back({"Schlick, ior " + std::to_string(ior), with_glass(ior, scene::Fresnel::kSchlick)});
  }
  for (const double gap : {0.0, 1e-15, 1e-13, 1e-10}) {
    scene::Scene s = furnace();
    for (int i = 0; i < 3; ++i) s.spheres[static_cast<std::size_t>(i)].center.x = (i - 1) * (1 + gap);
    list.push_back({"touching, gap " + std::to_string(gap), s});
  }
  {
    scene::Scene s = furnace();
    for (int i = 0; i < 10; ++i) s.spheres.push_back({{0, 0, 0}, 0.45 - 0.04 * i, 1, ""});
    list.push_back({"ten glasses in a glass", s});
    for (std::size_t i = 3; i < s.spheres.size(); i += 2) s.spheres[i].radius *= -1;
    list.push_back({"shells in shells", s});
  }
  for (const double angle : {0.0, 1.0, 179.0}) {
    scene::Scene s = furnace();
    s.camera.defocus_angle = angle;
    list.push_back({"defocus " + std::to_string(angle), s});
  }
  for (const double vfov : {1e-6, 179.999}) {
    scene::Scene s = furnace();
    s.camera.vfov = vfov;
    list.push_back({"vfov " + std::to_string(vfov), s});
  }
  {
    scene::Scene s = furnace();
    s.camera.look_from = {0, 0.1, 0};
    s.camera.look_at = {0, 0, -1};
    list.push_back({"camera inside glass", s});
    s.camera.look_from = {-1, 0, 0.25};
    s.camera.look_at = {0, 0, 0};
    s.spheres[0] = {{-1, 0, 0}, 0.5, 1, ""};
    list.push_back({"camera inside glass, beside others", s});
    s.camera.look_from = {-0.5, 0, 0};
    // A ray that starts in glass at its surface beyond the critical angle is totally reflected for ever.
    list.push_back({"camera on a surface", s, true});
  }
  for (const double offset : {1e6, 1e9}) {
    scene::Scene s = with_ground(100);
    s.camera.look_from = s.camera.look_from + math::Vec3d{offset, 0, -offset};
    s.camera.look_at = s.camera.look_at + math::Vec3d{offset, 0, -offset};
    for (scene::Sphere& sphere : s.spheres) sphere.center = sphere.center + math::Vec3d{offset, 0, -offset};
    list.push_back({"offset " + std::to_string(offset), s});
  }
  for (const double fuzz : {0.0, 1.0}) {
    scene::Scene s = furnace();
    s.materials[2].model = scene::Metal{{1, 1, 1}, fuzz};
    list.push_back({"fuzz " + std::to_string(fuzz), s, fuzz > 0});
  }
  {
    scene::Scene s = furnace();
    s.camera.look_from = {0, 0, 1e12};
    s.camera.vfov = 1e-10;
    list.push_back({"seen from 1e12", s});
  }
  return list;
}

render::Result rendered(scene::Scene s, scene::Accelerator accelerator) {
  s.render.accelerator = accelerator;
  return render::render(compile::compile(s), {});
}

TEST(ExtremeScenes, NoBadSamplesNoAcceleratorDifferenceNoEnergyLoss) {
  for (const ExtremeScene& extreme : extreme_scenes()) {
    const render::Result embree = rendered(extreme.scene, scene::Accelerator::kEmbree);
    const render::Result list = rendered(extreme.scene, scene::Accelerator::kList);
    EXPECT_EQ(embree.statistics.bad_samples, 0u) << extreme.name;
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(embree.picture.planes[c].values, list.picture.planes[c].values) << extreme.name;
      if (extreme.absorbs) continue;
      int wrong = 0;
      for (const float value : embree.picture.planes[c].values) wrong += value != 1.0f;
      EXPECT_EQ(wrong, 0) << extreme.name;
    }
  }
}

/// An interface between equal indices of refraction changes nothing but the length of a ray.
TEST(ExtremeScenes, GlassOfIndexOneIsInvisible) {
  scene::Scene s = furnace();
  s.background.top = {0.5, 0.7, 1};
  s.spheres = {{{0, 0, 0}, 1, 1, ""}};
  s.materials[1].model = scene::Dielectric{1, scene::Fresnel::kExact};
  const auto with = rendered(s, scene::Accelerator::kEmbree);
  s.spheres.clear();
  const auto without = rendered(s, scene::Accelerator::kEmbree);
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < with.picture.planes[c].values.size(); ++i)
      EXPECT_FLOAT_EQ(with.picture.planes[c].values[i], without.picture.planes[c].values[i]);
}

/// A self-intersection of a convex grey sphere would halve a sample once more. There is none at any radius.
TEST(ExtremeScenes, GreySphereNeverHitsItself) {
  const char* wanted = std::getenv("ORRERY_FURNACE_RAYS");
  const double rays = wanted != nullptr ? std::atof(wanted) : 1e7;
  const std::vector<double> radii = {1e-12, 1e-6, 1e-3, 1, 1e3, 1e6, 1e9, 1e12};
  for (const double radius : radii) {
    scene::Scene s;
    s.image = {100, 100};
    s.camera.look_from = {2 * radius, 1.5 * radius, 3 * radius};
    s.camera.look_at = {0, 0, 0};
    s.camera.vfov = 20;
    s.background.bottom = s.background.top = {1, 1, 1};
    s.render.samples = std::max(1, static_cast<int>(rays / static_cast<double>(radii.size()) / 1e4));
    s.materials = {{"grey", scene::Lambertian{{0.5, 0.5, 0.5}}}};
    s.spheres = {{{0, 0, 0}, radius, 0, ""}};
    const render::Result result = rendered(s, scene::Accelerator::kEmbree);
    EXPECT_EQ(result.statistics.rays, 2 * result.statistics.paths) << radius;
    for (const float value : result.picture.planes[0].values) ASSERT_EQ(value, 0.5f) << radius;
  }
}

TEST(ExtremeScenes, MillionCoincidentSpheresRender) {
  scene::Scene s = furnace();
  s.image = {4, 4};
  s.render.samples = 1;
  s.spheres.assign(1'000'000, {{0, 0, 0}, 1, 0, ""});
  const render::Result result = rendered(s, scene::Accelerator::kEmbree);
  EXPECT_EQ(result.statistics.bad_samples, 0u);
  for (const float value : result.picture.planes[0].values) EXPECT_EQ(value, 1.0f);
}

}  // namespace
}  // namespace orrery::test
