// SPDX-License-Identifier: Apache-2.0
#include "load/read_keys.h"

#include <gtest/gtest.h>

#include "scene/texture.h"
#include "support/scene_files.h"

namespace orrery::load {
namespace {

using support::SceneFiles;

std::vector<std::string> names_of(const scene::Scene& scene) {
  std::vector<std::string> names;
  for (const scene::Material& m : scene.materials) names.push_back(m.name);
  return names;
}
using Names = std::vector<std::string>;

TEST(LoadReadMaterials, AreInTheOrderOfTheFile) {
  SceneFiles files;
  EXPECT_EQ(names_of(files
                         .read("[material]\nz = { type = \"dielectric\" }\na = { type = \"dielectric\" }\n"
                               "[material.m]\ntype = \"dielectric\"\n")
                         .scene),
            (Names{"z", "a", "m"}));
}

// Points files have material indices: an override must not change those of the file.
TEST(LoadReadMaterials, OverridesDoNotChangeTheIndicesOfTheFile) {
  SceneFiles files;
  const std::string text = "\n\n[material.z]\ntype = \"dielectric\"\n[material.a]\ntype = \"dielectric\"\n";
  EXPECT_EQ(names_of(files.read(text, {"material.b={type=\"dielectric\"}", "material.a.ior=2"}).scene),
            (Names{"z", "a", "b"}));
}

TEST(LoadReadMaterials, AKeyOfAnotherTypeNamesThatType) {
  SceneFiles files;
  EXPECT_EQ(
      files.diagnostics("[material.a]\ntype = \"lambertian\"\nalbedo = [1, 1, 1]\nfuzz = 0.5\n[material.b]\n"
                        "type = \"dielectric\"\nalbedo = [1, 1, 1]\n"),
      "scene.toml:4:1: error: unknown key `fuzz` in material.a of type lambertian; `fuzz` belongs to metal, "
      "dielectric, plastic\n"
      "    fuzz = 0.5\n"
      "    ^~~~\n"
      "scene.toml:7:1: error: unknown key `albedo` in material.b of type dielectric; `albedo` belongs to lambertian, "
      "hemisphere, metal, plastic\n"
      "    albedo = [1, 1, 1]\n"
      "    ^~~~~~\n");
}

TEST(LoadReadMaterials, WithoutATypeKeysAreCheckedAgainstAllTypes) {
  SceneFiles files;
  EXPECT_EQ(files.diagnostics("[material.a]\nalbedo = [1, 1, 1]\nfuz = 0.5\n"),
            "scene.toml:1:1: error: material.a needs `type`; one of lambertian, hemisphere, metal, dielectric, "
            "emitter, plastic\n"
            "    [material.a]\n"
            "    ^~~~~~~~~~~~\n"
            "scene.toml:3:1: error: unknown key `fuz` in material.a; did you mean `fuzz`?\n"
            "    fuz = 0.5\n"
            "    ^~~\n");
}

TEST(LoadReadMaterials, RangesOfValuesAreChecked) {
  SceneFiles files;
  EXPECT_EQ(files.diagnostics("[material]\na = { type = \"metal\", albedo = [1, 1.5, 1], fuzz = 2 }\n"),
            "scene.toml:2:36: error: material.a.albedo[1] is 1.5; must be in 0..1\n"
            "    a = { type = \"metal\", albedo = [1, 1.5, 1], fuzz = 2 }\n"
            "                                       ^~~\n"
            "scene.toml:2:52: error: material.a.fuzz is 2; must be in 0..1\n"
            "    a = { type = \"metal\", albedo = [1, 1.5, 1], fuzz = 2 }\n"
            "                                                       ^\n");
}

TEST(LoadReadMaterials, AMaterialThatIsNotATableIsReportedOnce) {
  SceneFiles files;
  EXPECT_EQ(files.diagnostics("[material]\na = 3\n[[sphere]]\ncenter = [0,0,0]\nradius = 1\nmaterial = \"a\"\n"),
            "scene.toml:2:5: error: material.a must be a table; write [material.a]\n"
            "    a = 3\n"
            "        ^\n");
}

TEST(LoadReadMaterials, AcceptsAnyNameAndUnusedMaterials) {
  SceneFiles files;
  EXPECT_EQ(
      names_of(files.read("[material.\"dark gold\"]\ntype = \"dielectric\"\n[material.\"\"]\ntype = \"dielectric\"\n")
                   .scene),
      (Names{"dark gold", ""}));
}

const scene::Texture& albedo_texture(const scene::Scene& scene) {
  return *std::get<scene::Lambertian>(scene.materials.at(0).model).albedo_texture;
}

TEST(LoadReadMaterials, TexturesHaveTheirKeys) {
  SceneFiles files;
  const scene::Scene checker =
      files
          .read(
              "[material.a]\ntype = \"lambertian\"\nalbedo = { texture = \"checker\", scale = 0.5, "
              "even = [0.1, 0.2, 0.3], odd = [1, 0, 1] }\n")
          .scene;
  EXPECT_EQ(albedo_texture(checker).type, scene::TextureType::kChecker);
  EXPECT_EQ(albedo_texture(checker).scale, 0.5);
  EXPECT_EQ(albedo_texture(checker).low, (math::Vec3d{0.1, 0.2, 0.3}));
  EXPECT_EQ(albedo_texture(checker).high, (math::Vec3d{1, 0, 1}));
  const scene::Scene image = files
                                 .read(
                                     "[material.a.albedo]\ntexture = \"image\"\nfile = \"p.####.png\"\nrotation = 90\n"
                                     "[material.a]\ntype = \"lambertian\"\n")
                                 .scene;
  EXPECT_EQ(albedo_texture(image).file, "p.0001.png");
  EXPECT_EQ(albedo_texture(image).rotation, 90);
  const scene::Scene fuzz = files
                                .read(
                                    "[material.a]\ntype = \"metal\"\nalbedo = [1, 1, 1]\n"
                                    "fuzz = { texture = \"marble\", low = 0.1, high = 0.4, seed = 7 }\n")
                                .scene;
  const scene::Texture& marble = *std::get<scene::Metal>(fuzz.materials[0].model).fuzz_texture;
  EXPECT_EQ(marble.low, (math::Vec3d{0.1, 0.1, 0.1}));
  EXPECT_EQ(marble.seed, 7u);
}

TEST(LoadReadMaterials, AnOverrideChangesOrReplacesATexture) {
  SceneFiles files;
  const std::string text = "[material.a]\ntype = \"lambertian\"\nalbedo = { texture = \"noise\", scale = 4 }\n";
  EXPECT_EQ(albedo_texture(files.read(text, {"material.a.albedo.scale=8"}).scene).scale, 8);
  const scene::Scene plain = files.read(text, {"material.a.albedo=[1, 0, 0]"}).scene;
  EXPECT_EQ(std::get<scene::Lambertian>(plain.materials[0].model).albedo_texture, nullptr);
}

TEST(LoadReadMaterials, MistakesInTexturesAreReportedOnce) {
  SceneFiles files;
  const std::string line = "albedo = { texture = \"checker\", scale = -1, evn = [0, 0, 0], odd = 0.5 }\n";
  EXPECT_EQ(files.diagnostics("[material.a]\ntype = \"lambertian\"\n" + line),
            "scene.toml:3:10: error: material.a.albedo needs `even`\n    " + line +
                "             ^~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~~\n"
                "scene.toml:3:41: error: material.a.albedo.scale is -1; must be in 1e-18..1e+18\n    " +
                line +
                "                                            ^~\n"
                "scene.toml:3:45: error: unknown key `evn` in material.a.albedo; did you mean `even`?\n    " +
                line +
                "                                                ^~~\n"
                "scene.toml:3:68: error: material.a.albedo.odd must be three numbers like [0, 1, 0], not a "
                "floating-point number\n    " +
                line + "                                                                       ^~~\n");
  EXPECT_EQ(files.diagnostics("[material.a]\ntype = \"lambertian\"\nalbedo = { scale = 1 }\n"),
            "scene.toml:3:10: error: material.a.albedo needs `texture`; one of checker, noise, turbulence, marble, "
            "image\n"
            "    albedo = { scale = 1 }\n"
            "             ^~~~~~~~~~~~~\n");
}

}  // namespace
}  // namespace orrery::load
