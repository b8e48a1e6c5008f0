// SPDX-License-Identifier: Apache-2.0
#include "compile/textures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "compile/environment.h"
#include "scene/lat_long_map.h"
#include "scene/scene.h"
#include "scene/texture.h"

namespace orrery::compile {
namespace {

using kernel::MaterialTextures;
using math::Vec3d;

scene::Texture checker() {
  scene::Texture out;
  out.low = {0.2, 0.4, 0};
  out.high = {0.8, 0.6, 0.5};
  return out;
}
scene::TextureSlot slot(const scene::Texture& texture) { return std::make_shared<const scene::Texture>(texture); }

scene::Scene scene_with(const scene::MaterialModel& model) {
  scene::Scene s;
  s.materials = {{"plain", scene::Lambertian{}}, {"textured", model}};
  s.spheres = {{{0, 0, 0}, 1, 0}, {{3, 0, 0}, 1, 1}};
  return s;
}

TEST(CompileTextures, ScenesWithoutTexturesHaveNone) {
  const CompiledScene plain = compile(scene_with(scene::Metal{{1, 1, 1}, 0.5}));
  EXPECT_FALSE(plain.features.rich_materials);
  EXPECT_EQ(plain.view().textures, nullptr);
}

TEST(CompileTextures, ReplaceAConstantWhoseValueIsTheirMean) {
  const CompiledScene out = compile(scene_with(scene::Lambertian{{0.5, 0.5, 0.5}, slot(checker())}));
  EXPECT_TRUE(out.features.rich_materials);
  ASSERT_EQ(out.textures.textures().size(), 1u);
  const kernel::SceneView view = out.view();
  EXPECT_EQ(view.material_textures[view.object_materials[0]].albedo, kernel::kNone);
  EXPECT_EQ(view.material_textures[view.object_materials[1]].albedo, 0u);
  const kernel::Material& m = view.materials[view.object_materials[1]];
  EXPECT_DOUBLE_EQ(m.albedo[0], 0.5);
  EXPECT_DOUBLE_EQ(m.albedo[2], 0.25);
}

TEST(CompileTextures, TexturesOfUnusedMaterialsAreOmitted) {
  scene::Scene s = scene_with(scene::Lambertian{{0.5, 0.5, 0.5}, slot(checker())});
  s.spheres.pop_back();
  EXPECT_FALSE(compile(s).features.rich_materials);
}

TEST(CompileTextures, AnEmittersExposureMultipliesItsTexture) {
  scene::Emitter lamp;
  lamp.exposure = 2;
  lamp.radiance_texture = slot(checker());
  const CompiledScene out = compile(scene_with(lamp));
  EXPECT_EQ(out.textures.textures()[0].low[0], 0.8);
  EXPECT_EQ(out.textures.textures()[0].high[2], 2);
  EXPECT_EQ(out.emission[out.object_materials[1]].radiance[0], 2) << "the mean, by which lights are chosen";
  EXPECT_EQ(out.light_tree.spheres.size(), 1u);
}

TEST(CompileTextures, ColoursOfPointsReplaceAlbedoAndTintEmission) {
  scene::Emitter lamp;
  lamp.radiance_texture = slot(checker());
  for (const bool emits : {false, true}) {
    scene::Scene s = scene_with(emits ? scene::MaterialModel(lamp)
                                      : scene::MaterialModel(scene::Lambertian{{0.5, 0.5, 0.5}, slot(checker())}));
    scene::Points points;
    points.material = 1;
    points.centers = {{9, 0, 0}};
    points.radii = {1};
    points.colors = {0};
    points.palette = {{0.5, 1, 0}};
    s.points.push_back(points);
    const CompiledScene out = compile(s);
    const MaterialTextures& of = out.textures.material(out.object_materials[2]);
    EXPECT_EQ(of.albedo, kernel::kNone);
    if (!emits) {
      EXPECT_EQ(out.materials[out.object_materials[2]].albedo[1], 1);
      continue;
    }
    ASSERT_NE(of.radiance, kernel::kNone);
    EXPECT_EQ(out.textures.textures()[of.radiance].high[0], 0.4);
    EXPECT_EQ(out.textures.textures()[of.radiance].high[2], 0);
  }
}

TEST(CompileTextures, TheMeanOfAnImageIsOverTheSphere) {
  const auto image = std::make_shared<scene::LatLongMap>(1, 3);
  const float rows[3] = {0, 1, 0.5F};
  for (int y = 0; y < 3; ++y)
    for (int c = 0; c < 3; ++c) image->row(y)[c] = rows[y];
  scene::Texture texture;
  texture.type = scene::TextureType::kImage;
  texture.image = image;
  // The rows have a quarter, a half and a quarter of the sphere.
  EXPECT_NEAR(mean_of(texture).x, 0.25 * 0 + 0.5 * 1 + 0.25 * 0.5, 1e-12);
}

TEST(CompileTextures, GradientsAreUnitVectorsWithoutAPreferredDirection) {
  TextureStore store;
  store.add(checker());
  const double* g = store.textures()[0].gradients;
  Vec3d sum{};
  for (std::uint32_t i = 0; i < kernel::kGradients; ++i, g += 4) {
    EXPECT_NEAR(math::length({g[0], g[1], g[2]}), 1, 1e-15);
    sum = sum + Vec3d{g[0], g[1], g[2]};
  }
  EXPECT_LT(math::length(sum) / kernel::kGradients, 0.15);
}

TEST(CompileTextures, RoughGlassNeedsTheExtendedLoopAndClearGlassDoesNot) {
  EXPECT_FALSE(compile(scene_with(scene::Dielectric{1.5, scene::Fresnel::kSchlick})).features.rich_materials);
  EXPECT_TRUE(compile(scene_with(scene::Dielectric{1.5, scene::Fresnel::kSchlick, 0.1})).features.rich_materials);
}

}  // namespace
}  // namespace orrery::compile
