// SPDX-License-Identifier: Apache-2.0
#include "base/error.h"

#include <gtest/gtest.h>

namespace orrery::base {
namespace {

// Users' scripts depend on these numbers.
TEST(BaseError, EachKindHasItsDocumentedNumber) {
  EXPECT_EQ(exit_status(ErrorKind::kInternal), 70);
  EXPECT_EQ(exit_status(ErrorKind::kNoMemory), 71);
  EXPECT_EQ(exit_status(ErrorKind::kUsage), 2);
  EXPECT_EQ(exit_status(ErrorKind::kBadData), 65);
  EXPECT_EQ(exit_status(ErrorKind::kMissingInput), 66);
  EXPECT_EQ(exit_status(ErrorKind::kCannotCreate), 73);
  EXPECT_EQ(exit_status(ErrorKind::kIo), 74);
  EXPECT_EQ(exit_status(ErrorKind::kStopped), 75);
}

Diagnostic at(int line, int column, int width, const std::string& text, const std::string& source_line) {
  Diagnostic diagnostic;
  diagnostic.file = "scene.toml";
  diagnostic.line = line;
  diagnostic.column = column;
  diagnostic.width = width;
  diagnostic.text = text;
  diagnostic.source_line = source_line;
  return diagnostic;
}

TEST(BaseError, HasLocationTextRemedyLineAndCaret) {
  Diagnostic diagnostic = at(12, 8, 3, "camera.vfov is 200; must be above 0 and below 180", "vfov = 200");
  diagnostic.remedy = "write degrees";
  EXPECT_EQ(formatted(diagnostic),
            "scene.toml:12:8: error: camera.vfov is 200; must be above 0 and below 180; write degrees\n"
            "    vfov = 200\n"
            "           ^~~\n");
}

TEST(BaseError, HasNoCaretWithoutALine) {
  Diagnostic diagnostic;
  diagnostic.file = "cloud.ply";
  diagnostic.severity = Severity::kWarning;
  diagnostic.text = "vertex 3 is odd";
  EXPECT_EQ(formatted(diagnostic), "cloud.ply: warning: vertex 3 is odd\n");
}

TEST(BaseError, BeginsWithTheSeverityWithoutAFile) {
  Diagnostic diagnostic;
  diagnostic.text = "nothing to do";
  EXPECT_EQ(formatted(diagnostic), "error: nothing to do\n");
}

TEST(BaseError, CaretLineRepeatsTabs) {
  EXPECT_EQ(formatted(at(1, 3, 4, "bad", "\t\tfuzz = 2")),
            "scene.toml:1:3: error: bad\n    \t\tfuzz = 2\n    \t\t^~~~\n");
}

TEST(BaseError, CaretCountsCharactersWhereColumnsCountBytes) {
  // "ü" has two bytes but one column: the caret is under the u.
  EXPECT_EQ(formatted(at(1, 4, 2, "bad", "\xC3\xBC u\xC3\xBC")),
            "scene.toml:1:4: error: bad\n    \xC3\xBC u\xC3\xBC\n      ^~\n");
  EXPECT_EQ(formatted(at(1, 4, 3, "bad", "\xC3\xBC u\xC3\xBC")),
            "scene.toml:1:4: error: bad\n    \xC3\xBC u\xC3\xBC\n      ^~\n")
      << "the second byte of a character gets no tilde";
}

TEST(BaseError, DoesNotUnderlineBeyondTheLine) {
  EXPECT_EQ(formatted(at(1, 2, 90, "bad", "ab")), "scene.toml:1:2: error: bad\n    ab\n     ^\n");
  EXPECT_EQ(formatted(at(1, 90, 90, "bad", "ab")), "scene.toml:1:90: error: bad\n    ab\n      ^\n");
}

TEST(BaseError, PrintsValuesOfControlCharactersAndInvalidBytes) {
  const std::string shown = formatted(at(1, 1, 1,
                                         "name \"\x1b[2J\" \xC2\x9B"
                                         "31m",
                                         "\x1b[31mred\x7f"));
  EXPECT_EQ(shown, "scene.toml:1:1: error: name \"\\x1b[2J\" \\xc2\\x9b31m\n    \\x1b[31mred\\x7f\n    ^~~~\n");
  EXPECT_EQ(formatted(at(1, 3, 2, "no \xff", "\x7f\xff=1\t")),
            "scene.toml:1:3: error: no \\xff\n    \\x7f\\xff=1\t\n            ^~\n")
      << "the caret is under its column of the line as printed";
}

TEST(BaseError, AWarningWithoutLocationIsOneLine) { EXPECT_EQ(warning_line("two words"), "warning: two words\n"); }

}  // namespace
}  // namespace orrery::base
