// SPDX-License-Identifier: Apache-2.0
#include "compile/material_table.h"

#include <gtest/gtest.h>

#include "compile/compile.h"
#include "compile/compiled_scene.h"

namespace orrery::compile {
namespace {

TEST(CompileMaterialTable, NumbersMaterialsOnFirstUse) {
  scene::Scene s;
  s.materials = {{"unused", scene::Metal{}}, {"grey", scene::Lambertian{}}, {"glass", scene::Dielectric{}}};
  std::vector<MaterialSource> sources;
  MaterialTable table(s, sources);
  EXPECT_EQ(table.index(2, false), 0u);
  EXPECT_EQ(table.index(1, false), 1u);
  EXPECT_EQ(table.index(2, true), 2u) << "turned inside out";
  EXPECT_EQ(table.index(1, true), 1u) << "both sides are equal";
  EXPECT_EQ(table.index(2, false), 0u);
  ASSERT_EQ(sources.size(), 3u);
  EXPECT_EQ(sources[1].material, 1u);
  EXPECT_TRUE(sources[2].inside_out);
}

/// Three points of each material: two of the first colour of a palette, one of the second.
scene::Points colored_points(std::uint32_t material) {
  scene::Points points;
  points.material = material;
  points.centers = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  points.radii = {1, 1, 1};
  points.palette = {{0.25, 0.5, 1}, {1, 0, 0}};
  points.colors = {0, 1, 0};
  return points;
}

void expect_color(const double (&rgb)[3], math::Vec3d expected) {
  EXPECT_EQ(rgb[0], expected.x);
  EXPECT_EQ(rgb[1], expected.y);
  EXPECT_EQ(rgb[2], expected.z);
}

TEST(CompileMaterialTable, APaletteReplacesTheColorOfTheMaterial) {
  scene::Scene s;
  s.materials = {{"matte", scene::Lambertian{{0.1, 0.2, 0.3}}}, {"metal", scene::Metal{{0.1, 0.2, 0.3}, 0.25}}};
  s.spheres = {{{5, 0, 0}, 1, 0, ""}};
  s.points = {colored_points(0), colored_points(1)};
  s.points[1].palette[0] = {0, 1, 0};
  const CompiledScene compiled = compile(s);
  const auto material = [&](std::size_t sphere) { return compiled.materials.at(compiled.object_materials[sphere]); };
  expect_color(material(0).albedo, {0.1, 0.2, 0.3});
  expect_color(material(1).albedo, {0.25, 0.5, 1});
  expect_color(material(2).albedo, {1, 0, 0});
  EXPECT_EQ(compiled.object_materials[3], compiled.object_materials[1]) << "a colour is one material";
  expect_color(material(4).albedo, {0, 1, 0});
  EXPECT_EQ(material(4).kind, kernel::MaterialKind::kMetal);
  EXPECT_EQ(material(4).fuzz, 0.25) << "what is not colour is the material's";
  EXPECT_NE(compiled.object_materials[5], compiled.object_materials[2]) << "another material with the same colour";
}

TEST(CompileMaterialTable, APaletteTintsEmitters) {
  scene::Scene s;
  s.materials = {{"lamp", scene::Emitter{{10, 20, 30}}}};
  s.points = {colored_points(0)};
  const CompiledScene compiled = compile(s);
  expect_color(compiled.emission.at(compiled.object_materials[0]).radiance, {2.5, 10, 30});
  expect_color(compiled.emission.at(compiled.object_materials[1]).radiance, {10, 0, 0});
}

TEST(CompileMaterialTable, GlassHasNoColor) {
  scene::Scene s;
  s.materials = {{"glass", scene::Dielectric{1.5, scene::Fresnel::kExact}}};
  s.points = {colored_points(0)};
  s.points[0].radii.set(1, -1);
  const CompiledScene compiled = compile(s);
  EXPECT_EQ(compiled.materials.size(), 2u) << "outward and inward";
  EXPECT_EQ(compiled.object_materials[0], compiled.object_materials[2]);
  EXPECT_EQ(compiled.materials.at(compiled.object_materials[1]).eta[0], 1.5);
}

}  // namespace
}  // namespace orrery::compile
