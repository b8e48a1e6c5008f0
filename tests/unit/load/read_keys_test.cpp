// SPDX-License-Identifier: Apache-2.0
#include "load/read_keys.h"

#include <gtest/gtest.h>

#include "support/mentions.h"
#include "support/scene_files.h"

namespace orrery::load {
namespace {

using support::SceneFiles;

/// Text of the first diagnostic, without location and source line.
std::string text_of(const std::string& scene) {
  SceneFiles files;
  const std::string told = files.diagnostics(scene);
  const std::size_t begin = told.find("error: ");
  return begin == std::string::npos ? told : told.substr(begin + 7, told.find('\n') - begin - 7);
}

TEST(LoadReadKeys, WrongTypesAreNamed) {
  EXPECT_TRUE(test::mentions(text_of("camera.vfov = \"20\""), {"camera.vfov", "number", "\"20\""}));
  EXPECT_TRUE(test::mentions(text_of("camera.vfov = true"), {"camera.vfov", "number", "boolean"}));
  EXPECT_TRUE(test::mentions(text_of("camera.vfov = [20]"), {"camera.vfov", "number", "list"}));
  EXPECT_TRUE(test::mentions(text_of("camera.vfov = 2024-01-01"), {"camera.vfov", "number", "date"}));
  EXPECT_TRUE(test::mentions(text_of("camera.vfov = {}"), {"camera.vfov", "number", "table"}));
  EXPECT_TRUE(test::mentions(text_of("camera.up = 1"), {"camera.up", "numbers", "[0", "1", "0]", "integer"}));
  EXPECT_TRUE(test::mentions(text_of("camera.up = [0, \"1\", 0]"), {"camera.up[1]", "number", "\"1\""}));
  EXPECT_TRUE(test::mentions(text_of("color.space = 1"), {"color.space", "string", "integer"}));
  EXPECT_TRUE(test::mentions(text_of("render.shading = 1"), {"render.shading", "integer"}));
}

TEST(LoadReadKeys, BooleansAreTrueOrFalse) {
  SceneFiles files;
  EXPECT_TRUE(files.read("").scene.background.visible);
  EXPECT_FALSE(files.read("background.visible = false").scene.background.visible);
  EXPECT_TRUE(test::mentions(text_of("background.visible = 0"), {"background.visible", "true", "false", "integer"}));
  EXPECT_TRUE(
      test::mentions(text_of("background.visible = \"no\""), {"background.visible", "true", "false", "\"no\""}));
}

TEST(LoadReadKeys, AnIntegerIsANumberButNotViceVersa) {
  SceneFiles files;
  EXPECT_EQ(files.read("camera.vfov = 20").scene.camera.vfov, 20);
  EXPECT_TRUE(
      test::mentions(text_of("render.samples = 10.0"), {"render.samples", "integer", "floating-point", "number"}));
}

TEST(LoadReadKeys, RangesAreClosedOrOpen) {
  EXPECT_TRUE(test::mentions(text_of("camera.vfov = 0"), {"camera.vfov", "0", "180"}));
  EXPECT_TRUE(test::mentions(text_of("camera.vfov = 180"), {"camera.vfov", "180", "0", "180"}));
  EXPECT_TRUE(test::mentions(text_of("camera.defocus_angle = 180"), {"camera.defocus_angle", "180", "0", "180"}));
  EXPECT_EQ(text_of("camera.defocus_angle = 0"), "");
  EXPECT_TRUE(test::mentions(text_of("render.max_depth = 10001"), {"render.max_depth", "10001", "1..10000"}));
  EXPECT_EQ(text_of("render.max_depth = 10000"), "");
  EXPECT_TRUE(test::mentions(text_of("render.seed = -1"), {"render.seed", "-1", "0..4294967295"}));
  EXPECT_TRUE(
      test::mentions(text_of("image.width = 9223372036854775807"), {"image.width", "9223372036854775807", "1..65536"}));
  EXPECT_TRUE(
      test::mentions(text_of("background.top = [0, -0.5, 0]"), {"background.top[1]", "-0.5", "0..17179869184"}));
}

TEST(LoadReadKeys, TheSunMayBeWrittenInCandelaPerSquareMetre) {
  EXPECT_EQ(text_of("background.top = [1.6e9, 1.6e9, 17179869184]"), "");
  SceneFiles files;
  const std::string told = files.diagnostics("background.top = [0, 0, 2e10]");
  EXPECT_NE(told.find("background.top[2] is 2e+10; must be in 0..17179869184"), std::string::npos) << told;
  EXPECT_NE(told.find("raise color.exposure"), std::string::npos) << told;
}

TEST(LoadReadKeys, NaNAndInfinityAreInNoRange) {
  EXPECT_TRUE(test::mentions(text_of("camera.vfov = nan"), {"camera.vfov", "0", "180"}));
  EXPECT_TRUE(test::mentions(text_of("camera.look_at = [0, 0, -inf]"), {"camera.look_at[2]", "-1e+18..1e+18"}));
  EXPECT_TRUE(test::mentions(text_of("camera.focus_distance = inf"), {"camera.focus_distance", "1e-30..1e+18"}));
}

TEST(LoadReadKeys, EachInvalidComponentIsReported) {
  SceneFiles files;
  EXPECT_EQ(files.diagnostics("camera.up = [nan,\n inf, 0]"),
            "scene.toml:1:14: error: camera.up[0] is nan; must be in -1e+18..1e+18\n"
            "    camera.up = [nan,\n"
            "                 ^~~\n"
            "scene.toml:2:2: error: camera.up[1] is inf; must be in -1e+18..1e+18\n"
            "     inf, 0]\n"
            "     ^~~\n");
}

TEST(LoadReadKeys, ReadsListsOfWords) {
  EXPECT_EQ(text_of("output.layers = []"), "");
  EXPECT_TRUE(test::mentions(text_of("output.layers = \"Z\""), {"output.layers", "list", "\"Z\""}));
  EXPECT_NE(text_of("render.filter = 'mitchell'").find("removed; use \"blackman-harris\""), std::string::npos);
  EXPECT_EQ(text_of("output.layers = [1]").substr(0, 31), "output.layers[0] must be one of");
  EXPECT_TRUE(test::mentions(text_of("output.layers = [\"Z\", \"Z\"]"), {"output.layers[1]", "duplicate"}));
  const std::string near = text_of("output.layers = [\"albdo\"]");
  EXPECT_EQ(near.substr(near.find("; did")), "; did you mean `albedo`?");
}

TEST(LoadReadKeys, ParsesCropWindow) {
  EXPECT_EQ(text_of("image.crop = [0, 0, 8, 8]"), "");
  EXPECT_TRUE(test::mentions(text_of("image.crop = [0, 0, 8]"), {"image.crop", "[0", "0", "640", "360]", "list", "3"}));
  EXPECT_TRUE(test::mentions(text_of("image.crop = 8"), {"image.crop", "[0", "0", "640", "360]", "integer"}));
  EXPECT_TRUE(
      test::mentions(text_of("image.crop = [0, 0, 8, 1.5]"), {"image.crop[3]", "integer", "floating-point", "number"}));
  EXPECT_TRUE(test::mentions(text_of("image.crop = [-1, 0, 8, 8]"), {"image.crop[0]", "-1", "0..65536"}));
}

TEST(LoadReadKeys, UnknownKeysWithoutASuggestionListTheKnownKeys) {
  EXPECT_TRUE(test::mentions(text_of("color.gamma = 2.2"), {"`gamma`", "exposure"}));
  EXPECT_TRUE(test::mentions(text_of("image.Width = 2"), {"`Width`", "image", "`width`"}));
}

}  // namespace
}  // namespace orrery::load
