// SPDX-License-Identifier: Apache-2.0
#include "load/overrides.h"
#include "support/mentions.h"

#include <gtest/gtest.h>

#include <random>

#include <fmt/core.h>

#include "support/scene_files.h"

namespace orrery::load {
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

TEST(LoadOverrides, ReplaceValuesOfTheFile) {
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

TEST(LoadOverrides, CreateMissingTables) {
  SceneFiles files;
  const auto scene = files.read(kScene, {"image.width=7", "render.samples=3"}).scene;
  EXPECT_EQ(scene.image.width, 7);
  EXPECT_EQ(scene.render.samples, 3);
}

TEST(LoadOverrides, TablesAreMerged) {
  SceneFiles files;
  const auto scene = files.read(kScene, {"camera={look_from=[1,2,3]}", "material={gold={fuzz=0.5}}"}).scene;
  EXPECT_EQ(scene.camera.vfov, 20);
  EXPECT_EQ(scene.camera.look_from, (scene::Vec3d{1, 2, 3}));
  EXPECT_EQ(std::get<scene::Metal>(scene.materials[0].model).albedo, (scene::Vec3d{0.8, 0.6, 0.2}));
  EXPECT_EQ(std::get<scene::Metal>(scene.materials[0].model).fuzz, 0.5);
}

TEST(LoadOverrides, AListOrNumberBecomesATable) {
  SceneFiles files;
  for (const char* text : {"material.gold.albedo={texture=\"noise\"}", "material.gold.albedo.texture=noise"})
    EXPECT_NE(std::get<scene::Metal>(files.read(kScene, {text}).scene.materials[0].model).albedo_texture, nullptr)
        << text;
}

TEST(LoadOverrides, ANewTypeDropsTheKeysOfTheOldOne) {
  SceneFiles files;
  for (const char* text : {"material.gold={type=\"dielectric\"}", "material.gold.type=dielectric"}) {
    const auto scene = files.read(kScene, {text}).scene;
    EXPECT_EQ(std::get<scene::Dielectric>(scene.materials[0].model).ior, 1.5) << text;
  }
  const auto scene = files.read(kScene, {"material.gold.type=lambertian"}).scene;
  EXPECT_EQ(std::get<scene::Lambertian>(scene.materials[0].model).albedo, (scene::Vec3d{0.8, 0.6, 0.2}))
      << "common keys";
  const std::string own = files.diagnostics(kScene, {"material.gold={type=\"dielectric\", albedo=[1,1,1]}"});
  EXPECT_NE(own.find("unknown key `albedo` in material.gold of type dielectric"), std::string::npos) << own;
}

TEST(LoadOverrides, ANewTextureDropsTheKeysOfTheOldOne) {
  SceneFiles files;
  const std::string scene = std::string(kScene) +
                            "[material.wall]\ntype = \"lambertian\"\n"
                            "albedo = { texture = \"checker\", even = [0, 0, 0], scale = 2 }\n";
  EXPECT_EQ(files.diagnostics(scene, {"material.wall.albedo.texture=noise"}), "");
}

/// The settings of a scene, which all spellings of the overrides must give.
std::string settings_with(const Overrides& overrides) {
  SceneFiles files;
  std::string out;
  for (const Setting& setting : files.read(kScene, overrides).settings)
    out += setting.key + "=" + setting.value + " " + setting.origin.substr(0, 5) + "\n";
  return out;
}

/// Chooses among the spellings of a key or a value.
class Spelling {
 public:
  explicit Spelling(unsigned seed) : random_(seed) {}

  std::size_t below(std::size_t count) { return random_() % count; }
  std::string blanks() { return std::string(below(3), below(2) == 0 ? ' ' : '\t'); }

  std::string key(const std::string& name) {
    switch (below(4)) {
      case 0: return '"' + name + '"';
      case 1: return "'" + name + "'";
      case 2: return fmt::format("\"\\u{:04x}{}\"", static_cast<unsigned>(name[0]), name.substr(1));
      default: return name;
    }
  }

  /// `table.key=value`, or a table with one key.
  std::string setting(const std::string& table, const std::string& name, const std::string& value) {
    const std::string first = blanks() + key(table) + blanks(), second = blanks() + key(name) + blanks();
    if (below(2) == 0) return first + "." + second + "=" + blanks() + value + blanks();
    return first + "=" + blanks() + "{" + second + "=" + blanks() + value + blanks() + "}" + blanks();
  }

 private:
  std::mt19937 random_;
};

/// Limits, conflicts, framing, layers, headers and submitted jobs depend only on what this compares.
TEST(LoadOverrides, EquivalentSpellingsAreEqual) {
  struct Case {
    const char *table, *key;
    std::vector<std::string> values;
  };
  const std::vector<Case> cases = {{"render", "samples", {"20", "+20", "0x14", "2_0"}},
                                   {"image", "width", {"64", "0b1000000"}},
                                   {"camera", "vfov", {"30.5", "3.05e1", "30.50"}},
                                   {"camera", "look_from", {"[1, 2, 3]", "[1,2,3,]", " [ 1.0 , 2e0, 3 ] "}},
                                   {"render", "precision", {"\"fast\"", "'fast'", "\"f\\u0061st\""}},
                                   {"output", "layers", {"[\"Z\",'N']", "[ \"\\u005A\", \"N\", ]"}},
                                   {"output", "layers", {"[]", "[ ]"}},
                                   {"color", "space", {"\"a \\\"b\\\" \\\\ c\"", "'a \"b\" \\ c'"}}};
  Spelling spelling(1);
  for (int round = 0; round < 300; ++round) {
    Overrides plain, spelled;
    std::string shown;
    for (std::size_t count = 1 + spelling.below(4); count > 0; --count) {
      const Case& one = cases[spelling.below(cases.size())];
      plain.add(fmt::format("{}.{}={}", one.table, one.key, one.values.front()));
      spelled.add(spelling.setting(one.table, one.key, one.values[spelling.below(one.values.size())]));
      shown += spelled[spelled.size() - 1].typed + "\n";
    }
    std::string a, b;
    Overrides again;
    for (const KeyValue& set : plain.values()) a += set.text + "\n";
    for (const KeyValue& set : spelled.values()) again.add(set.text);
    for (const KeyValue& set : again.values()) b += set.text + "\n";
    for (const Case& one : cases) {
      const std::string key = fmt::format("{}.{}", one.table, one.key);
      EXPECT_EQ(plain.sets(key), spelled.sets(key)) << key << " in\n" << shown;
      EXPECT_EQ(plain.integer(key), spelled.integer(key)) << key << " in\n" << shown;
      EXPECT_EQ(plain.string(key), spelled.string(key)) << key << " in\n" << shown;
    }
    EXPECT_EQ(a, b) << shown;
    if (round % 10 != 0) continue;  // these read files
    EXPECT_EQ(settings_with(plain), settings_with(spelled)) << shown;
    EXPECT_EQ(settings_with(plain), settings_with(again)) << shown;
  }
}

TEST(LoadOverrides, ValuesAreReadByKey) {
  const Overrides overrides = {"image={width=64,height=\"x\"}",    "image.width=65",         "color.view=\"a\\\"b\"",
                               "material.\"dark gold\".fuzz=1e-1", "\"sphere\"[1].radius=2", "render={}"};
  EXPECT_EQ(overrides.integer("image.width"), 65);
  EXPECT_EQ(overrides.number("image.width"), 65.0);
  EXPECT_EQ(overrides.number("material.dark gold.fuzz"), 0.1);
  EXPECT_EQ(overrides.integer("image.height"), std::nullopt);
  EXPECT_EQ(overrides.string("color.view"), "a\"b");
  EXPECT_TRUE(overrides.sets("material.dark gold.fuzz"));
  EXPECT_TRUE(overrides.sets("sphere[1].radius"));
  EXPECT_FALSE(overrides.sets("sphere[1].center"));
  EXPECT_FALSE(overrides.sets("render.samples"));
  std::string all;
  for (const KeyValue& set : overrides.values()) all += set.text + "\n";
  EXPECT_EQ(all,
            "image.height=\"x\"\nimage.width=65\ncolor.view=\"a\\\"b\"\nmaterial.\"dark gold\".fuzz=0.1\n"
            "sphere[1].radius=2\n");
}

TEST(LoadOverrides, SpellingsOfAListElementAreEqual) {
  SceneFiles files;
  for (const char* text : {"sphere[1].radius=2", " sphere [1] . radius = 2 ", "\"sphere\"[1].'radius'=2"}) {
    const Overrides overrides = {text};
    EXPECT_EQ(overrides.integer("sphere[1].radius"), 2) << text;
    EXPECT_EQ(files.read(kScene, overrides).scene.spheres[1].radius, 2) << text;
  }
}

TEST(LoadOverrides, AListContainsItsElements) {
  EXPECT_TRUE(Overrides({"sphere=[]"}).sets("sphere[2].radius"));
  EXPECT_FALSE(Overrides({"sphere=[]"}).sets("spheres"));
}

TEST(LoadOverrides, TheLastOneWins) {
  SceneFiles files;
  EXPECT_EQ(files.read(kScene, {"camera.vfov=30", "camera.vfov=40"}).scene.camera.vfov, 40);
}

TEST(LoadOverrides, WordsNeedNoQuotes) {
  SceneFiles files;
  EXPECT_EQ(files.read(kScene, {"render.precision=fast"}).scene.render.precision, scene::Precision::kFast);
  EXPECT_EQ(files.read(kScene, {"render.precision=\"fast\""}).scene.render.precision, scene::Precision::kFast);
  EXPECT_EQ(files.read(kScene, {"color.space=Utility - \\ \"x\""}).scene.color.space, "Utility - \\ \"x\"");
}

TEST(LoadOverrides, BlanksAreIgnored) {
  SceneFiles files;
  EXPECT_EQ(files.read(kScene, {" camera.vfov = 30 "}).scene.camera.vfov, 30);
}

TEST(LoadOverrides, ErrorsAreLocatedInTheOverride) {
  SceneFiles files;
  EXPECT_EQ(files.diagnostics(kScene, {"image.width=5", "camera.vfov=300", "camera.vfow=3", "sphere[1].radius=0",
                                       "sphere[0].center=[0, 1]"}),
            "--set: error: camera.vfov is 300; must be above 0 and below 180\n"
            "    --set camera.vfov=300\n"
            "          ^~~~~~~~~~~~~~~\n"
            "--set: error: unknown key `vfow` in camera; did you mean `vfov`?\n"
            "    --set camera.vfow=3\n"
            "          ^~~~~~~~~~~~~\n"
            "--set: error: sphere[1].radius: radius is 0; must be in 1e-30..1e+18, or negative for an inward "
            "normal\n"
            "    --set sphere[1].radius=0\n"
            "          ^~~~~~~~~~~~~~~~~~\n"
            "--set: error: sphere[0].center must be three numbers like [0, 1, 0], not a list of 2\n"
            "    --set sphere[0].center=[0, 1]\n"
            "          ^~~~~~~~~~~~~~~~~~~~~~~\n");
}

TEST(LoadOverrides, MessagesNameTheShortOption) {
  SceneFiles files;
  Overrides overrides;
  overrides.add_option("--samples", "render.samples", "0");
  overrides.add("camera.vfov=0");
  overrides.add_option("--layers", "output.layers", "Z,Q,N", true);
  EXPECT_EQ(files.diagnostics(kScene, overrides),
            "--samples: error: render.samples is 0; must be in 1..2147483647\n"
            "    --samples 0\n"
            "              ^\n"
            "--set: error: camera.vfov is 0; must be above 0 and below 180\n"
            "    --set camera.vfov=0\n"
            "          ^~~~~~~~~~~~~\n"
            "--layers: error: output.layers[1] is \"Q\"; must be one of Z, depth, N, P, albedo, diffuse, specular, "
            "transmission, background, emission, light_groups, variance, samples, object_id, material_id, "
            "Vector, denoise.albedo, denoise.normal, halves, "
            "CryptoObject, CryptoMaterial, CryptoGroup, all\n"
            "    --layers Z,Q,N\n"
            "             ^~~~~\n");
}

TEST(LoadOverrides, ListsOfWordsNeedNoQuotes) {
  SceneFiles files;
  using Names = std::vector<std::string>;
  const auto layers = [&](const std::string& value) {
    return files.read(kScene, {"output.layers=" + value}).scene.output.layers;
  };
  EXPECT_EQ(layers("[Z,N]"), (Names{"Z", "N"}));
  EXPECT_EQ(layers(" [ Z , denoise.albedo, ]"), (Names{"Z", "denoise.albedo"}));
  EXPECT_EQ(layers("[\"Z\"]"), (Names{"Z"}));
  EXPECT_EQ(layers("[]"), Names{});
  EXPECT_TRUE(test::mentions(told("output.layers=[Z,,N]"), {"--set", "output.layers[1]", "\"\"", "light_groups"}));
  EXPECT_TRUE(test::mentions(told("camera.up=[0,1,x]"), {"--set", "camera.up[2]", "number"}));
}

TEST(LoadOverrides, AreCheckedLikeTheFile) {
  EXPECT_TRUE(test::mentions(told("material.gold.ior=1.5"), {"--set", "`ior`", "material.gold", "`ior`"}));
  EXPECT_TRUE(test::mentions(told("sphere[0].material=glod"), {"--set", "sphere[0].material", "\"glod\"", "`gold`"}));
  EXPECT_TRUE(test::mentions(told("render.samples=064"), {"--set", "render.samples", "integer", "\"064\""}));
  EXPECT_TRUE(test::mentions(told("render.samples=1.5"), {"--set", "render.samples", "integer"}));
  EXPECT_TRUE(test::mentions(told("camera=3"), {"--set", "`camera`", "[camera]"}));
  EXPECT_TRUE(test::mentions(told("material.new.fuzz=0.5"), {"--set", "material.new", "`type`"}));
}

TEST(LoadOverrides, InvalidOverridesAreReported) {
  const std::string example = "; write KEY=VALUE, e.g. camera.vfov=30 or sphere[0].radius=2";
  EXPECT_TRUE(test::mentions(told("camera.vfov"), {"--set", "form", "KEY=VALUE"}));
  EXPECT_TRUE(test::mentions(told(""), {"--set", "form", "KEY=VALUE"}));
  EXPECT_TRUE(test::mentions(told("=3"), {"--set", "before", "KEY=VALUE"}));
  EXPECT_TRUE(test::mentions(told(" #camera.vfov=3"), {"--set", "comment", "KEY=VALUE"}));
  EXPECT_TRUE(test::mentions(told("sphere[0].#radius=3"), {"--set", "comment", "KEY=VALUE"}));
  EXPECT_EQ(told("\xEF\xBB\xBF"
                 "camera.vfov=3"),
            "--set: error: the key begins with a byte order mark" + example);
  EXPECT_TRUE(test::mentions(told("camera.vfov="), {"--set", "after", "KEY=VALUE"}));
  EXPECT_TRUE(test::mentions(told("camera.vfov=1\nimage.width=0"), {"--set", "override", "line", "KEY=VALUE"}));
  EXPECT_TRUE(test::mentions(told(std::string(2000, '.') + "=1"), {"--set", "1000", "parts", "KEY=VALUE"}));
}

TEST(LoadOverrides, SyntaxErrorsInListsAreReported) {
  EXPECT_TRUE(test::mentions(told("camera.up=[1,2"), {"--set", "array", "encountered"}));
  EXPECT_EQ(told("camera..vfov=1").rfind("--set: error: key: ", 0), 0u) << told("camera..vfov=1");
}

TEST(LoadOverrides, ListElementsMustExist) {
  EXPECT_TRUE(test::mentions(told("sphere[2].radius=1"), {"--set", "sphere[2]", "2 `sphere`", "0"}));
  EXPECT_TRUE(test::mentions(told("points[0].radius=1"), {"--set", "no list", "`points`"}));
  EXPECT_TRUE(test::mentions(told("camera[0].vfov=1"), {"--set", "no list", "`camera`"}));
  EXPECT_TRUE(test::mentions(told("sphere[0]=1"), {"--set", "list element", "whole"}));
  for (const std::string element : {"sphere[]", "sphere[-1]", "sphere[0][1]", "sphere[99999999999999999999]"})
    EXPECT_TRUE(test::mentions(told(element + ".radius=1"), {"--set", element, "does not exist"})) << element;
  EXPECT_TRUE(test::mentions(told("#sphere[0].radius=1"), {"--set", "no list", "`#sphere`"}));
  EXPECT_TRUE(test::mentions(told("].radius=1"), {"--set", "no list", "`]`"}));
  EXPECT_TRUE(test::mentions(told("sphere.radius=1"), {"--set", "`sphere`", "sphere[0].radius=2"}));
  EXPECT_TRUE(test::mentions(told("camera.vfov.x=1"), {"--set", "camera.vfov", "number"}));
}

}  // namespace
}  // namespace orrery::load
