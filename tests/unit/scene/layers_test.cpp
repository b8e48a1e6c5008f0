// SPDX-License-Identifier: Apache-2.0
#include "scene/layers.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "scene/diagnostic.h"
#include "scene/validate.h"
#include "support/mentions.h"

namespace orrery::scene {
namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// "key: text" of the first diagnostic of a scene with one sphere.
std::string problem_of(Scene scene) {
  if (scene.materials.empty()) scene.materials.resize(1);
  scene.spheres.resize(1);
  const std::vector<SceneDiagnostic> diagnostics = validate(scene);
  return diagnostics.empty() ? "" : diagnostics[0].key + ": " + diagnostics[0].text;
}

TEST(SceneLayers, RadianceLayersRequirePathShading) {
  Scene s;
  s.output.layers = {"N", "diffuse"};
  EXPECT_EQ(problem_of(s), "");
  s.render.shading = Shading::kNormal;
  EXPECT_TRUE(test::mentions(problem_of(s), {"output.layers[1]", "requires", "render.shading = \"path\""}));
  s.output.layers = {"N", "variance"};
  EXPECT_EQ(problem_of(s), "");
}

TEST(SceneLayers, ObjectIdsMustBeExactInAFloat) {
  Scene s;
  s.points.resize(1);
  s.points[0].centers.resize((std::size_t{1} << 24) - 1);
  EXPECT_EQ(layer_fault(s, "object_id"), "");
  s.rods.resize(1);
  EXPECT_TRUE(test::mentions(layer_fault(s, "object_id"), {"represent", "16777216", "CryptoObject"}));
  EXPECT_FALSE(contains(available_layers(s), "object_id"));
}

TEST(SceneLayers, AllSelectsEveryAvailableLayer) {
  Scene s;
  s.output.layers = {"all"};
  EXPECT_EQ(requested_layers(s),
            (std::vector<std::string>{"Z", "depth", "N", "P", "albedo", "diffuse", "specular", "transmission",
                                      "background", "variance", "samples", "object_id", "material_id", "denoise.albedo",
                                      "denoise.normal", "CryptoObject", "CryptoMaterial"}));
  EXPECT_TRUE(contains(available_layers(s), "halves"));
  s.output.layers = {"all", "halves"};
  EXPECT_TRUE(contains(requested_layers(s), "halves")) << "a layer for denoising, which must be named";
  s.spheres.resize(1);
  EXPECT_FALSE(contains(available_layers(s), "CryptoGroup"));
  const auto expect_group = [](auto member) {
    Scene grouped;
    (grouped.*member).resize(1);
    (grouped.*member)[0].group = "a";
    EXPECT_TRUE(contains(available_layers(grouped), "CryptoGroup"));
  };
  expect_group(&Scene::spheres);
  expect_group(&Scene::points);
  expect_group(&Scene::rods);
  expect_group(&Scene::rod_files);
  Scene moving;
  moving.animation.turntable = 24;
  EXPECT_TRUE(contains(available_layers(moving), "Vector"));
  moving.animation.turntable = 0;
  moving.tracks.resize(1);
  EXPECT_TRUE(contains(available_layers(moving), "Vector"));
  s.render.shading = Shading::kFlat;
  EXPECT_FALSE(contains(requested_layers(s), "diffuse"));
  EXPECT_EQ(problem_of(s), "") << "layers that the scene cannot have are left out";
}

TEST(SceneLayers, AllIncludesTheLayersOfLightsThatTheSceneHas) {
  Scene s;
  s.output.layers = {"all"};
  s.materials = {{"lamp", Emitter{}}};
  EXPECT_TRUE(contains(requested_layers(s), "emission"));
  EXPECT_FALSE(contains(requested_layers(s), "light_groups")) << "the default group is the beauty";
  std::get<Emitter>(s.materials[0].model).light_group = "default";
  EXPECT_FALSE(contains(requested_layers(s), "light_groups"));
  std::get<Emitter>(s.materials[0].model).light_group = "key";
  EXPECT_TRUE(contains(requested_layers(s), "light_groups"));
  s.materials.clear();
  s.background.light_group = "sky";
  EXPECT_FALSE(contains(requested_layers(s), "light_groups")) << "a gradient belongs to the default group";
  s.background.type = BackgroundType::kImage;
  EXPECT_TRUE(contains(requested_layers(s), "light_groups"));
  EXPECT_FALSE(contains(requested_layers(s), "emission"));
  s.render.shading = Shading::kFlat;
  EXPECT_FALSE(contains(requested_layers(s), "light_groups"));
}

TEST(SceneLayers, LightGroupsHaveNamesOfLayers) {
  for (const char* good : {"", "default", "key", "Key_2", "_", "diffuse_direct_2", "emissions", "direct"})
    EXPECT_EQ(light_group_fault(good), "") << good;
  for (const char* bad : {"key.left", "key-left", "a b", "2nd", "caf\xc3\xa9"})
    EXPECT_NE(light_group_fault(bad).find("must consist of letters, digits and underscores"), std::string::npos) << bad;
  for (const char* taken : {"Z", "N", "variance", "diffuse", "diffuse_direct", "emission", "denoise", "CryptoObject",
                            "CryptoLight", "rgba", "R", "all", "light_groups"})
    EXPECT_TRUE(test::mentions(light_group_fault(taken), {"another", "different"})) << taken;
  EXPECT_TRUE(test::mentions(light_group_fault("key_emission"), {"\"_emission\"", "another", "different"}));
  EXPECT_EQ(light_group_fault(std::string(231, 'a')), "");
  EXPECT_TRUE(test::mentions(light_group_fault(std::string(232, 'a')), {"232", "characters", "231"}));
}

TEST(SceneLayers, LightGroupsAreValidated) {
  Scene s;
  s.materials = {{"lamp", Emitter{{1, 1, 1}, 0, "a.b"}}};
  EXPECT_TRUE(test::mentions(problem_of(s), {"material.lamp.light_group", "\"a.b\"", "underscores"}));
  s.materials.clear();
  s.background.light_group = "N";
  EXPECT_NE(problem_of(s).find("has no effect"), std::string::npos) << "a gradient has no light group";
  s.background.type = BackgroundType::kSky;
  EXPECT_TRUE(test::mentions(problem_of(s), {"background.light_group", "\"N\"", "different"}));
  s.background = {};
  for (int i = 0; i < 63; ++i) s.materials.push_back({"m", Emitter{{1, 1, 1}, 0, "g" + std::to_string(i)}});
  s.materials.push_back({"m", Emitter{{1, 1, 1}, 0, "default"}});
  EXPECT_EQ(problem_of(s), "");
  s.materials.push_back({"m", Emitter{{1, 1, 1}, 0, "h"}});
  EXPECT_TRUE(test::mentions(problem_of(s), {"material.m.light_group", "64", "default"}));
}

TEST(SceneLayers, NamesInAdditionToAllAreAdded) {
  Scene s;
  s.output.layers = {"Z", "all", "CryptoGroup"};
  EXPECT_EQ(requested_layers(s).size(), available_layers(s).size()) << "without `halves`, with CryptoGroup";
  EXPECT_EQ(requested_layers(s).back(), "CryptoGroup");
  s.output.layers = {"Z", "N"};
  EXPECT_EQ(requested_layers(s), (std::vector<std::string>{"Z", "N"}));
}

}  // namespace
}  // namespace orrery::scene
