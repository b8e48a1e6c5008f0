// SPDX-License-Identifier: Apache-2.0
#include "job/layers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <set>

#include <nlohmann/json.hpp>

#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "film/cryptomatte.h"
#include "film/layer_planes.h"
#include "scene/layers.h"
#include "scene/limits.h"
#include "scene/schema.h"
#include "support/everything.h"
#include "support/mentions.h"

namespace orrery::job {
namespace {

Layers layers_of(const scene::Scene& scene) { return choose_layers(scene, compile::compile(scene)); }

scene::Scene with_layers(std::vector<std::string> layers) {
  scene::Scene s = test::everything();
  s.output.layers = std::move(layers);
  return s;
}

TEST(JobLayers, EveryNameOfTheSchemaIsALayer) {
  for (const scene::Table& table : scene::tables())
    for (const auto& key : table.keys)
      for (const std::string& name : table.name == "output" ? key.choices : std::vector<std::string>{}) {
        const Layers layers = layers_of(with_layers({name}));
        EXPECT_TRUE(layers.request.any()) << name;
        EXPECT_FALSE(film::planes_of(layers.request).empty()) << name;
      }
  EXPECT_FALSE(layers_of(with_layers({})).request.any());
}

TEST(JobLayers, ATransparentBackgroundRequestsCoverage) {
  scene::Scene s = with_layers({});
  s.background.alpha = 0;
  EXPECT_TRUE(layers_of(s).request.coverage);
}

TEST(JobLayers, ObjectsAreNamedAfterSpheresIndicesAndFiles) {
  scene::Scene s = with_layers({"CryptoObject"});
  s.spheres.resize(3);
  s.spheres[1].name = "bunny";
  s.spheres[2].name = "bunny";  // one name for two spheres
  scene::Points points;
  points.file = "cloud/dust.ply";
  points.centers.resize(2);
  points.radii = {1, 1};
  s.points = {points, points};
  s.points[1].name = "named";
  const Layers layers = layers_of(s);
  ASSERT_EQ(layers.mattes.size(), 1u);
  std::string names;
  for (const auto& [name, id] : layers.mattes[0].things) {
    names += name + " ";
    EXPECT_EQ(id, film::matte_id(name));
  }
  EXPECT_EQ(names, "sphere.0 bunny dust named ");
  const auto id_of = [&](std::uint32_t i) { return layers.request.matte_id(layers.request.mattes[0], i); };
  const char* const wanted[] = {"sphere.0", "bunny", "bunny", "dust", "dust", "named", "named"};
  for (std::uint32_t i = 0; i < 7; ++i) EXPECT_EQ(id_of(i), film::matte_id(wanted[i])) << i;
}

/// The two ids of a rod are those of its halves.
TEST(JobLayers, RodsAreObjectsWithTwoMaterials) {
  scene::Scene s = with_layers({"CryptoObject", "CryptoMaterial", "CryptoGroup"});
  s.spheres.resize(1);
  s.rods.resize(2);
  s.rods[0].materials = {0, 1};
  s.rods[0].to = {1, 0, 0};
  s.rods[1].name = "bond";
  s.rods[1].group = "bonds";
  scene::RodFile file;
  file.file = "data/melt.csv";
  file.from.resize(2);
  file.to.resize(2);
  file.radii.assign(2, 0.5);
  s.rod_files = {file};
  const Layers layers = layers_of(s);
  const auto id_of = [&](std::size_t matte, std::uint32_t i) {
    return layers.request.matte_id(layers.request.mattes[matte], i);
  };
  const std::string first = s.materials[0].name, second = s.materials[1].name;
  const std::string objects[] = {"sphere.0", "rod.0", "rod.0", "bond", "bond", "melt", "melt", "melt", "melt"};
  for (std::uint32_t i = 0; i < 9; ++i) EXPECT_EQ(id_of(0, i), film::matte_id(objects[i])) << i;
  const std::string materials[] = {s.materials[s.spheres[0].material].name, first, second, first, first};
  for (std::uint32_t i = 0; i < 5; ++i) EXPECT_EQ(id_of(1, i), film::matte_id(materials[i])) << i;
  for (std::uint32_t i = 0; i < 5; ++i) EXPECT_EQ(id_of(2, i), i < 3 ? 0 : film::matte_id("bonds")) << i;
}

/// Bonds share the name of their points, and have the materials of their spheres.
TEST(JobLayers, BondsBelongToTheirPoints) {
  scene::Scene s = with_layers({"CryptoObject", "CryptoMaterial"});
  s.spheres.clear();
  scene::Points points;
  points.file = "melt.xyz";
  points.centers = {{0, 0, 0}, {1, 0, 0}, {-1, 0, 0}};
  points.radii.assign(3, 0.25);
  points.materials = {0, 1, 1};
  points.bond_radius = 0.1;
  points.bond_pairs = {{0, 1}, {0, 2}};
  points.bond_stubs = {{1, 0, {1.5, 0, 0}}};
  s.points = {points};
  s.rods.resize(1);
  s.rods[0].materials = {1, 0};
  const Layers layers = layers_of(s);
  const auto id_of = [&](std::size_t matte, std::uint32_t i) {
    return layers.request.matte_id(layers.request.mattes[matte], i);
  };
  // Spheres, rod, stub, bonds; of bond 0-2, the end with the smaller x comes first.
  const int materials[] = {0, 1, 1, 1, 0, 1, 1, 0, 1, 1, 0};
  for (std::uint32_t i = 0; i < 11; ++i) {
    EXPECT_EQ(id_of(0, i), film::matte_id(i == 3 || i == 4 ? "rod.0" : "melt")) << i;
    EXPECT_EQ(id_of(1, i), film::matte_id(s.materials[static_cast<std::size_t>(materials[i])].name)) << i;
  }
}

/// Halves of bonds are in the objects of their spheres.
TEST(JobLayers, ColumnsDivideAFileIntoObjects) {
  scene::Scene s = with_layers({"CryptoObject"});
  s.spheres.resize(1);
  scene::Points dust;
  dust.file = "dust.ply";
  dust.centers = {{5, 0, 0}};
  dust.radii.assign(1, 0.25);
  scene::Points points;
  points.file = "1m4x.pdb";
  points.centers = {{0, 0, 0}, {1, 0, 0}, {-1, 0, 0}};
  points.radii.assign(3, 0.25);
  points.objects = {0, 1, 0, 1};  // of the spheres and the stub
  points.object_names = {".A", ".B"};
  points.bond_radius = 0.1;
  points.bond_pairs = {{0, 1}};
  points.bond_stubs = {{1, 0, {1.5, 0, 0}}};
  s.points = {dust, points};
  s.rods.clear();
  const Layers layers = layers_of(s);
  const char* const wanted[] = {"sphere.0", "dust",   "1m4x.A", "1m4x.B", "1m4x.A",
                                "1m4x.B",   "1m4x.B", "1m4x.A", "1m4x.B"};
  for (std::uint32_t i = 0; i < 9; ++i)
    EXPECT_EQ(layers.request.matte_id(layers.request.mattes[0], i), film::matte_id(wanted[i])) << i;
}

TEST(JobLayers, GroupsHoldOnlySpheresWithAGroup) {
  scene::Scene s = with_layers({"CryptoGroup"});
  s.spheres[1].group = "left";
  s.spheres[3].group = "left";
  const Layers layers = layers_of(s);
  EXPECT_EQ(layers.mattes[0].things.size(), 1u);
  EXPECT_EQ(layers.request.matte_id(layers.request.mattes[0], 0), 0u);
  EXPECT_EQ(layers.request.matte_id(layers.request.mattes[0], 1), film::matte_id("left"));
  EXPECT_EQ(layers.request.matte_id(layers.request.mattes[0], 2), 0u);
  EXPECT_EQ(layers.request.matte_id(layers.request.mattes[0], 3), film::matte_id("left"));
}

/// One sum per pixel for spheres that no matte distinguishes.
TEST(JobLayers, SpheresOfTheSameIdsShareTheirCoverage) {
  scene::Scene s = with_layers({"CryptoObject"});
  s.materials.resize(2);
  s.spheres.assign(2, {{0, 0, 0}, 1, 0, "pair"});
  scene::Points cloud;
  cloud.file = "dust.ply";
  cloud.centers.resize(1000);
  cloud.radii = {1};
  cloud.materials.resize(1000);
  for (std::size_t i = 0; i < 1000; ++i) cloud.materials[i] = i % 2;
  s.points = {cloud};
  const auto keys = [&](std::vector<std::string> names, bool deep) {
    s.output.layers = std::move(names);
    film::LayerRequest request = layers_of(s).request;
    request.deep = deep;
    std::set<std::uint32_t> out;
    for (std::uint32_t i = 0; i < 1002; ++i) out.insert(request.coverage_key(i));
    return out;
  };
  EXPECT_EQ(keys({"CryptoObject"}, false), (std::set<std::uint32_t>{0, 2}));
  EXPECT_EQ(keys({"CryptoMaterial"}, false), (std::set<std::uint32_t>{0, 3}));
  EXPECT_EQ(keys({"CryptoObject", "CryptoMaterial"}, false), (std::set<std::uint32_t>{0, 2, 3}));
  EXPECT_EQ(keys({"CryptoObject"}, true).size(), 1002u) << "deep samples are spheres";
}

TEST(JobLayers, LightGroupsAreThoseOfEmittersAndTheBackground) {
  scene::Scene s = with_layers({"light_groups"});
  s.materials[0].model = scene::Emitter{{1, 1, 1}, 0, "key"};
  s.materials[1].model = scene::Emitter{{1, 1, 1}, 0, "default"};
  s.materials[2].model = scene::Emitter{};
  s.materials.push_back({"unused", scene::Emitter{{1, 1, 1}, 0, "unused"}});
  for (std::uint32_t i = 0; i < 3; ++i) s.spheres[i].material = i;
  const auto text = [&] {
    std::string out;
    for (const film::LightGroup& g : layers_of(s).request.groups)
      out += g.name + (g.has_emitters ? " emitters" : "") + (g.has_background ? " background" : "") + ", ";
    return out;
  };
  EXPECT_TRUE(test::mentions(text(), {"emitters", "background"}));
  s.background.type = scene::BackgroundType::kSky;
  s.background.light_group = "sky";
  EXPECT_TRUE(test::mentions(text(), {"emitters", "background"}));
  s.background.light_group = "key";
  EXPECT_TRUE(test::mentions(text(), {"emitters", "background"}));
  s.output.layers = {"emission"};
  EXPECT_TRUE(layers_of(s).request.groups.empty());
}

/// The scene refuses names that collide with the lobe AOVs, whose names the film has.
TEST(JobLayers, LightGroupsAreNotNamedLikeLobes) {
  for (const char* lobe : film::kLobeNames) {
    EXPECT_NE(scene::light_group_fault(lobe), "") << lobe;
    EXPECT_NE(scene::light_group_fault(std::string("key_") + lobe), "") << lobe;
    EXPECT_LE(scene::kLongestLightGroup + 1 + std::string(lobe).size() + 2, 255u) << lobe;
  }
}

/// Inverted glass is a second material in the kernel, but not in the scene.
TEST(JobLayers, MaterialMattesUseAuthoredMaterials) {
  const Layers layers = layers_of(with_layers({"CryptoMaterial", "material_id"}));
  const scene::Scene s = test::everything();
  for (std::uint32_t i = 0; i < s.spheres.size(); ++i)
    EXPECT_EQ(layers.request.matte_id(layers.request.mattes[0], i),
              film::matte_id(s.materials[s.spheres[i].material].name))
        << i;
  const compile::CompiledScene compiled = compile::compile(s);
  for (std::size_t i = 0; i < s.spheres.size(); ++i)
    EXPECT_EQ(layers.request.material_numbers[compiled.object_materials[i]], s.spheres[i].material + 1) << i;
}

TEST(JobMatteManifest, NamesTheHashAndTheConversion) {
  const std::vector<image::Attribute> attributes = matte_attributes(
      {{"CryptoObject", {{"bunny", film::matte_id("bunny")}, {"a \"b\"", film::matte_id("a \"b\"")}}}});
  ASSERT_EQ(attributes.size(), 4u);
  EXPECT_EQ(attributes[0].name, "cryptomatte/3ae39a5/name");
  EXPECT_EQ(std::get<std::string>(attributes[0].value), "CryptoObject");
  EXPECT_EQ(attributes[1].name, "cryptomatte/3ae39a5/hash");
  EXPECT_EQ(std::get<std::string>(attributes[1].value), "MurmurHash3_32");
  EXPECT_EQ(std::get<std::string>(attributes[2].value), "uint32_to_float32");
  const auto manifest = nlohmann::json::parse(std::get<std::string>(attributes[3].value));
  EXPECT_EQ(manifest["bunny"], "13851a76");
  EXPECT_EQ(manifest.size(), 2u);
  EXPECT_TRUE(manifest.contains("a \"b\""));
}

/// CPU seconds to write a header with so many names: the minimum of three runs.
double seconds_of_header(std::size_t names) {
  MatteNames matte;
  matte.layer = "CryptoObject";
  for (std::size_t i = 0; i < names; ++i) matte.things.emplace_back("sphere number " + std::to_string(i), i);
  double least = 1e9;
  for (int i = 0; i < 3; ++i) {
    const std::clock_t begin = std::clock();
    static_cast<void>(matte_attributes({matte}));
    least = std::min(least, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  return least;
}

TEST(JobMatteManifest, TakesTimeProportionalToTheNumberOfNames) {
  // Sixteen times the names take 16 times as long, or 256 times if each name is compared with all others.
  const std::size_t few = 12'000;
  EXPECT_LT(seconds_of_header(16 * few), 80 * seconds_of_header(few));
}

TEST(JobMatteManifest, EveryMatteIsKnown) {
  scene::Scene s;
  s.materials = {{"grey", scene::Lambertian{{0.5, 0.5, 0.5}}}};
  s.spheres = {{{0, 0, -1}, 0.5, 0, ""}};
  s.spheres[0].group = "group";
  s.output.layers.assign(kMatteLayers.begin(), kMatteLayers.end());
  EXPECT_EQ(choose_layers(s, compile::compile(s)).mattes.size(), kMatteLayers.size());
  for (const std::string& name : scene::available_layers(s))
    if (name.rfind("Crypto", 0) == 0) {
      EXPECT_EQ(std::count(kMatteLayers.begin(), kMatteLayers.end(), name), 1) << name;
    }
}

}  // namespace
}  // namespace orrery::job
