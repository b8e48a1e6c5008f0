// SPDX-License-Identifier: Apache-2.0
#include "load/read_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "load/diagnostics.h"
#include "scene/diagnostic.h"
#include "support/mentions.h"
#include "support/scene_files.h"

namespace orrery::load {
namespace {

using scene::Vec3d;
using support::SceneFiles;

TEST(LoadReadScene, AnEmptyFileHasTheDefaults) {
  SceneFiles files;
  const auto read = files.read("");
  EXPECT_TRUE(read.scene.spheres.empty());
  EXPECT_EQ(read.scene.image.width, scene::Image{}.width);
  EXPECT_TRUE(read.warnings.empty());
}

TEST(LoadReadScene, ReadsEveryKey) {
  SceneFiles files;
  const auto read = files.read(R"(
[image]
width = 320
height = 200
[camera]
look_from = [13, 2, 3.5]
look_at = [0, 1, 0]
up = [0, 0, 1]
vfov = 20
defocus_angle = 0.6
focus_distance = 10
[background]
type = "constant"
bottom = [0.1, 0.2, 0.3]
top = [1, 2, 3]
color = [0.25, 0.5, 1]
[render]
samples = 7
max_depth = 9
seed = 4294967295
precision = "fast"
shading = "normal"
accelerator = "list"
[color]
space = "ACEScg"
[material.ground]
type = "lambertian"
albedo = [0.1, 0.2, 0.3]
[material.clay]
type = "hemisphere"
albedo = [0.4, 0.5, 0.6]
[material.gold]
type = "metal"
albedo = [0.8, 0.6, 0.2]
fuzz = 0.1
[material.glass]
type = "dielectric"
ior = 1.33
fresnel = "none"
[[sphere]]
center = [0, -1000, 0]
radius = 1000
material = "ground"
name = "floor"
[[sphere]]
center = [1, 2, 3]
radius = -0.5
material = "glass"
)");
  const scene::Scene& s = read.scene;
  EXPECT_EQ(s.image.width, 320);
  EXPECT_EQ(s.image.height, 200);
  EXPECT_EQ(s.camera.look_from, (Vec3d{13, 2, 3.5}));
  EXPECT_EQ(s.camera.look_at, (Vec3d{0, 1, 0}));
  EXPECT_EQ(s.camera.up, (Vec3d{0, 0, 1}));
  EXPECT_EQ(s.camera.vfov, 20);
  EXPECT_EQ(s.camera.defocus_angle, 0.6);
  EXPECT_EQ(s.camera.focus_distance, 10.0);
  EXPECT_EQ(s.background.type, scene::BackgroundType::kConstant);
  EXPECT_EQ(s.background.bottom, (Vec3d{0.1, 0.2, 0.3}));
  EXPECT_EQ(s.background.top, (Vec3d{1, 2, 3}));
  EXPECT_EQ(s.background.color, (Vec3d{0.25, 0.5, 1}));
  EXPECT_EQ(s.render.samples, 7);
  EXPECT_EQ(s.render.max_depth, 9);
  EXPECT_EQ(s.render.seed, 4294967295u);
  EXPECT_EQ(s.render.precision, scene::Precision::kFast);
  EXPECT_EQ(s.render.shading, scene::Shading::kNormal);
  EXPECT_EQ(s.render.accelerator, scene::Accelerator::kList);
  EXPECT_EQ(s.color.space, "ACEScg");
  ASSERT_EQ(s.materials.size(), 4u);
  EXPECT_EQ(std::get<scene::Lambertian>(s.materials[0].model).albedo, (Vec3d{0.1, 0.2, 0.3}));
  EXPECT_EQ(std::get<scene::Hemisphere>(s.materials[1].model).albedo, (Vec3d{0.4, 0.5, 0.6}));
  EXPECT_EQ(std::get<scene::Metal>(s.materials[2].model).albedo, (Vec3d{0.8, 0.6, 0.2}));
  EXPECT_EQ(std::get<scene::Metal>(s.materials[2].model).fuzz, 0.1);
  EXPECT_EQ(std::get<scene::Dielectric>(s.materials[3].model).ior, 1.33);
  EXPECT_EQ(std::get<scene::Dielectric>(s.materials[3].model).fresnel, scene::Fresnel::kNone);
  ASSERT_EQ(s.spheres.size(), 2u);
  EXPECT_EQ(s.spheres[0].center, (Vec3d{0, -1000, 0}));
  EXPECT_EQ(s.spheres[0].radius, 1000);
  EXPECT_EQ(s.spheres[0].material, 0u);
  EXPECT_EQ(s.spheres[0].name, "floor");
  EXPECT_EQ(s.spheres[1].radius, -0.5);
  EXPECT_EQ(s.spheres[1].material, 3u);
}

TEST(LoadReadScene, ReadsTheKeysOfOutput) {
  SceneFiles files;
  const auto read = files.read(R"(
[image]
pixel_aspect = 2
crop = [1, 2, 30, 40]
[background]
alpha = 0
[render]
filter = "blackman-harris"
filter_width = 2.5
[color]
space = "lin_rec709"
working = "ACEScg"
config = "show.ocio"
display = "Rec.2100-PQ"
view = "Raw"
look = "warm"
exposure = -1.5
[output]
layers = ["N", "Z", "CryptoGroup"]
[material.a]
type = "dielectric"
[[sphere]]
center = [0, 0, 0]
radius = 1
material = "a"
group = "left"
)");
  const scene::Scene& s = read.scene;
  EXPECT_EQ(s.image.pixel_aspect, 2);
  EXPECT_EQ(s.image.data_window().x, 1);
  EXPECT_EQ(s.image.data_window().y, 2);
  EXPECT_EQ(s.image.data_window().width, 30);
  EXPECT_EQ(s.image.data_window().height, 40);
  EXPECT_EQ(s.background.alpha, 0);
  EXPECT_EQ(s.render.filter, scene::Filter::kBlackmanHarris);
  EXPECT_EQ(s.render.filter_width, 2.5);
  EXPECT_EQ(s.color.working_space(), "ACEScg");
  EXPECT_EQ(s.color.config, "show.ocio");
  EXPECT_EQ(s.color.display + s.color.view + s.color.look, "Rec.2100-PQRawwarm");
  EXPECT_EQ(s.color.exposure, -1.5);
  EXPECT_EQ(s.output.layers, (std::vector<std::string>{"N", "Z", "CryptoGroup"}));
  EXPECT_EQ(s.spheres[0].group, "left");
}

TEST(LoadReadScene, ReportsAllErrorsInFileOrder) {
  SceneFiles files;
  EXPECT_EQ(
      files.diagnostics("[camera]\n"
                        "\tvfov = 200\n"
                        "fov = 20\n"
                        "[render]\n"
                        "samples = 0\n"
                        "precision = \"exakt\"\n"
                        "[materal.x]\n"
                        "[material.gold]\n"
                        "type = \"metal\"\n"
                        "albdo = [0.8, 0.6, 0.2]\n"
                        "[[sphere]]\n"
                        "center = [0, 0]\n"
                        "radius = 0\n"
                        "material = \"glod\"\n"),
      "scene.toml:2:9: error: camera.vfov is 200; must be above 0 and below 180\n"
      "    \tvfov = 200\n"
      "    \t       ^~~\n"
      "scene.toml:3:1: error: unknown key `fov` in camera; did you mean `vfov`?\n"
      "    fov = 20\n"
      "    ^~~\n"
      "scene.toml:5:11: error: render.samples is 0; must be in 1..2147483647\n"
      "    samples = 0\n"
      "              ^\n"
      "scene.toml:6:13: error: render.precision is \"exakt\"; must be one of exact, fast, book; did you mean `exact`?\n"
      "    precision = \"exakt\"\n"
      "                ^~~~~~~\n"
      "scene.toml:7:2: error: unknown key `materal` in the scene; did you mean `material`?\n"
      "    [materal.x]\n"
      "     ^~~~~~~\n"
      "scene.toml:8:1: error: material.gold needs `albedo`\n"
      "    [material.gold]\n"
      "    ^~~~~~~~~~~~~~~\n"
      "scene.toml:10:1: error: unknown key `albdo` in material.gold; did you mean `albedo`?\n"
      "    albdo = [0.8, 0.6, 0.2]\n"
      "    ^~~~~\n"
      "scene.toml:12:10: error: sphere[0].center must be three numbers like [0, 1, 0], not a list of 2\n"
      "    center = [0, 0]\n"
      "             ^~~~~~\n"
      "scene.toml:13:10: error: sphere[0].radius: radius is 0; must be in 1e-30..1e+18, or negative for an "
      "inward normal\n"
      "    radius = 0\n"
      "             ^\n"
      "scene.toml:14:12: error: sphere[0].material is \"glod\", which is not defined; did you mean `gold`?\n"
      "    material = \"glod\"\n"
      "               ^~~~~~\n");
}

TEST(LoadReadScene, TheMessageCountsTheErrors) {
  SceneFiles files;
  files.add("bad.toml", "camera.vfov = 0\nimage.width = 0\n");
  try {
    support::read_scene(files.folder() / "bad.toml");
    FAIL() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kBadData);
    EXPECT_EQ(error.what(), (files.folder() / "bad.toml").string() + ": 2 errors");
  }
}

TEST(LoadReadScene, MissingFileIsMissingInput) {
  const SceneFiles files;
  for (const std::string name : {"none.toml", "."}) {
    try {
      support::read_scene(files.folder() / name);
      FAIL() << "no error";
    } catch (const base::Error& error) {
      EXPECT_EQ(error.kind(), base::ErrorKind::kMissingInput) << error.what();
    }
  }
}

TEST(LoadReadScene, RequiredKeysOfASphere) {
  SceneFiles files;
  EXPECT_EQ(files.diagnostics("[[sphere]]\n"),
            "scene.toml:1:1: error: sphere[0] needs `center`\n"
            "    [[sphere]]\n    ^~~~~~~~~~\n"
            "scene.toml:1:1: error: sphere[0] needs `radius`\n"
            "    [[sphere]]\n    ^~~~~~~~~~\n"
            "scene.toml:1:1: error: sphere[0] needs `material`\n"
            "    [[sphere]]\n    ^~~~~~~~~~\n");
}

TEST(LoadReadScene, RodsHaveOneMaterialOrTwo) {
  SceneFiles files;
  const std::string materials =
      "[material]\na = { type = \"lambertian\", albedo = [0, 0, 0] }\n"
      "b = { type = \"emitter\", radiance = [1, 1, 1] }\n";
  const scene::Scene s = files
                             .read(materials + R"(
[[rod]]
from = [1, 2, 3]
to = [4, 5, 6]
radius = 0.5
material = ["b", "a"]
name = "bond"
group = "bonds"
[[rod]]
from = [0, 0, 0]
to = [0, 0, 0]
radius = 1
material = "b"
)")
                             .scene;
  ASSERT_EQ(s.rods.size(), 2u);
  EXPECT_EQ(s.rods[0].from, (Vec3d{1, 2, 3}));
  EXPECT_EQ(s.rods[0].to, (Vec3d{4, 5, 6}));
  EXPECT_EQ(s.rods[0].radius, 0.5);
  EXPECT_EQ(s.rods[0].name, "bond");
  EXPECT_EQ(s.rods[0].group, "bonds");
  EXPECT_EQ(s.rods[0].materials, (std::array<std::uint32_t, 2>{1, 0}));
  EXPECT_EQ(s.rods[1].materials, (std::array<std::uint32_t, 2>{1, 1}));
}

TEST(LoadReadScene, BondsAreAFlagOrATable) {
  const auto bonds_of = [](const std::string& bonds) {
    SceneFiles files;
    return files
        .read(
            "[material]\nm = { type = \"metal\", albedo = [1, 1, 1] }\nn = { type = \"metal\", albedo = [1, 1, 1] "
            "}\n[[points]]\nfile = \"a.ply\"\nmaterial = "
            "\"m\"\n" +
            bonds + "\n")
        .scene.points.at(0)
        .bonds;
  };
  EXPECT_FALSE(bonds_of("").are_drawn);
  EXPECT_FALSE(bonds_of("bonds = false").are_drawn);
  EXPECT_TRUE(bonds_of("bonds = true").are_drawn);
  EXPECT_TRUE(bonds_of("bonds = {}").are_drawn);
  const scene::PointsBonds bonds = bonds_of("bonds = { length = 2.5, material = \"n\" }");
  EXPECT_TRUE(bonds.are_drawn);
  EXPECT_EQ(bonds.length, 2.5);
  EXPECT_EQ(bonds.material, 1u);
}

TEST(LoadReadScene, ErrorsOfRods) {
  SceneFiles files;
  EXPECT_EQ(files.diagnostics("[[rod]]\n"),
            "scene.toml:1:1: error: rod[0] needs `from`\n    [[rod]]\n    ^~~~~~~\n"
            "scene.toml:1:1: error: rod[0] needs `to`\n    [[rod]]\n    ^~~~~~~\n"
            "scene.toml:1:1: error: rod[0] needs `radius`\n    [[rod]]\n    ^~~~~~~\n"
            "scene.toml:1:1: error: rod[0] needs `material`\n    [[rod]]\n    ^~~~~~~\n");
  const std::string good =
      "[material.m]\ntype = \"lambertian\"\nalbedo = [0, 0, 0]\n"
      "[material.glass]\ntype = \"dielectric\"\n";
  const auto told = [&](const std::string& from, const std::string& radius, const std::string& material) {
    return files.diagnostics(good + "[[rod]]\nfrom = " + from + "\nto = [0, 0, 0]\nradius = " + radius +
                             "\nmaterial = " + material + "\n");
  };
  EXPECT_EQ(told("[0, 0, 0]", "1", "\"m\""), "");
  const auto expect = [](const std::string& text, const std::string& part) {
    EXPECT_TRUE(text.starts_with(part)) << text;
  };
  expect(told("[0, nan, 0]", "1", "\"m\""), "scene.toml:7:12: error: rod[0].from[1] is nan; must be in");
  expect(told("[0, 0, 0]", "0", "\"m\""), "scene.toml:9:10: error: rod[0].radius is 0; must be in 1e-30..1e+18");
  expect(told("[0, 0, 0]", "-1", "\"m\""), "scene.toml:9:10: error: rod[0].radius is -1; must be in 1e-30..1e+18");
  expect(told("[0, 0, 0]", "1", "\"n\""),
         "scene.toml:10:12: error: rod[0].material is \"n\", which is not defined; defined are m, glass");
  expect(told("[0, 0, 0]", "1", "[\"m\", \"n\"]"),
         "scene.toml:10:18: error: rod[0].material[1] is \"n\", which is not defined");
  expect(told("[0, 0, 0]", "1", "[\"m\"]"),
         "scene.toml:10:12: error: rod[0].material has 1 names; write one name, or two");
  expect(told("[0, 0, 0]", "1", "3"), "scene.toml:10:12: error: rod[0].material");
  expect(told("[0, 0, 0]", "1", "[\"m\", \"glass\"]"),
         "scene.toml:10:12: error: rod[0].material: \"glass\" is a dielectric, but rods transmit no light");
  expect(files.diagnostics("rod = 3\n"), "scene.toml:1:7: error: `rod` must be an array of tables; write [[rod]]");
}

TEST(LoadReadScene, UndefinedMaterials) {
  SceneFiles files;
  const std::string sphere = "[[sphere]]\ncenter = [0,0,0]\nradius = 1\nmaterial = \"chalk\"\n";
  EXPECT_EQ(
      files.diagnostics(sphere),
      "scene.toml:4:12: error: sphere[0].material is \"chalk\", which is not defined; the scene defines no materials\n"
      "    material = \"chalk\"\n"
      "               ^~~~~~~\n");
  const std::string told =
      files.diagnostics("[material.ruby]\ntype=\"dielectric\"\n[material.gold]\ntype=\"dielectric\"\n" + sphere);
  EXPECT_NE(told.find("; defined are ruby, gold\n"), std::string::npos) << told;
}

TEST(LoadReadScene, ValuesInPlaceOfTables) {
  SceneFiles files;
  EXPECT_EQ(files.diagnostics("camera = 3\nsphere = 4\npoints = [1, 2]\nmaterial = 5\n"),
            "scene.toml:1:10: error: `camera` must be a table; write [camera]\n"
            "    camera = 3\n"
            "             ^\n"
            "scene.toml:2:10: error: `sphere` must be an array of tables; write [[sphere]]\n"
            "    sphere = 4\n"
            "             ^\n"
            "scene.toml:3:10: error: `points` must be an array of tables; write [[points]]\n"
            "    points = [1, 2]\n"
            "             ^~~~~~\n"
            "scene.toml:4:12: error: `material` must contain tables; write [material.NAME]\n"
            "    material = 5\n"
            "               ^\n");
}

TEST(LoadReadScene, SceneErrorsAreReportedAtTheirKey) {
  SceneFiles files;
  EXPECT_EQ(files.diagnostics("[camera]\nup = [0, 0, 2]\n"),
            "scene.toml:2:6: error: camera.up: up is parallel to the view; choose another direction\n"
            "    up = [0, 0, 2]\n"
            "         ^~~~~~~~~\n");
  // If another key makes the view parallel, the location is the table.
  EXPECT_EQ(files.diagnostics("[camera]\nlook_at = [0, 1, 0]\n"),
            "scene.toml:1:1: error: camera.up: up is parallel to the view; choose another direction\n"
            "    [camera]\n"
            "    ^~~~~~~~\n");
}

TEST(LoadReadScene, OneMistakeIsReportedOnce) {
  SceneFiles files;
  // look_at keeps its default, which equals look_from here: that is not a second mistake.
  const std::string told = files.diagnostics("[camera]\nlook_from = [0, 0, -1]\nlook_at = [0, nan, 0]\n");
  EXPECT_EQ(told,
            "scene.toml:3:15: error: camera.look_at[1] is nan; must be in -1e+18..1e+18\n"
            "    look_at = [0, nan, 0]\n"
            "                  ^~~\n");
  // Here the default makes the view parallel to up, a different key than the invalid one.
  const std::string parallel = files.diagnostics("[camera]\nlook_from = [0, 5, -1]\nlook_at = [0, nan, 0]\n");
  EXPECT_EQ(parallel.find("parallel"), std::string::npos) << parallel;
  EXPECT_EQ(files.diagnostics("[material.a]\ntype = \"metall\"\nalbedo = 3\n"
                              "[[sphere]]\ncenter = [0,0,0]\nradius = 1\nmaterial = \"a\"\n"),
            "scene.toml:2:8: error: material.a.type is \"metall\"; must be one of lambertian, hemisphere, metal, "
            "dielectric, emitter, plastic; did you mean `metal`?\n"
            "    type = \"metall\"\n"
            "           ^~~~~~~~\n");
}

TEST(LoadReadScene, CoincidentSpheresAreAWarning) {
  SceneFiles files;
  const std::string material = "[material.a]\ntype = \"dielectric\"\n";
  const std::string sphere = "[[sphere]]\ncenter = [1, 2, 3]\nradius = 1\nmaterial = \"a\"\n";
  const std::string told = files.diagnostics(material + sphere + sphere);
  EXPECT_EQ(told,
            "scene.toml:7:1: warning: sphere[1]: has exactly the same centre and radius as sphere[0]; only the "
            "first is rendered\n"
            "    [[sphere]]\n    ^~~~~~~~~~\n");
  const std::string wrong = files.diagnostics(material + sphere + sphere + "[image]\nwidth = 0\n");
  EXPECT_EQ(wrong.find("warning"), std::string::npos) << "no warnings about a scene with errors";
}

TEST(LoadReadScene, SettingsHaveTheirOrigin) {
  SceneFiles files;
  const auto settings = files.read("[camera]\nvfov = 20\n", {"render.precision=fast"}).settings;
  const auto line = [&](const std::string& key) {
    for (const Setting& s : settings)
      if (s.key == key) return s.value + " " + std::filesystem::path(s.origin).filename().string();
    return std::string("none");
  };
  EXPECT_EQ(settings.front().key, "image.width");
  EXPECT_EQ(line("image.width"), "1200 default");
  EXPECT_EQ(line("camera.vfov"), "20 scene.toml:2");
  EXPECT_TRUE(test::mentions(line("camera.focus_distance"), {"distance", "look_at", "default"}));
  EXPECT_EQ(line("render.precision"), "\"fast\" --set");
  EXPECT_EQ(line("color.space"), "\"lin_rec709\" default");
}

TEST(LoadReadScene, AHundredErrorsAreReportedAndTheRestCounted) {
  SceneFiles files;
  std::string text;
  for (int i = 0; i < 50; ++i) text += "[[sphere]]\ncolor = 1\nradius = \"big\"\n";  // four errors each
  files.add("scene.toml", text);
  try {
    support::read_scene(files.folder() / "scene.toml");
    FAIL() << "no error";
  } catch (const base::Error& error) {
    ASSERT_EQ(error.diagnostics().size(), kMaxErrors + 1);
    EXPECT_EQ(error.diagnostics()[0].line, 1);
    EXPECT_EQ(error.diagnostics()[99].line, 25 * 3) << "the first by location: 25 of 50 spheres";
    EXPECT_EQ(error.diagnostics()[100].text, "and 100 more (200 in all)");
    EXPECT_NE(std::string(error.what()).find("scene.toml: 200 errors"), std::string::npos) << error.what();
  }
}

TEST(LoadReadScene, FurtherChecksAreReported) {
  SceneFiles files;
  files.add("scene.toml", "[color]\nspace = \"foo\"\n[image]\nwidth = 0\n");
  const SceneSource source{.file = files.folder() / "scene.toml"};
  SceneReader reader(source);
  reader.add({{base::Severity::kError, "color.space", "no " + reader.scene().color.space}});
  try {
    reader.finish();
    FAIL() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(files.told(error),
              "scene.toml:2:9: error: color.space: no foo\n    space = \"foo\"\n            ^~~~~\n"
              "scene.toml:4:9: error: image.width is 0; must be in 1..65536\n    width = 0\n            ^\n");
  }
}

TEST(LoadReadScene, ManyErrorsAreReportedQuickly) {
  SceneFiles files;
  std::string text;
  for (int i = 0; i < 3000; ++i) text += "[[sphere]]\ncenter = [0,0,0]\nradius = 0\nmaterial = \"x\"\n";
  const std::string told = files.diagnostics(text);
  EXPECT_EQ(std::count(told.begin(), told.end(), '^'), 100);
  EXPECT_NE(told.find("and 5900 more (6000 in all)"), std::string::npos);
}

TEST(LoadReadScene, BookScenesReadWithoutDiagnostics) {
  const auto folder = std::filesystem::path(ORRERY_ROOT) / "scenes" / "book";
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".toml") continue;
    ++count;
    try {
      EXPECT_TRUE(support::read_scene(entry.path()).warnings.empty()) << entry.path();
    } catch (const base::Error& error) {
      ADD_FAILURE() << error.what() << "\n"
                    << (error.diagnostics().empty() ? "" : base::formatted(error.diagnostics()[0]));
    }
  }
  EXPECT_GE(count, 20);
}

TEST(LoadReadScene, OnlyWhatMovesIsCheckedAtShutterClose) {
  SceneFiles files;
  const std::string text = R"([camera]
shutter_close = 0.5
[material.lamp]
type = "emitter"
radiance = [1, 1, 1]
[[sphere]]
name = "ball"
center = [0, 0, -1]
radius = 1
material = "lamp"
[[key]]
frames = [1, 2]
)";
  EXPECT_EQ(files.diagnostics(text + "target = \"material.lamp.exposure\"\nvalues = [0, 90]\n", {}), "");
  EXPECT_NE(files.diagnostics(text + "target = \"sphere.ball.radius\"\nvalues = [1, -3]\n", {})
                .find("error: sphere[0].radius changes sign"),
            std::string::npos);
}

}  // namespace
}  // namespace orrery::load
