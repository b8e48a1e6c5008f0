// SPDX-License-Identifier: Apache-2.0
#include "format/overrides.h"

#include <gtest/gtest.h>

#include "support/scene_files.h"

namespace orrery::format {
namespace {

using support::SceneFiles;

constexpr const char* kScene = R"([camera]
vfov = 20
[material.gold]
type = "metal"
albedo = [0.8, 0.6, 0.2]
[material."dark gold"]
type = "metal"
albedo = [0.4, 0.3, 0.1]
[[sphere]]
center = [0, 0, 0]
radius = 1
material = "gold"
[[sphere]]
center = [3, 0, 0]
radius = 1
material = "gold"
)";

/// First line of the message about an override.
std::string told(const std::string& override_text) {
  SceneFiles files;
  const std::string all = files.diagnostics(kScene, {override_text});
  return all.substr(0, all.find('\n'));
}

TEST(FormatOverrides, ReplaceValuesOfTheFile) {
  SceneFiles files;
  const auto scene = files
                         .read(kScene, {"camera.vfov=30", "camera.look_from=[1, 2, 3]", "material.gold.fuzz=0.25",
                                        "sphere[1].radius=-2", "material.\"dark gold\".albedo=[1,1,1]"})
                         .scene;
  EXPECT_EQ(scene.camera.vfov, 30);
  EXPECT_EQ(scene.camera.look_from, (scene::Vec3d{1, 2, 3}));
  EXPECT_EQ(std::get<scene::Metal>(scene.materials[0].model).fuzz, 0.25);
  EXPECT_EQ(std::get<scene::Metal>(scene.materials[0].model).albedo, (scene::Vec3d{0.8, 0.6, 0.2}))
      << "other keys are unchanged";
  EXPECT_EQ(scene.spheres[0].radius, 1);
  EXPECT_EQ(scene.spheres[1].radius, -2);
  EXPECT_EQ(std::get<scene::Metal>(scene.materials[1].model).albedo, (scene::Vec3d{1, 1, 1}));
}

TEST(FormatOverrides, CreateMissingTables) {
  SceneFiles files;
  const auto scene = files.read(kScene, {"image.width=7", "render.samples=3"}).scene;
  EXPECT_EQ(scene.image.width, 7);
  EXPECT_EQ(scene.render.samples, 3);
}

TEST(FormatOverrides, AnInlineTableReplacesTheWholeTable) {
  SceneFiles files;
  const auto scene = files.read(kScene, {"material.gold={type=\"dielectric\"}"}).scene;
  EXPECT_EQ(std::get<scene::Dielectric>(scene.materials[0].model).ior, 1.5);
}

TEST(FormatOverrides, TheLastOneWins) {
  SceneFiles files;
  EXPECT_EQ(files.read(kScene, {"camera.vfov=30", "camera.vfov=40"}).scene.camera.vfov, 40);
}

TEST(FormatOverrides, WordsNeedNoQuotes) {
  SceneFiles files;
  EXPECT_EQ(files.read(kScene, {"render.precision=fast"}).scene.render.precision, scene::Precision::kFast);
  EXPECT_EQ(files.read(kScene, {"render.precision=\"fast\""}).scene.render.precision, scene::Precision::kFast);
  EXPECT_EQ(files.read(kScene, {"color.space=Utility - \\ \"x\""}).scene.color.space, "Utility - \\ \"x\"");
}

TEST(FormatOverrides, BlanksAreIgnored) {
  SceneFiles files;
  EXPECT_EQ(files.read(kScene, {" camera.vfov = 30 "}).scene.camera.vfov, 30);
}

TEST(FormatOverrides, ErrorsAreLocatedInTheOverride) {
  SceneFiles files;
  EXPECT_EQ(files.diagnostics(kScene, {"image.width=5", "camera.vfov=300", "camera.vfow=3", "sphere[1].radius=0",
                                       "sphere[0].center=[0, 1]"}),
            "--set: error: camera.vfov is 300; must be above 0 and below 180\n"
            "    --set camera.vfov=300\n"
            "                      ^~~\n"
            "--set: error: unknown key `vfow` in camera; did you mean `vfov`?\n"
            "    --set camera.vfow=3\n"
            "                 ^~~~\n"
            "--set: error: sphere[1].radius: radius is 0; must be in 1e-30..1e+18, or negative for an inward "
            "normal\n"
            "    --set sphere[1].radius=0\n"
            "                           ^\n"
            "--set: error: sphere[0].center must be three numbers like [0, 1, 0], not a list of 2\n"
            "    --set sphere[0].center=[0, 1]\n"
            "                           ^~~~~~\n");
}

TEST(FormatOverrides, MessagesNameTheShortOption) {
  SceneFiles files;
  EXPECT_EQ(files.diagnostics(kScene, {{"render.samples=0", "--samples", "0"},
                                       "camera.vfov=0",
                                       {"output.layers=[Z,Q,N]", "--layers", "Z,Q,N"}}),
            "--samples: error: render.samples is 0; must be in 1..2147483647\n"
            "    --samples 0\n"
            "              ^\n"
            "--set: error: camera.vfov is 0; must be above 0 and below 180\n"
            "    --set camera.vfov=0\n"
            "                      ^\n"
            "--layers: error: output.layers[1] is \"Q\"; must be one of Z, depth, N, P, albedo, diffuse, specular, "
            "transmission, background, emission, light_groups, variance, samples, object_id, material_id, "
            "denoise.albedo, denoise.normal, halves, "
            "CryptoObject, CryptoMaterial, CryptoGroup, all\n"
            "    --layers Z,Q,N\n"
            "               ^\n");
}

TEST(FormatOverrides, ListsOfWordsNeedNoQuotes) {
  SceneFiles files;
  using Names = std::vector<std::string>;
  const auto layers = [&](const std::string& value) {
    return files.read(kScene, {"output.layers=" + value}).scene.output.layers;
  };
  EXPECT_EQ(layers("[Z,N]"), (Names{"Z", "N"}));
  EXPECT_EQ(layers(" [ Z , denoise.albedo, ]"), (Names{"Z", "denoise.albedo"}));
  EXPECT_EQ(layers("[\"Z\"]"), (Names{"Z"}));
  EXPECT_EQ(layers("[]"), Names{});
  EXPECT_EQ(
      told("output.layers=[Z,,N]"),
      "--set: error: output.layers[1] is \"\"; must be one of Z, depth, N, P, albedo, diffuse, specular, transmission, "
      "background, emission, light_groups, variance, samples, object_id, material_id, denoise.albedo, denoise.normal, "
      "halves, "
      "CryptoObject, "
      "CryptoMaterial, CryptoGroup, all");
  EXPECT_EQ(told("camera.up=[0,1,x]"), "--set: error: camera.up[2] must be a number, not a string");
}

TEST(FormatOverrides, AreCheckedLikeTheFile) {
  EXPECT_EQ(told("material.gold.ior=1.5"),
            "--set: error: unknown key `ior` in material.gold of type metal; `ior` belongs to dielectric");
  EXPECT_EQ(told("sphere[0].material=glod"),
            "--set: error: sphere[0].material is \"glod\", which is not defined; did you mean `gold`?");
  EXPECT_EQ(told("render.samples=1.5"), "--set: error: render.samples must be an integer, not a floating-point number");
  EXPECT_EQ(told("camera=3"), "--set: error: `camera` must be a table; write [camera]");
  EXPECT_EQ(told("material.new.fuzz=0.5"),
            "--set: error: material.new needs `type`; one of lambertian, hemisphere, metal, dielectric, emitter");
}

TEST(FormatOverrides, InvalidOverridesAreReported) {
  const std::string example = "; write KEY=VALUE, e.g. camera.vfov=30 or sphere[0].radius=2";
  EXPECT_EQ(told("camera.vfov"), "--set: error: not of the form KEY=VALUE" + example);
  EXPECT_EQ(told(""), "--set: error: not of the form KEY=VALUE" + example);
  EXPECT_EQ(told("=3"), "--set: error: no key before the =" + example);
  EXPECT_EQ(told("camera.vfov="), "--set: error: no value after the =" + example);
  EXPECT_EQ(told("camera.vfov=1\nimage.width=0"), "--set: error: an override must be one line" + example);
  EXPECT_EQ(told("a.b.c.d.e.f.g.h.i=1"), "--set: error: the key has more than 8 parts" + example);
}

TEST(FormatOverrides, SyntaxErrorsInListsAreReported) {
  EXPECT_EQ(told("camera.up=[1,2"), "--set: error: array: encountered end-of-file");
  EXPECT_EQ(told("camera..vfov=1").rfind("--set: error: key: ", 0), 0u) << told("camera..vfov=1");
}

TEST(FormatOverrides, ListElementsMustExist) {
  EXPECT_EQ(told("sphere[2].radius=1"),
            "--set: error: sphere[2] does not exist; the scene has 2 `sphere` tables, counted from 0");
  EXPECT_EQ(told("points[0].radius=1").rfind("--set: error: the scene has no list `points`", 0), 0u);
  EXPECT_EQ(told("camera[0].vfov=1").rfind("--set: error: the scene has no list `camera`", 0), 0u);
  EXPECT_EQ(told("sphere[0]=1").rfind("--set: error: a list element cannot be set as a whole", 0), 0u);
  EXPECT_EQ(told("sphere[].radius=1").rfind("--set: error: `sphere[]` is not a list element", 0), 0u);
  EXPECT_EQ(told("sphere[-1].radius=1").rfind("--set: error: `sphere[-1]` is not a list element", 0), 0u);
  EXPECT_EQ(told("sphere[0][1].radius=1").rfind("--set: error: `sphere[0][1]` is not a list element", 0), 0u);
  EXPECT_EQ(told("sphere[99999999999999999999].radius=1").rfind("--set: error: `sphere[9", 0), 0u);
  EXPECT_EQ(told("].radius=1").rfind("--set: error: `]` is not a list element", 0), 0u);
  EXPECT_EQ(told("sphere.radius=1"),
            "--set: error: `sphere` is not a table; name one of its elements, e.g. sphere[0].radius=2");
  EXPECT_EQ(told("camera.vfov.x=1"), "--set: error: `vfov` is not a table");
}

}  // namespace
}  // namespace orrery::format
