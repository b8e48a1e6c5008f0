// SPDX-License-Identifier: Apache-2.0
#include "load/toml_tree.h"
#include "support/mentions.h"

#include <gtest/gtest.h>

#include "support/scene_files.h"

namespace orrery::load {
namespace {

using support::SceneFiles;

TEST(LoadTomlTree, RejectsDuplicateKey) {
  SceneFiles files;
  EXPECT_EQ(files.diagnostics("[camera]\nvfov = 3\nvfov = 4\n"),
            "scene.toml:3:8: error: duplicate: cannot redefine existing integer 'vfov'; remove one of them\n"
            "    vfov = 4\n"
            "           ^\n");
}

TEST(LoadTomlTree, RejectsDuplicateTable) {
  SceneFiles files;
  EXPECT_EQ(files.diagnostics("[camera]\nvfov = 3\n[camera]\n"),
            "scene.toml:3:1: error: duplicate: cannot redefine existing table 'camera'; remove one of them\n"
            "    [camera]\n"
            "    ^\n");
}

TEST(LoadTomlTree, InvalidTomlIsOneErrorAtItsLocation) {
  SceneFiles files;
  EXPECT_EQ(files.diagnostics("[camera]\nup = [0, 1, 0\n[image]\nwidth = 0\n").rfind("scene.toml:3:", 0), 0u);
  EXPECT_EQ(files.diagnostics("[camera\n").rfind("scene.toml:1:8: error: ", 0), 0u);
}

TEST(LoadTomlTree, RejectsInvalidUtf8) {
  SceneFiles files;
  const std::string told = files.diagnostics("[camera]\nvfov = \"\xff\"\n");
  EXPECT_TRUE(test::mentions(told.substr(0, told.find('\n')), {"scene.toml:2:8", "Encountered", "utf-8"})) << told;
}

TEST(LoadTomlTree, DeepNestingIsRefused) {
  SceneFiles files;
  std::string dotted = "a";
  for (int i = 0; i < 300000; ++i) dotted += ".a";
  for (const std::string& text : {dotted + " = 1\n", "[" + dotted + "]\n", "a = " + std::string(300000, '['),
                                  "[[" + dotted + "]]\n", "a = {" + dotted + " = 1}\n"}) {
    const std::string told = files.diagnostics(text);
    EXPECT_EQ(told.rfind("scene.toml:1:", 0), 0u) << told.substr(0, 200);
  }
}

TEST(LoadTomlTree, AcceptsCarriageReturns) {
  SceneFiles files;
  EXPECT_EQ(files.diagnostics("[camera]\r\nvfov = 0\r\n"),
            "scene.toml:2:8: error: camera.vfov is 0; must be above 0 and below 180\n"
            "    vfov = 0\n"
            "           ^\n");
}

TEST(LoadTomlTree, SkipsAByteOrderMark) {
  SceneFiles files;
  EXPECT_EQ(files.read("\xEF\xBB\xBF[camera]\nvfov = 20\n").scene.camera.vfov, 20);
}

/// "a.a.a"
std::string key_of(int parts) {
  std::string out = "a";
  for (int i = 1; i < parts; ++i) out += ".a";
  return out;
}

int line_of(const std::string& text) { return too_deep_key(text).line; }

TEST(LoadTomlTree, DeepKeysAreFound) {
  const std::string deep = key_of(kDeepestKey + 1);
  EXPECT_EQ(line_of(key_of(kDeepestKey) + " = 1\n"), 0);
  EXPECT_EQ(line_of(deep + " = 1\n"), 1);
  EXPECT_EQ(line_of("x = 1\n[" + deep + "]\n"), 2);
  EXPECT_EQ(line_of("x = { y = 1, " + deep + " = 1 }\n"), 1);
  const Place place = too_deep_key("x = 1\n\xC3\xBC." + deep + " = 1\n");
  EXPECT_EQ(place.line, 2);
  EXPECT_EQ(place.column, 2 * kDeepestKey) << "in characters";
}

TEST(LoadTomlTree, DelimitersEndAKey) {
  const std::string half = key_of(kDeepestKey / 2 + 2);
  EXPECT_EQ(line_of("x = [" + half + ", " + half + ",\n" + half + "]\n"), 0);
}

TEST(LoadTomlTree, ADeepKeyIsAnError) {
  for (const int parts : {20, kDeepestKey, kDeepestKey + 1, 100'000})
    EXPECT_NE(SceneFiles().diagnostics(key_of(parts) + " = 1\n").find("scene.toml:1:"), std::string::npos) << parts;
}

}  // namespace
}  // namespace orrery::load
