// SPDX-License-Identifier: Apache-2.0
#include "scene/layers.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "scene/validate.h"

namespace orrery::scene {
namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// "key: text" of the first diagnostic of a scene with one sphere.
std::string problem_of(Scene scene) {
  scene.materials.resize(1);
  scene.spheres.resize(1);
  const std::vector<SceneDiagnostic> diagnostics = validate(scene);
  return diagnostics.empty() ? "" : diagnostics[0].key + ": " + diagnostics[0].text;
}

TEST(SceneLayers, RadianceLayersRequirePathShading) {
  Scene s;
  s.output.layers = {"N", "diffuse"};
  EXPECT_EQ(problem_of(s), "");
  s.render.shading = Shading::kNormal;
  EXPECT_EQ(problem_of(s), "output.layers[1]: diffuse requires render.shading = \"path\"");
  s.output.layers = {"N", "variance"};
  EXPECT_EQ(problem_of(s), "");
}

TEST(SceneLayers, ObjectIdsMustBeExactInAFloat) {
  Scene s;
  s.points.resize(1);
  s.points[0].centers.resize((std::size_t{1} << 24) - 1);
  EXPECT_EQ(layer_fault(s, "object_id"), "");
  s.points[0].centers.emplace_back();
  EXPECT_EQ(layer_fault(s, "object_id"),
            "a float cannot represent the ids of 16777216 spheres exactly; use CryptoObject");
  EXPECT_FALSE(contains(available_layers(s), "object_id"));
}

TEST(SceneLayers, AllSelectsEveryAvailableLayer) {
  Scene s;
  s.output.layers = {"all"};
  EXPECT_EQ(requested_layers(s), available_layers(s));
  EXPECT_EQ(available_layers(s),
            (std::vector<std::string>{"Z", "depth", "N", "P", "albedo", "diffuse", "specular", "transmission",
                                      "background", "variance", "samples", "object_id", "material_id", "denoise.albedo",
                                      "denoise.normal", "CryptoObject", "CryptoMaterial"}));
  s.spheres.resize(1);
  s.spheres[0].group = "a";
  EXPECT_TRUE(contains(available_layers(s), "CryptoGroup"));
  s.render.shading = Shading::kFlat;
  EXPECT_FALSE(contains(requested_layers(s), "diffuse"));
  EXPECT_EQ(problem_of(s), "") << "layers that the scene cannot have are left out";
}

TEST(SceneLayers, NamesBesideAllAreAdded) {
  Scene s;
  s.output.layers = {"Z", "all", "CryptoGroup"};
  EXPECT_EQ(requested_layers(s).size(), available_layers(s).size() + 1);
  EXPECT_EQ(requested_layers(s).back(), "CryptoGroup");
  s.output.layers = {"Z", "N"};
  EXPECT_EQ(requested_layers(s), (std::vector<std::string>{"Z", "N"}));
}

}  // namespace
}  // namespace orrery::scene
