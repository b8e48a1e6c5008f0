// SPDX-License-Identifier: Apache-2.0
#include "info/info.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "load/load_scene.h"
#include "load/overrides.h"
#include "support/mentions.h"
#include "support/temp_dir.h"

namespace orrery::info {
namespace {

constexpr const char* kScene = R"(
[image]
width = 24
height = 16
[camera]
defocus_angle = 0.5
[render]
samples = 2
[material.grey]
type = "lambertian"
albedo = [0.5, 0.5, 0.5]
[material.mirror]
type = "metal"
albedo = [0.5, 0.5, 0.5]
[material.unused]
type = "dielectric"
ior = 1.5
[[sphere]]
center = [0, 0, -1]
radius = 0.5
material = "grey"
[[sphere]]
center = [2, 0, -1]
radius = -0.25
material = "mirror"
[[sphere]]
center = [4, 0, -1]
radius = 0.5
material = "grey"
)";

class Info : public testing::Test {
 protected:
  SceneInfo info(const std::string& scene, const load::Overrides& overrides = {}) {
    support::write_bytes(folder_ / "scene.toml", scene);
    load::SceneRequest request;
    request.source.file = folder_ / "scene.toml";
    request.source.overrides = overrides;
    return scene_info(request);
  }
  bool requires_(const SceneInfo& info, const std::string& name) {
    for (const Feature& feature : info.features)
      if (feature.name == name) return feature.required;
    ADD_FAILURE() << "no feature " << name;
    return false;
  }

  support::TempDir folder_;
};

TEST_F(Info, ReportsTheScenesProperties) {
  const SceneInfo found = info(kScene);
  EXPECT_EQ(found.width, 24);
  EXPECT_EQ(found.spheres, 3u);
  EXPECT_EQ(found.bounds.lower.x, -0.5);
  EXPECT_EQ(found.bounds.upper.x, 4.5);
  EXPECT_EQ(found.smallest_radius, 0.25);
  EXPECT_EQ(found.largest_radius, 0.5);
  EXPECT_EQ(found.precision, "exact");
  EXPECT_EQ(found.accelerator, "embree");
}

TEST_F(Info, ReportsRequiredAndOmittedFeatures) {
  const SceneInfo found = info(kScene);
  EXPECT_TRUE(requires_(found, "thin lens"));
  EXPECT_TRUE(requires_(found, "lambertian"));
  EXPECT_TRUE(requires_(found, "metal"));
  EXPECT_TRUE(requires_(found, "gradient sky"));
  EXPECT_FALSE(requires_(found, "fuzz"));
  EXPECT_FALSE(requires_(found, "dielectric")) << "a material that no sphere uses";
  EXPECT_FALSE(requires_(found, "plastic"));
  const SceneInfo plastic = info(kScene, {"material.mirror.type=plastic"});
  EXPECT_TRUE(requires_(plastic, "plastic"));
  EXPECT_TRUE(requires_(plastic, "fuzz"));
  EXPECT_NE(info_text(plastic).find("1 plastic"), std::string::npos) << info_text(plastic);
  const SceneInfo pinhole = info(kScene, {"camera.defocus_angle=0", "background.type=constant"});
  EXPECT_FALSE(requires_(pinhole, "thin lens"));
  EXPECT_FALSE(requires_(pinhole, "gradient sky"));
  const std::string text = info_text(pinhole);
  EXPECT_NE(text.find("unused      thin lens (pinhole camera: no lens sampling);"), std::string::npos) << text;
}

constexpr const char* kLamps = R"(
material.black = { type = "emitter", radiance = [0, 0, 0] }
material.lamp = { type = "emitter", radiance = [1, 0, 0] }
sphere = [{ center = [0, 0, -1], radius = 0.5, material = "black" },
  { center = [2, 0, -1], radius = 0.5, material = "lamp" },
  { center = [4, 0, -1], radius = 0.5, material = "lamp" }]
)";

