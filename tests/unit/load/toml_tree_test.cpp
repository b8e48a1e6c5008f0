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

constexpr const char* kNine = "a.b.c.d.e.f.g.h.i";

int line_of(const std::string& text) { return too_deep_key(text).line; }

TEST(LoadTomlTree, EightPartsAreAllowedNineAreNot) {
  EXPECT_EQ(line_of("a.b.c.d.e.f.g.h = 1\n"), 0);
  EXPECT_EQ(line_of(std::string(kNine) + " = 1\n"), 1);
  EXPECT_EQ(line_of("x = 1\n[" + std::string(kNine) + "]\n"), 2);
  EXPECT_EQ(line_of("x = { y = 1, " + std::string(kNine) + " = 1 }\n"), 1);
  EXPECT_EQ(line_of("a . b . c .\"d\". e.'f'.g.h.i = 1\n"), 1) << "blanks and quotes do not end a key";
}

TEST(LoadTomlTree, LocatesTheFirstExcessDot) {
  const Place place = too_deep_key("x = 1\n\xC3\xBC.b.c.d.e.f.g.h.i = 1\n");
  EXPECT_EQ(place.line, 2);
  EXPECT_EQ(place.column, 16) << "in characters";
}

TEST(LoadTomlTree, DotsInStringsAndCommentsDoNotCount) {
  const std::string dots = "a.b.c.d.e.f.g.h.i.j";
  EXPECT_EQ(line_of("# " + dots + "\nx = \"" + dots + "\" # " + dots + "\n"), 0);
  EXPECT_EQ(line_of("x = '" + dots + "'\n"), 0);
  EXPECT_EQ(line_of("x = \"\\\"" + dots + "\"\n"), 0) << "an escaped quote does not end the string";
  EXPECT_EQ(line_of("x = '\\'\ny = \"" + dots + "\"\n"), 0) << "a literal string has no escapes";
  EXPECT_EQ(line_of("x = \"\"\"\n" + dots + "\n\"" + dots + "\"\"\"\n"), 0);
  EXPECT_EQ(line_of("x = '''\n" + dots + "\n''" + dots + "'''\n"), 0);
  EXPECT_EQ(line_of("x = \"\"\"a\"\"\"\"\"\ny = 1 # \"\n"), 0) << "two more quotes belong to the string";
}

TEST(LoadTomlTree, ContinuesAfterStrings) {
  const std::string deep = std::string(kNine) + " = 1\n";
  EXPECT_EQ(line_of("x = \"a\"\n" + deep), 2);
  EXPECT_EQ(line_of("x = \"\"\"a\n\"\"\"\"\"\n" + deep), 3);
  EXPECT_EQ(line_of("x = '''a'''\n" + deep), 2);
  EXPECT_EQ(line_of("x = \"\"\n" + deep), 2);
  EXPECT_EQ(line_of("# \"\n" + deep), 2);
  EXPECT_EQ(line_of("x = \"not closed\n" + deep), 2);
  const std::string inside = ", " + std::string(kNine) + " = 1 }\n";
  EXPECT_EQ(line_of("x = { y = '\\'" + inside), 1) << "a literal string has no escapes";
  EXPECT_EQ(line_of("x = { y = \"\"\"a\"\"\"\"" + inside), 1) << "the fourth quote opens no string";
}

TEST(LoadTomlTree, DecimalPointsInAListDoNotAccumulate) {
  EXPECT_EQ(line_of("x = [1.5, 2.5, 3.5,\n1.5, 2.5, 3.5, 1.5, 2.5, 3.5, 4.5]\n"), 0);
}

TEST(LoadTomlTree, KeyDepthResetsAtNewline) { EXPECT_EQ(line_of("x = 1.5\na.b.c.d.e.f.g.h = 1\n"), 0); }

TEST(LoadTomlTree, AcceptsTruncatedText) {
  const std::string text = "x = \"\"\"a\\\"b\"\"\"\"\ny = '''c'''\n" + std::string(kNine);
  for (std::size_t n = 0; n + 1 < text.size(); ++n)
    EXPECT_LE(too_deep_key(std::string_view(text).substr(0, n)).line, 3);
}

}  // namespace
}  // namespace orrery::load
