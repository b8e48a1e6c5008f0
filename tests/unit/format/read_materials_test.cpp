// SPDX-License-Identifier: Apache-2.0
#include "format/read_materials.h"

#include <gtest/gtest.h>

#include "support/scene_files.h"

namespace orrery::format {
namespace {

using support::SceneFiles;

std::vector<std::string> names_of(const scene::Scene& scene) {
  std::vector<std::string> names;
  for (const scene::Material& m : scene.materials) names.push_back(m.name);
  return names;
}
using Names = std::vector<std::string>;

TEST(FormatReadMaterials, AreInTheOrderOfTheFile) {
  SceneFiles files;
  EXPECT_EQ(names_of(files
                         .read("[material]\nz = { type = \"dielectric\" }\na = { type = \"dielectric\" }\n"
                               "[material.m]\ntype = \"dielectric\"\n")
                         .scene),
            (Names{"z", "a", "m"}));
}

// Points files have material indices: an override must not change those of the file.
TEST(FormatReadMaterials, OverridesDoNotChangeTheIndicesOfTheFile) {
  SceneFiles files;
  const std::string text = "\n\n[material.z]\ntype = \"dielectric\"\n[material.a]\ntype = \"dielectric\"\n";
  EXPECT_EQ(names_of(files.read(text, {"material.b={type=\"dielectric\"}", "material.a.ior=2"}).scene),
            (Names{"z", "a", "b"}));
}

TEST(FormatReadMaterials, AKeyOfAnotherTypeNamesThatType) {
  SceneFiles files;
  EXPECT_EQ(
      files.diagnostics("[material.a]\ntype = \"lambertian\"\nalbedo = [1, 1, 1]\nfuzz = 0.5\n[material.b]\n"
                        "type = \"dielectric\"\nalbedo = [1, 1, 1]\n"),
      "scene.toml:4:1: error: unknown key `fuzz` in material.a of type lambertian; `fuzz` belongs to metal\n"
      "    fuzz = 0.5\n"
      "    ^~~~\n"
      "scene.toml:7:1: error: unknown key `albedo` in material.b of type dielectric; `albedo` belongs to lambertian, "
      "hemisphere, metal\n"
      "    albedo = [1, 1, 1]\n"
      "    ^~~~~~\n");
}

TEST(FormatReadMaterials, WithoutATypeKeysAreCheckedAgainstAllTypes) {
  SceneFiles files;
  EXPECT_EQ(
      files.diagnostics("[material.a]\nalbedo = [1, 1, 1]\nfuz = 0.5\n"),
      "scene.toml:1:1: error: material.a needs `type`; one of lambertian, hemisphere, metal, dielectric, emitter\n"
      "    [material.a]\n"
      "    ^~~~~~~~~~~~\n"
      "scene.toml:3:1: error: unknown key `fuz` in material.a; did you mean `fuzz`?\n"
      "    fuz = 0.5\n"
      "    ^~~\n");
}

TEST(FormatReadMaterials, RangesOfValuesAreChecked) {
  SceneFiles files;
  EXPECT_EQ(files.diagnostics("[material]\na = { type = \"metal\", albedo = [1, 1.5, 1], fuzz = 2 }\n"),
            "scene.toml:2:36: error: material.a.albedo[1] is 1.5; must be in 0..1\n"
            "    a = { type = \"metal\", albedo = [1, 1.5, 1], fuzz = 2 }\n"
            "                                       ^~~\n"
            "scene.toml:2:52: error: material.a.fuzz is 2; must be in 0..1\n"
            "    a = { type = \"metal\", albedo = [1, 1.5, 1], fuzz = 2 }\n"
            "                                                       ^\n");
}

TEST(FormatReadMaterials, AMaterialThatIsNotATableIsReportedOnce) {
  SceneFiles files;
  EXPECT_EQ(files.diagnostics("[material]\na = 3\n[[sphere]]\ncenter = [0,0,0]\nradius = 1\nmaterial = \"a\"\n"),
            "scene.toml:2:5: error: material.a must be a table; write [material.a]\n"
            "    a = 3\n"
            "        ^\n");
}

TEST(FormatReadMaterials, AcceptsAnyNameAndUnusedMaterials) {
  SceneFiles files;
  EXPECT_EQ(
      names_of(files.read("[material.\"dark gold\"]\ntype = \"dielectric\"\n[material.\"\"]\ntype = \"dielectric\"\n")
                   .scene),
      (Names{"dark gold", ""}));
}

}  // namespace
}  // namespace orrery::format