TEST_F(Info, ReportsHowLightIsSampled) {
  EXPECT_EQ(info(kScene).lights, "");
  const SceneInfo lamps = info(kLamps);
  EXPECT_EQ(lamps.emitters, 2u) << "a black emitter is none";
  EXPECT_EQ(lamps.lights, "2 emitters; light and BSDF sampling; emitters by their irradiance");
  EXPECT_NE(info_text(lamps).find("\nlights      2 emitters; "), std::string::npos);
  EXPECT_EQ(info(kLamps, {"render.direct_lighting=bsdf"}).lights, "2 emitters; found by BSDF sampling only");
  EXPECT_EQ(info(kLamps, {"render.direct_lighting=light", "sphere[2].material=black"}).lights,
            "1 emitter; light sampling");
  std::string many = "material.lamp = { type = \"emitter\", radiance = [1, 1, 1] }\n";
  for (int i = 0; i < 100; ++i)
    many += "[[sphere]]\ncenter = [" + std::to_string(3 * i) + ", 0, 0]\nradius = 1\nmaterial = \"lamp\"\n";
  EXPECT_TRUE(test::mentions(info(many).lights, {"100 emitters", "light tree", "4.7 KiB"}));
}

TEST_F(Info, ReportsHowTheBackgroundIsSampled) {
  const std::string sky = "background.type = \"sky\"\n";
  const std::string both = info(sky + kLamps).lights;
  EXPECT_TRUE(test::mentions(
      both, {"2 emitters, background", "half", "emitters by their irradiance", "texels above the mean and the sun ("}));
  EXPECT_TRUE(test::mentions(info(sky, {"background.sun=false"}).lights, {"BSDF", "texels above the mean"}));
  EXPECT_TRUE(test::mentions(info(sky, {"background.sun=false", "render.direct_lighting=light"}).lights,
                             {"light sampling", "all texels"}));
  EXPECT_EQ(info(sky, {"render.direct_lighting=bsdf"}).lights, "background; found by BSDF sampling only");
}

TEST_F(Info, NamesPairsOfBallsAndLights) {
  EXPECT_EQ(info(kLamps).caustics, "");
  const std::string balls = R"(
background.type = "sky"
material.lamp = { type = "emitter", radiance = [1, 1, 1] }
material.mirror = { type = "metal", albedo = [1, 1, 1], fuzz = 0 }
material.bubble = { type = "dielectric", ior = 0.8 }
sphere = [{ center = [0, 0, -1], radius = 0.5, material = "mirror" },
  { center = [3, 0, -1], radius = 0.5, material = "bubble" },
  { center = [0, 3, -1], radius = 0.5, material = "lamp" },
  { center = [0, 0.8, -1], radius = 0.5, material = "lamp" }]
)";
  const SceneInfo found = info(balls);
  EXPECT_TRUE(test::mentions(found.caustics, {"2 of 6", ": sphere[0] and sphere[2], sphere[0] and the sun"}))
      << "neither with a lamp that cuts the ball nor with a bubble";
  EXPECT_NE(info_text(found).find("\ncaustics    2 of 6"), std::string::npos);
  // Spheres of data files are those of a file's rows.
  support::write_bytes(folder_ / "a.csv", "x,y,z\n9,0,0\n9,9,0\n");
  support::write_bytes(folder_ / "b.csv", "x,y,z\n9,9,9\n0,0,-1\n");
  const std::string files = R"(
material.lamp = { type = "emitter", radiance = [1, 1, 1] }
material.grey = { type = "lambertian", albedo = [0.5, 0.5, 0.5] }
material.mirror = { type = "metal", albedo = [1, 1, 1], fuzz = 0 }
sphere = [{ center = [0, 3, -1], radius = 0.5, material = "lamp" }]
points = [{ file = "a.csv", radius = 0.5, material = "grey" }, { file = "b.csv", radius = 0.5, material = "mirror" }]
)";
  EXPECT_TRUE(
      test::mentions(info(files).caustics, {"2 of 2", ": row 1 of b.csv and sphere[0], row 2 of b.csv and sphere[0]"}));
  const std::string hollow = R"(
