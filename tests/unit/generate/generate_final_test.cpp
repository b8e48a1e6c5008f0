// SPDX-License-Identifier: Apache-2.0
#include "generate/generate.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <variant>

#include "load/write_scene.h"
#include "scene/validate.h"
#include "unit/generate/expectations.h"

namespace orrery::generate {
namespace {

using math::Vec3d;

template <class Model>
std::vector<Model> small_models(const scene::Scene& s) {
  std::vector<Model> out;
  for (std::size_t i = 1; i + 3 < s.spheres.size(); ++i)
    if (const auto* model = std::get_if<Model>(&s.materials[s.spheres[i].material].model)) out.push_back(*model);
  return out;
}

TEST(GenerateFinal, TheSameSeedGivesTheSameScene) {
  EXPECT_EQ(load::scene_text(make_final_scene({}), ""), load::scene_text(make_final_scene({}), ""));
  EXPECT_NE(load::scene_text(make_final_scene({1, 11}), ""), load::scene_text(make_final_scene({2, 11}), ""));
}

TEST(GenerateFinal, HasTheBooksLargeSpheresAndCamera) {
  const scene::Scene s = make_final_scene({});
  EXPECT_EQ(s.camera.look_from, (Vec3d{13, 2, 3}));
  EXPECT_EQ(s.camera.look_at, (Vec3d{0, 0, 0}));
  EXPECT_EQ(s.camera.vfov, 20);
  EXPECT_EQ(s.camera.defocus_angle, 0.6);
  EXPECT_EQ(s.camera.focus_distance, 10);
  EXPECT_EQ(s.image.width, 1200);
  EXPECT_EQ(s.image.height, 675);
  EXPECT_EQ(s.render.samples, 500);
  EXPECT_EQ(s.render.max_depth, 50);
  const auto model = [&](const scene::Sphere& sphere) { return s.materials[sphere.material].model; };
  const auto& ground = s.spheres.front();
  EXPECT_EQ(ground.center, (Vec3d{0, -1000, 0}));
  EXPECT_EQ(ground.radius, 1000);
  EXPECT_EQ(std::get<scene::Lambertian>(model(ground)).albedo, (Vec3d{0.5, 0.5, 0.5}));
  const auto* large = &s.spheres[s.spheres.size() - 3];
  EXPECT_EQ(large[0].center, (Vec3d{0, 1, 0}));
  EXPECT_EQ(std::get<scene::Dielectric>(model(large[0])).ior, 1.5);
  EXPECT_EQ(large[1].center, (Vec3d{-4, 1, 0}));
  EXPECT_EQ(std::get<scene::Lambertian>(model(large[1])).albedo, (Vec3d{0.4, 0.2, 0.1}));
  EXPECT_EQ(large[2].center, (Vec3d{4, 1, 0}));
  EXPECT_EQ(std::get<scene::Metal>(model(large[2])).albedo, (Vec3d{0.7, 0.6, 0.5}));
  EXPECT_EQ(std::get<scene::Metal>(model(large[2])).fuzz, 0);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(large[i].radius, 1);
}

TEST(GenerateFinal, SmallSpheresAreInTheirCellsAndClearOfTheMetalSphere) {
  const scene::Scene s = make_final_scene({3, 11});
  std::set<std::pair<int, int>> cells;
  for (std::size_t i = 1; i + 3 < s.spheres.size(); ++i) {
    const scene::Sphere& sphere = s.spheres[i];
    EXPECT_EQ(sphere.radius, 0.2);
    EXPECT_EQ(sphere.center.y, 0.2);
    const double a = std::floor(sphere.center.x), b = std::floor(sphere.center.z);
    EXPECT_LE(sphere.center.x - a, 0.9 + 1e-12);
    EXPECT_LE(sphere.center.z - b, 0.9 + 1e-12);
    EXPECT_TRUE(a >= -11 && a < 11 && b >= -11 && b < 11);
    EXPECT_TRUE(cells.emplace(static_cast<int>(a), static_cast<int>(b)).second) << "two spheres in one cell";
    EXPECT_GT(math::length(sphere.center - Vec3d{4, 0.2, 0}), 0.9);
  }
  // The disc of radius 0.9 around (4, 0) overlaps four cells; no other cell may be empty.
  EXPECT_LE(cells.size(), 22u * 22u);
  EXPECT_GE(cells.size(), 22u * 22u - 4u);
  EXPECT_LT(cells.size(), 22u * 22u) << "seed 3 must leave some out for this test to mean anything";
}

TEST(GenerateFinal, SmallMaterialsHaveTheBooksProbabilities) {
  const scene::Scene s = make_final_scene({7, kLargestWrittenGrid});
  ASSERT_TRUE(s.points.empty());
  const double n = static_cast<double>(s.spheres.size()) - 4;
  const auto diffuse = small_models<scene::Lambertian>(s);
  const auto metal = small_models<scene::Metal>(s);
  const auto glass = small_models<scene::Dielectric>(s);
  const auto share = [n](const auto& models) { return static_cast<double>(models.size()) / n; };
  expect_near_mean(share(diffuse), 0.80, 0.80 * 0.20, n, "diffuse");
  expect_near_mean(share(metal), 0.15, 0.15 * 0.85, n, "metal");
  expect_near_mean(share(glass), 0.05, 0.05 * 0.95, n, "glass");

  // The product of two uniform numbers has mean 1/4 and variance 1/9 - 1/16.
  std::array<double, 3> sums{};
  for (const auto& m : diffuse) sums = {sums[0] + m.albedo.x, sums[1] + m.albedo.y, sums[2] + m.albedo.z};
  const double d = static_cast<double>(diffuse.size());
  for (const double sum : sums) expect_near_mean(sum / d, 0.25, 1.0 / 9 - 1.0 / 16, d, "diffuse albedo");

  sums = {};
  double fuzz = 0;
  for (const auto& m : metal) {
    for (const double component : {m.albedo.x, m.albedo.y, m.albedo.z}) EXPECT_TRUE(component >= 0.5 && component <= 1);
    EXPECT_TRUE(m.fuzz >= 0 && m.fuzz <= 0.5);
    sums = {sums[0] + m.albedo.x, sums[1] + m.albedo.y, sums[2] + m.albedo.z};
    fuzz += m.fuzz;
  }
  const double k = static_cast<double>(metal.size());
  for (const double sum : sums) expect_near_mean(sum / k, 0.75, 0.25 / 12, k, "metal albedo");
  expect_near_mean(fuzz / k, 0.25, 0.25 / 12, k, "fuzz");
  for (const auto& m : glass) EXPECT_EQ(m.ior, 1.5);
}

TEST(GenerateFinal, LargeGridsUsePointsWithTheSameProbabilities) {
  const scene::Scene s = make_final_scene({1, kLargestWrittenGrid + 68}, "far.ply");
  ASSERT_EQ(s.points.size(), 1u);
  EXPECT_EQ(s.points[0].file, "far.ply");
  EXPECT_EQ(s.spheres.size(), 4u);
  const auto& points = s.points[0];
  const double n = static_cast<double>(points.centers.size());
  EXPECT_NEAR(n, 200.0 * 200, 4);
  ASSERT_EQ(points.radii.size(), points.centers.size());
  ASSERT_EQ(points.materials.size(), points.centers.size());
  double glass = 0, metal = 0;
  for (const std::uint32_t m : points.materials) {
    ASSERT_LT(m, s.materials.size());
    glass += std::holds_alternative<scene::Dielectric>(s.materials[m].model);
    metal += std::holds_alternative<scene::Metal>(s.materials[m].model);
  }
  // The palette is the smaller sample, so it determines the tolerance.
  expect_near_mean(glass / n, 0.05, 0.05 * 0.95, kFinalPaletteSize, "glass");
  expect_near_mean(metal / n, 0.15, 0.15 * 0.85, kFinalPaletteSize, "metal");
  EXPECT_TRUE(scene::validate(s).empty());
}

TEST(GenerateFinal, GridZeroHasOnlyTheLargeSpheres) { EXPECT_EQ(make_final_scene({1, 0}).spheres.size(), 4u); }

}  // namespace
}  // namespace orrery::generate
