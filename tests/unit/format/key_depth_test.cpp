// SPDX-License-Identifier: Apache-2.0
#include "format/key_depth.h"

#include <gtest/gtest.h>

namespace orrery::format {
namespace {

constexpr const char* kNine = "a.b.c.d.e.f.g.h.i";

int line_of(const std::string& text) { return too_deep_key(text).line; }

TEST(FormatKeyDepth, EightPartsAreAllowedNineAreNot) {
  EXPECT_EQ(line_of("a.b.c.d.e.f.g.h = 1\n"), 0);
  EXPECT_EQ(line_of(std::string(kNine) + " = 1\n"), 1);
  EXPECT_EQ(line_of("x = 1\n[" + std::string(kNine) + "]\n"), 2);
  EXPECT_EQ(line_of("x = { y = 1, " + std::string(kNine) + " = 1 }\n"), 1);
  EXPECT_EQ(line_of("a . b . c .\"d\". e.'f'.g.h.i = 1\n"), 1) << "blanks and quotes do not end a key";
}

TEST(FormatKeyDepth, LocatesTheFirstExcessDot) {
  const Place place = too_deep_key("x = 1\n\xC3\xBC.b.c.d.e.f.g.h.i = 1\n");
  EXPECT_EQ(place.line, 2);
  EXPECT_EQ(place.column, 16) << "in characters";
}

TEST(FormatKeyDepth, DotsInStringsAndCommentsDoNotCount) {
  const std::string dots = "a.b.c.d.e.f.g.h.i.j";
  EXPECT_EQ(line_of("# " + dots + "\nx = \"" + dots + "\" # " + dots + "\n"), 0);
  EXPECT_EQ(line_of("x = '" + dots + "'\n"), 0);
  EXPECT_EQ(line_of("x = \"\\\"" + dots + "\"\n"), 0) << "an escaped quote does not end the string";
  EXPECT_EQ(line_of("x = '\\'\ny = \"" + dots + "\"\n"), 0) << "a literal string has no escapes";
  EXPECT_EQ(line_of("x = \"\"\"\n" + dots + "\n\"" + dots + "\"\"\"\n"), 0);
  EXPECT_EQ(line_of("x = '''\n" + dots + "\n''" + dots + "'''\n"), 0);
  EXPECT_EQ(line_of("x = \"\"\"a\"\"\"\"\"\ny = 1 # \"\n"), 0) << "two more quotes belong to the string";
}

TEST(FormatKeyDepth, ContinuesAfterStrings) {
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

TEST(FormatKeyDepth, DecimalPointsInAListDoNotAccumulate) {
  EXPECT_EQ(line_of("x = [1.5, 2.5, 3.5,\n1.5, 2.5, 3.5, 1.5, 2.5, 3.5, 4.5]\n"), 0);
}

TEST(FormatKeyDepth, KeyDepthResetsAtNewline) { EXPECT_EQ(line_of("x = 1.5\na.b.c.d.e.f.g.h = 1\n"), 0); }

TEST(FormatKeyDepth, AcceptsTruncatedText) {
  const std::string text = "x = \"\"\"a\\\"b\"\"\"\"\ny = '''c'''\n" + std::string(kNine);
  for (std::size_t n = 0; n + 1 < text.size(); ++n)
    EXPECT_LE(too_deep_key(std::string_view(text).substr(0, n)).line, 3);
}

}  // namespace
}  // namespace orrery::format