material.lamp = { type = "emitter", radiance = [1, 1, 1] }
material.glass = { type = "dielectric" }
sphere = [{ center = [0, 3, -1], radius = 0.5, material = "lamp" },
  { center = [0, 0, -1], radius = 0.5, material = "glass" },
  { center = [0, 0, RADIUS], radius = RADIUS, material = "glass" }]
)";
  const auto with = [&](const char* center, const char* radius) {
    std::string text = hollow;
    text.replace(text.find("RADIUS"), 6, center).replace(text.find("RADIUS"), 6, radius);
    return info(text).caustics;
  };
  constexpr char kLeftOut[] = "; points in hollow or nested balls by BSDF sampling";
  EXPECT_NE(with("-1", "-0.4").find(kLeftOut), std::string::npos);
  EXPECT_NE(with("-1.1", "0.3").find(kLeftOut), std::string::npos);
  EXPECT_EQ(with("-1.3", "0.3").find(kLeftOut), std::string::npos);
  EXPECT_EQ(info(balls, {"render.caustics=false"}).caustics, "");
  EXPECT_EQ(info(balls, {"render.direct_lighting=bsdf"}).caustics, "");
}

TEST_F(Info, TheListNeedsNoMemoryForABvh) {
  EXPECT_GT(info(kScene).memory.accelerator, 0u);
  EXPECT_EQ(info(kScene, {"render.accelerator=list"}).memory.accelerator, 0u);
}

TEST_F(Info, ReportsTheTraversal) {
  EXPECT_EQ(info(kScene).traversal, "packet");
  EXPECT_EQ(info(kScene, {"render.accelerator=list"}).traversal, "list");
}

TEST_F(Info, SettingsShowTheirOrigin) {
  const std::string text = settings_text(info(kScene, {"render.samples=9"}));
  EXPECT_NE(
      text.find("image.width                24                       " + (folder_ / "scene.toml").string() + ":3\n"),
      std::string::npos)
      << text;
  EXPECT_NE(text.find("render.samples             9                        --set\n"), std::string::npos) << text;
  EXPECT_NE(text.find("render.seed                1                        default\n"), std::string::npos) << text;
}

TEST_F(Info, AnEmptySceneHasNoBounds) {
  const SceneInfo empty = info("");
  EXPECT_EQ(empty.spheres, 0u);
  EXPECT_NE(info_text(empty).find("spheres     0\nmaterials   none\n"), std::string::npos) << info_text(empty);
  const auto json = nlohmann::json::parse(info_json(empty));
  EXPECT_TRUE(json["bounds"].is_null());
  EXPECT_TRUE(json["radius"].is_null());
}

TEST_F(Info, JsonHoldsTheSameValues) {
  const auto json = nlohmann::json::parse(info_json(info(kScene)));
  EXPECT_EQ(json["schema"], "orrery.info/1");
  EXPECT_EQ(json["spheres"], 3);
  EXPECT_EQ(json["bounds"]["lower"][0], -0.5);
  EXPECT_EQ(json["radius"]["largest"], 0.5);
  EXPECT_EQ(json["memory_bytes"]["film"], 24 * 16 * (52 + 4 + 16));  // sums, counts, image
  EXPECT_EQ(json["settings"][0]["key"], "image.width");
}

TEST_F(Info, WarningsAreReported) {
  const std::string twice = "[[sphere]]\ncenter = [0, 0, -1]\nradius = 0.5\nmaterial = \"grey\"\n";
  const SceneInfo found = info(kScene + twice);
  EXPECT_EQ(found.warnings.size(), 1u);
  EXPECT_EQ(nlohmann::json::parse(info_json(found))["warnings"].size(), 1u);
}

TEST_F(Info, OfCoincidentEmittersOnlyTheFirstCounts) {
  const auto lamp = [](const std::string& center) {
    return "[[sphere]]\ncenter = " + center + "\nradius = 0.5\nmaterial = \"lamp\"\n";
  };
  const std::string scene = std::string(kScene) + "[material.lamp]\ntype = \"emitter\"\nradiance = [1, 1, 1]\n" +
                            lamp("[0, 0, -1]") + lamp("[8, 0, -1]") + lamp("[8, 0, -1]") +
                            lamp("[8, 0, -1.000000000001]");
  EXPECT_EQ(info(scene).emitters, 2u);
  EXPECT_EQ(info(scene, {"render.direct_lighting=\"bsdf\""}).emitters, 2u);
  EXPECT_EQ(info(scene, {"render.precision=\"fast\""}).lights, "1 emitter; light and BSDF sampling");
}

}  // namespace
}  // namespace orrery::info
