// SPDX-License-Identifier: Apache-2.0
#include "load/diagnostics.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <string>

#include "base/error.h"
#include "load/read_scene.h"
#include "support/mentions.h"
#include "support/temp_dir.h"

namespace orrery::load {
namespace {

std::string line_of(const SourceText& source, int line) {
  return source.diagnostic(base::Severity::kError, {"a", line, 1, 1}, "x").source_line;
}

TEST(LoadDiagnostics, FindsEveryLine) {
  std::string text;
  for (int i = 1; i <= 500; ++i) text += "line " + std::to_string(i) + (i % 2 == 0 ? "\r\n" : "\n");
  SourceText source;
  source.set_file("a", text + "last");
  for (int i = 1; i <= 500; ++i) EXPECT_EQ(line_of(source, i), "line " + std::to_string(i));
  EXPECT_EQ(line_of(source, 501), "last");
  EXPECT_EQ(line_of(source, 502), "");
  EXPECT_EQ(line_of(source, 100000), "");
}

TEST(LoadDiagnostics, OverridesAreQuotedAsTyped) {
  Overrides overrides;
  overrides.add_option("--samples", "render.samples", "0");
  overrides.add("camera.vfov=wide");
  overrides.add_option("--layers", "output.layers", "Z,Q", true);
  SourceText source;
  source.set_overrides(overrides);
  const auto shown = [&](int line) {
    return base::formatted(source.diagnostic(base::Severity::kError, {kOverrideName, line, 1, 1}, "x"));
  };
  EXPECT_EQ(shown(1), "--samples: error: x\n    --samples 0\n              ^\n");
  EXPECT_EQ(shown(2), "--set: error: x\n    --set camera.vfov=wide\n          ^~~~~~~~~~~~~~~~\n");
  EXPECT_EQ(shown(3), "--layers: error: x\n    --layers Z,Q\n             ^~~\n");
  EXPECT_EQ(source.option_at(3), "--layers");
}

TEST(LoadDiagnostics, ConvertsCharactersToBytes) {
  SourceText source;
  source.set_file("a", "\xC3\xBC = \xE2\x82\xAC\xE2\x82\xAC\n");
  const base::Diagnostic f = source.diagnostic(base::Severity::kWarning, {"a", 1, 5, 2}, "text", "remedy");
  EXPECT_EQ(f.column, 6);
  EXPECT_EQ(f.width, 6);
  EXPECT_EQ(f.severity, base::Severity::kWarning);
  EXPECT_EQ(f.text, "text");
  EXPECT_EQ(f.remedy, "remedy");
}

TEST(LoadDiagnostics, ALocationAfterTheEndOfALine) {
  SourceText source;
  source.set_file("a", "ab\n");
  const base::Diagnostic f = source.diagnostic(base::Severity::kError, {"a", 1, 3, 1}, "text");
  EXPECT_EQ(f.column, 3);
  EXPECT_EQ(f.source_line, "ab");
}

TEST(LoadDiagnostics, LocationsWithoutATextHaveNoLine) {
  SourceText source;
  source.set_file("a", "one");
  EXPECT_EQ(source.diagnostic(base::Severity::kError, {"a", 0, 0, 1}, "x").source_line, "");
  EXPECT_EQ(source.diagnostic(base::Severity::kError, {"none", 1, 1, 1}, "x").source_line, "");
}

TEST(LoadDiagnostics, VeryLongLinesAreNotQuoted) {
  SourceText source;
  source.set_file("a", std::string(401, 'x') + "\n" + std::string(400, 'y'));
  EXPECT_EQ(line_of(source, 1), "");
  EXPECT_EQ(line_of(source, 2), std::string(400, 'y'));
}

TEST(LoadDiagnostics, ReadsAWholeFile) {
  const support::TempDir folder;
  const std::string bytes("a\0\r\n\xff", 5);
  support::write_bytes(folder / "a", bytes);
  EXPECT_EQ(read_file(folder / "a", 5), bytes);
  support::write_bytes(folder / "empty", "");
  EXPECT_EQ(read_file(folder / "empty", 5), "");
}

TEST(LoadDiagnostics, AFileAboveTheLimitIsBadData) {
  const support::TempDir folder;
  support::write_bytes(folder / "a", std::string((1 << 20) + 1, 'x'));
  try {
    read_file(folder / "a", 1 << 20);
    FAIL() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kBadData);
    EXPECT_NE(std::string(error.what()).find("exceeds the limit of 1 MiB"), std::string::npos) << error.what();
  }
}

TEST(LoadDiagnostics, OnlyRegularFilesAreRead) {
  const support::TempDir folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  const auto reason = [](const std::filesystem::path& file) -> std::string {
    try {
      read_file(file, 1 << 20);
      return "read";
    } catch (const base::Error& error) {
      EXPECT_EQ(error.kind(), base::ErrorKind::kMissingInput);
      return error.what();
    }
  };
  EXPECT_EQ(reason(folder / "pipe"), "cannot open " + (folder / "pipe").string() + ": it is not a regular file");
  EXPECT_TRUE(test::mentions(reason("/dev/zero"), {"/dev/zero", "regular"}));
  EXPECT_EQ(reason(folder.path()), "cannot open " + folder.path().string() + ": it is a directory");
}

}  // namespace
}  // namespace orrery::load
