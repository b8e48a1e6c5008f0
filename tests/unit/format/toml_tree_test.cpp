// SPDX-License-Identifier: Apache-2.0
#include "format/toml_tree.h"

#include <gtest/gtest.h>

#include "support/scene_files.h"

namespace orrery::format {
namespace {

using support::SceneFiles;

TEST(FormatTomlTree, RejectsDuplicateKey) {
  SceneFiles files;
  EXPECT_EQ(files.diagnostics("[camera]\nvfov = 3\nvfov = 4\n"),
            "scene.toml:3:8: error: duplicate: cannot redefine existing integer 'vfov'; remove one of them\n"
            "    vfov = 4\n"
            "           ^\n");
}

TEST(FormatTomlTree, RejectsDuplicateTable) {
  SceneFiles files;
  EXPECT_EQ(files.diagnostics("[camera]\nvfov = 3\n[camera]\n"),
            "scene.toml:3:1: error: duplicate: cannot redefine existing table 'camera'; remove one of them\n"
            "    [camera]\n"
            "    ^\n");
}

TEST(FormatTomlTree, InvalidTomlIsOneErrorAtItsLocation) {
  SceneFiles files;
  EXPECT_EQ(files.diagnostics("[camera]\nup = [0, 1, 0\n[image]\nwidth = 0\n").rfind("scene.toml:3:", 0), 0u);
  EXPECT_EQ(files.diagnostics("[camera\n").rfind("scene.toml:1:8: error: ", 0), 0u);
}

TEST(FormatTomlTree, RejectsInvalidUtf8) {
  SceneFiles files;
  const std::string told = files.diagnostics("[camera]\nvfov = \"\xff\"\n");
  EXPECT_EQ(told.substr(0, told.find('\n')), "scene.toml:2:8: error: Encountered invalid utf-8 sequence") << told;
}

TEST(FormatTomlTree, DeepNestingIsRefused) {
  SceneFiles files;
  std::string dotted = "a";
  for (int i = 0; i < 300000; ++i) dotted += ".a";
  for (const std::string& text : {dotted + " = 1\n", "[" + dotted + "]\n", "a = " + std::string(300000, '['),
                                  "[[" + dotted + "]]\n", "a = {" + dotted + " = 1}\n"}) {
    const std::string told = files.diagnostics(text);
    EXPECT_EQ(told.rfind("scene.toml:1:", 0), 0u) << told.substr(0, 200);
  }
}

TEST(FormatTomlTree, AcceptsCarriageReturns) {
  SceneFiles files;
  EXPECT_EQ(files.diagnostics("[camera]\r\nvfov = 0\r\n"),
            "scene.toml:2:8: error: camera.vfov is 0; must be above 0 and below 180\n"
            "    vfov = 0\n"
            "           ^\n");
}

TEST(FormatTomlTree, SkipsAByteOrderMark) {
  SceneFiles files;
  EXPECT_EQ(files.read("\xEF\xBB\xBF[camera]\nvfov = 20\n").scene.camera.vfov, 20);
}

}  // namespace
}  // namespace orrery::format
